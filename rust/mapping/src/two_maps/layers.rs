//! Where the two maps are looked at: the cells of the view, and the layers around the robot's height.

use geometry::{Cell, CellArea, Lattice};

use geometry::runs;
use volume::octree::{Footprint, Octree};

/// Voxel of the map's origin, counted from the lowest that a tree can hold.
const ORIGIN: i32 = 1 << 15;

/// Cells and layers of voxels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Layers {
    lattice: Lattice,
    size: [usize; 2],
    resolution_m: f64,
    /// Number of the lowest layer, counted from the map's origin.
    lowest: i32,
}

impl Layers {
    /// Above a height; the lattice's cells are whole numbers of voxels.
    pub(super) fn above(
        bottom_m: f64,
        (lattice, size): (Lattice, [usize; 2]),
        resolution_m: f64,
    ) -> Self {
        Self {
            lattice,
            size,
            resolution_m,
            lowest: (bottom_m / resolution_m).round() as i32,
        }
    }

    pub(super) const fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// Side of a voxel, m.
    pub(super) const fn side_m(&self) -> f64 {
        self.resolution_m
    }

    /// Columns and rows.
    pub(super) const fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Height of the border below a layer, m.
    pub(super) fn border_m(&self, layer: i32) -> f64 {
        f64::from(self.lowest + layer) * self.resolution_m
    }

    /// Height of the middle of a layer, m.
    pub(super) fn middle_m(&self, layer: u32) -> f64 {
        self.border_m(layer as i32) + 0.5 * self.resolution_m
    }

    /// The layers of which the middle lies above one height and the lower border below another, one bit each.
    pub(super) fn between(&self, above_m: f64, below_m: f64) -> u64 {
        let layer = |height_m: f64| height_m / self.resolution_m - f64::from(self.lowest);
        let first = ((layer(above_m) - 0.5).floor() + 1.0).clamp(0.0, 64.0) as u32;
        let end = layer(below_m).ceil().clamp(0.0, 64.0) as u32;
        if first >= end {
            return 0;
        }
        (u64::MAX >> (64 - (end - first))) << first
    }

    /// The same cells as a tree finds them.
    fn footprint(&self, area: CellArea) -> Footprint {
        let Lattice { origin_m, cell_m } = self.lattice;
        let per_cell = (cell_m / self.resolution_m).round();
        let voxel = |axis: usize, cell: i32| {
            let cells = (origin_m[axis] / cell_m).round() + f64::from(cell);
            (cells * per_cell) as i32
        };
        let Cell { col, row } = area.min;
        let low = [voxel(0, col), voxel(1, row), self.lowest];
        Footprint {
            low: low.map(|at| at.saturating_add(ORIGIN)),
            cells: [area.max.col - col + 1, area.max.row - row + 1].map(|cells| cells as usize),
            per_cell: per_cell as usize,
        }
    }

    /// All cells.
    pub(super) const fn all(&self) -> CellArea {
        let [cols, rows] = self.size;
        CellArea {
            min: Cell::new(0, 0),
            max: Cell::new(cols as i32 - 1, rows as i32 - 1),
        }
    }
}

/// For each cell the layers in which a tree has a voxel as likely occupied as is asked for, one bit each, row by row.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Columns(Vec<u64>);

impl Columns {
    /// Reads the cells of an area anew; all of them, when layers or cells are others.
    pub(super) fn read(&mut self, (tree, p_occ): (&Octree, f64), layers: &Layers, area: CellArea) {
        let [cols, rows] = layers.size;
        self.0.resize(cols * rows, 0);
        let area = area.within(layers.all());
        if area.is_empty() {
            return;
        }
        for run in runs(area, layers.size) {
            self.0[run].fill(0);
        }
        let Cell { col, row } = area.min;
        let first = row as usize * cols + col as usize;
        let columns = &mut self.0;
        tree.occupied_columns(&layers.footprint(area), p_occ, |col, row, solid| {
            columns[first + row * cols + col] |= solid;
        });
    }

    /// Those of the cell that is stored at an index; none where nothing was read.
    #[inline]
    pub(super) fn at(&self, index: usize) -> u64 {
        self.0.get(index).copied().unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_are_chosen_by_middle_and_lower_border() {
        let lattice = Lattice {
            origin_m: [0.0; 2],
            cell_m: 0.04,
        };
        let layers = Layers::above(-0.4, (lattice, [4, 4]), 0.04);
        // Layer 10 is the first above the floor, and its middle 20 mm above.
        assert_eq!(layers.between(0.028, 0.09), 0b11 << 11);
        assert_eq!(layers.between(0.01, 0.07), 0b11 << 10);
        assert_eq!(layers.between(0.3, 0.2), 0);
        assert_eq!(layers.between(-9.0, 9.0), u64::MAX);
        assert_eq!(layers.between(9.0, 10.0), 0);
        assert!((layers.middle_m(10) - 0.02).abs() < 1e-12);
    }
}
