//! What is high, asked of blocks of cells first: most questions are answered by a few of them.

use geometry::{Cell, CellArea, Grid};
use mapping::HeightMap;

/// Cells a side of a block.
const BLOCK: i32 = 8;

/// The highest cell of each block of a height map.
#[derive(Debug, Clone, PartialEq)]
pub struct HighBlocks {
    /// The highest of each block, m; minus infinity where nothing was seen.
    highest_m: Grid<f32>,
}

impl HighBlocks {
    /// Of a height map; to be made anew when that changes.
    pub fn new(map: &HeightMap) -> Self {
        let heights_m = map.tops_m();
        let side = BLOCK as usize;
        let blocks = [heights_m.cols(), heights_m.rows()].map(|cells| cells.div_ceil(side));
        let mut highest_m = Grid::filled(blocks[0], blocks[1], f32::NEG_INFINITY);
        let lines = heights_m.values().chunks_exact(heights_m.cols().max(1));
        for (row, line) in lines.enumerate() {
            let first = (row / side) * blocks[0];
            let into = &mut highest_m.values_mut()[first..first + blocks[0]];
            for (highest_m, cells) in into.iter_mut().zip(line.chunks(side)) {
                // What was not seen is no number, which `max` passes over.
                *highest_m = cells.iter().copied().fold(*highest_m, f32::max);
            }
        }
        Self { highest_m }
    }

    /// Whether anything in an area may be higher than this, m.
    pub fn may_be_higher(&self, area: CellArea, than_m: f32) -> bool {
        let block = |cell: Cell| Cell::new(cell.col.div_euclid(BLOCK), cell.row.div_euclid(BLOCK));
        let blocks = CellArea {
            min: block(area.min),
            max: block(area.max),
        };
        let within = blocks.within(self.highest_m.area());
        let columns = within.min.col..within.max.col + 1;
        (within.min.row..=within.max.row).any(|row| {
            let highest_m = self.highest_m.row(row, columns.clone());
            highest_m.iter().any(|&highest_m| highest_m > than_m)
        })
    }

    /// Whether anything within this distance of a place is higher than this, m.
    pub fn is_higher_within(
        &self,
        map: &HeightMap,
        [x_m, y_m]: [f64; 2],
        radius_m: f64,
        than_m: f32,
    ) -> bool {
        let lattice = &map.lattice;
        let area = CellArea {
            min: lattice.cell_at(x_m - radius_m, y_m - radius_m),
            max: lattice.cell_at(x_m + radius_m, y_m + radius_m),
        };
        if !self.may_be_higher(area, than_m) {
            return false;
        }
        let heights_m = map.tops_m();
        let within = area.within(heights_m.area());
        let cell_m = lattice.cell_m;
        (within.min.row..=within.max.row).any(|row| {
            let [first_x_m, row_y_m] = lattice.center_of(Cell::new(0, row));
            let (across_m, off_m) = (row_y_m - y_m, x_m - first_x_m);
            let half_m = (radius_m * radius_m - across_m * across_m).max(0.0).sqrt();
            // The cells of the row whose middles lie within the circle.
            let first = ((off_m - half_m) / cell_m).ceil() as i32;
            let last = ((off_m + half_m) / cell_m).floor() as i32;
            let cells = heights_m.row(row, first..last.saturating_add(1));
            cells.iter().any(|&height_m| height_m > than_m)
        })
    }
}
