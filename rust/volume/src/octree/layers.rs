//! Where a tree is looked at as a world model's view has it: the view's cells, and 64 layers of voxels above a height.

use geometry::{Cell, CellArea, Lattice, runs};

use super::{ColumnFootprint, Octree, key::SPAN};

/// Voxel of the map's origin, counted from the lowest that a tree can hold.
const ORIGIN: i32 = SPAN / 2;

/// Cells of a view, and layers of voxels that cross them. A set of a cell's layers is one bit each, the lowest layer first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViewLayers {
    /// Where the cells lie in the map frame.
    pub lattice: Lattice,
    size: [usize; 2],
    /// Side of a voxel, m.
    pub resolution_m: f64,
    /// Number of the lowest layer, counted from the map's origin.
    lowest: i32,
}

impl ViewLayers {
    /// Layers above a height, over so many columns and rows of a lattice; its cells are whole numbers of voxels wide.
    pub fn above(bottom_m: f64, (lattice, size): (Lattice, [usize; 2]), resolution_m: f64) -> Self {
        Self {
            lattice,
            size,
            resolution_m,
            lowest: (bottom_m / resolution_m).round() as i32,
        }
    }

    /// Columns and rows.
    pub const fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Height of the border below a layer, m.
    pub fn border_m(&self, layer: i32) -> f64 {
        f64::from(self.lowest + layer) * self.resolution_m
    }

    /// Height of the middle of a layer, m.
    pub fn middle_m(&self, layer: u32) -> f64 {
        self.border_m(layer as i32) + 0.5 * self.resolution_m
    }

    /// The layers of which the middle lies above one height and the lower border below another, one bit each.
    pub fn between(&self, above_m: f64, below_m: f64) -> u64 {
        let layer = |height_m: f64| height_m / self.resolution_m - f64::from(self.lowest);
        let first = ((layer(above_m) - 0.5).floor() + 1.0).clamp(0.0, 64.0) as u32;
        let end = layer(below_m).ceil().clamp(0.0, 64.0) as u32;
        if first >= end {
            return 0;
        }
        (u64::MAX >> (64 - (end - first))) << first
    }

    /// The cells of an area as a tree finds them.
    fn footprint(&self, area: CellArea) -> ColumnFootprint {
        let Lattice { origin_m, cell_m } = self.lattice;
        let per_cell = (cell_m / self.resolution_m).round();
        let voxel = |axis: usize, cell: i32| {
            let cells = (origin_m[axis] / cell_m).round() + f64::from(cell);
            (cells * per_cell) as i32
        };
        let Cell { col, row } = area.min;
        let low = [voxel(0, col), voxel(1, row), self.lowest];
        ColumnFootprint {
            low: low.map(|at| at.saturating_add(ORIGIN)),
            cells: [area.max.col - col + 1, area.max.row - row + 1].map(|cells| cells as usize),
            per_cell: per_cell as usize,
        }
    }

    /// All cells.
    pub const fn all(&self) -> CellArea {
        let [cols, rows] = self.size;
        CellArea {
            min: Cell::new(0, 0),
            max: Cell::new(cols as i32 - 1, rows as i32 - 1),
        }
    }
}

/// For each cell the layers in which a tree has a voxel as likely occupied as is asked for, one bit each, row by row.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LayerColumns(Vec<u64>);

impl LayerColumns {
    /// Reads the cells of an area anew; all of them, when layers or cells are others.
    pub fn read(&mut self, (tree, p_occ): (&Octree, f64), layers: &ViewLayers, area: CellArea) {
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

    /// The layers of the cell that is stored at an index; none where nothing was read.
    #[inline]
    pub fn at(&self, index: usize) -> u64 {
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
        let layers = ViewLayers::above(-0.4, (lattice, [4, 4]), 0.04);
        // Layer 10 is the first above the floor, and its middle 20 mm above.
        assert_eq!(layers.between(0.028, 0.09), 0b11 << 11);
        assert_eq!(layers.between(0.01, 0.07), 0b11 << 10);
        assert_eq!(layers.between(0.3, 0.2), 0);
        assert_eq!(layers.between(-9.0, 9.0), u64::MAX);
        assert_eq!(layers.between(9.0, 10.0), 0);
        assert!((layers.middle_m(10) - 0.02).abs() < 1e-12);
    }
}
