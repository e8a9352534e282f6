//! What recognised stairs say about cells: their height, and that a riser beside them is no obstacle.

use geometry::{Cell, Lattice, Map};
use stairs::Stair;

use crate::StairOutline;

/// The cells of all stairs. Reused.
#[derive(Debug, Clone, Default)]
pub struct StairCells {
    /// Height of the stair in whose outline a cell's centre lies, m; not a number where none is.
    pub(crate) height_m: Vec<f32>,
    /// Height of the highest stair within a cell of it, m.
    near_m: Vec<f32>,
    /// Whether a cell lies within a cell of a stair that nothing known is a step up to: the top of a box, as far as can be told.
    apart: Vec<bool>,
    /// Whether there is any stair.
    pub(crate) any: bool,
}

impl StairCells {
    /// Forgets all stairs; there are `cells` cells, and stairs among them if there are `any`.
    pub(crate) fn clear(&mut self, cells: usize, any: bool) {
        self.any = any;
        self.height_m.clear();
        self.near_m.clear();
        self.apart.clear();
        if any {
            self.height_m.resize(cells, f32::NAN);
            self.near_m.resize(cells, f32::NEG_INFINITY);
            self.apart.resize(cells, false);
        }
    }

    /// Adds the cells of a stair, which nothing is a step up to if it is `apart`.
    pub(crate) fn add(
        &mut self,
        (stair, apart): (&Stair<Map>, bool),
        lattice: &Lattice,
        [cols, rows]: [usize; 2],
    ) {
        let outline = StairOutline::of(stair);
        let (min, max) = outline.bounds_m();
        let low = lattice.cell_at(min[0] - lattice.cell_m, min[1] - lattice.cell_m);
        let high = lattice.cell_at(max[0] + lattice.cell_m, max[1] + lattice.cell_m);
        let height = stair.height_m() as f32;
        for row in low.row.max(0)..=high.row.min(rows as i32 - 1) {
            for col in low.col.max(0)..=high.col.min(cols as i32 - 1) {
                let outside_m = outline.outside_m(lattice.center_of(Cell::new(col, row)));
                let index = row as usize * cols + col as usize;
                if outside_m <= lattice.cell_m {
                    // Of two, the higher one says what the cell is.
                    if height > self.near_m[index] {
                        self.apart[index] = apart;
                    }
                    self.near_m[index] = self.near_m[index].max(height);
                }
                // Where two overlap, the higher one hides the other.
                if outside_m <= 0.0 {
                    self.height_m[index] = self.height_m[index].max(height);
                }
            }
        }
    }

    /// Whether an obstacle in a cell is one: near to stairs only if it is higher than they are by more than a riser may be taken for, m.
    pub(crate) fn is_obstacle(&self, index: usize, top_m: f32, riser_m: f32) -> bool {
        !self.any || top_m > self.near_m[index] + riser_m
    }

    /// Whether a cell lies in a stair's outline.
    pub fn covers(&self, index: usize) -> bool {
        self.any && !self.height_m[index].is_nan()
    }

    /// Whether a cell lies in a stair's outline or within a cell of it.
    pub fn is_near(&self, index: usize) -> bool {
        self.any && self.near_m[index] > f32::NEG_INFINITY
    }

    /// Whether a cell lies near to a stair that something known may lead to.
    pub fn is_near_climbable(&self, index: usize) -> bool {
        self.is_near(index) && !self.apart[index]
    }

    /// The cells of stairs.
    pub(crate) fn cells(&self) -> impl Iterator<Item = usize> {
        let cells = self.height_m.iter().enumerate();
        cells.filter(|(_, height)| !height.is_nan()).map(|(i, _)| i)
    }
}
