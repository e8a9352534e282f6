//! The ground under the robot: it cannot see where it stands.

use geometry::{Cell, CellArea, Grid, Lattice};

/// Height of the ground where the robot stood, cell by cell.
#[derive(Debug, Clone)]
pub(crate) struct Underfoot {
    /// NaN where the robot did not stand, m.
    heights: Grid<f32>,
    reach_m: f64,
}

impl Underfoot {
    /// A robot that stood nowhere yet. Standing it covers the cells up to `reach_m` from its middle.
    pub(crate) fn new(cells: usize, reach_m: f64) -> Self {
        Self {
            heights: Grid::filled(cells, cells, f32::NAN),
            reach_m,
        }
    }

    /// Moves the window by whole cells.
    pub(crate) fn shift(&mut self, cols: i32, rows: i32) {
        self.heights.shift(cols, rows, &f32::NAN);
    }

    /// Remembers that the robot stands here (map frame); the cells that it covers.
    pub(crate) fn stand(&mut self, [x, y, z]: [f64; 3], lattice: &Lattice) -> CellArea {
        let mut area = CellArea::EMPTY;
        let reach = self.reach_m;
        let window = CellArea {
            min: lattice.cell_at(x - reach, y - reach),
            max: lattice.cell_at(x + reach, y + reach),
        }
        .within(self.heights.area());
        for cell in window.cells() {
            let [cx, cy] = lattice.center_of(cell);
            if geometry::hypot(cx - x, cy - y) <= reach
                && let Some(height) = self.heights.get_mut(cell)
            {
                *height = z as f32;
                area.include(cell);
            }
        }
        area
    }

    /// Height of the ground of a cell, m, where the robot stood on it.
    pub(crate) fn height(&self, cell: Cell) -> Option<f32> {
        self.height_at(self.heights.index(cell)?)
    }

    /// Height of the ground of the cell that is stored at an index, row by row, m, where the robot stood on it.
    #[inline]
    pub(crate) fn height_at(&self, index: usize) -> Option<f32> {
        let height = self.heights.values()[index];
        (!height.is_nan()).then_some(height)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_covers_more_than_the_window_covers_the_window() {
        let lattice = Lattice {
            origin_m: [-1.0, -1.0],
            cell_m: 0.04,
        };
        let area = Underfoot::new(50, 1e9).stand([0.0, 0.0, 0.1], &lattice);
        assert_eq!(area.cells().count(), 50 * 50);
    }
}
