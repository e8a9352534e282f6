//! What lies behind an obstacle is not seen: a wall rises through every height, so that a strip of it passes for a continuation
//! of whatever floor or lid borders on it, and with its height seems to lie behind the wall.

use std::ops::Range;

use geometry::Cell;

use crate::{FloorView, Surface};
use volume::{Locator, OccupancyGrid};

/// Which cells have an obstacle near them, on the eye's side: most points lie far from all, and need no closer look. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(crate) struct Surroundings {
    near: Vec<bool>,
    line: Vec<bool>,
}

impl Surroundings {
    /// Finds the cells of a view that lie at most so many columns and rows behind an obstacle, seen from the cell of the eye.
    fn find(&mut self, view: &FloorView, cells: usize, eye: Cell) {
        let [cols, rows] = view.size();
        self.near.clear();
        self.near.resize(cols * rows, false);
        for (row, line) in view.cells.values().chunks_exact(cols).enumerate() {
            let is_obstacle = |surface: &Surface| matches!(surface, Surface::Obstacle(_));
            // Without a way out, many at a time.
            if !line
                .iter()
                .fold(false, |any, surface| any | is_obstacle(surface))
            {
                continue;
            }
            self.line.clear();
            self.line.resize(cols, false);
            for (col, _) in line
                .iter()
                .enumerate()
                .filter(|(_, surface)| is_obstacle(surface))
            {
                self.line[behind(col, eye.col, cells, cols)].fill(true);
            }
            let beside = behind(row, eye.row, cells, rows);
            for near in self.near[beside.start * cols..beside.end * cols].chunks_exact_mut(cols) {
                for (near, line) in near.iter_mut().zip(&self.line) {
                    *near |= line;
                }
            }
        }
    }
}

/// From where one may come by a column or row within so many, of `count`, while going towards the eye's, and half a cell beyond it at
/// most.
fn behind(at: usize, eye: i32, cells: usize, count: usize) -> Range<usize> {
    let (low, high) = (at.saturating_sub(cells), (at + cells + 1).min(count));
    match at as i64 - i64::from(eye) {
        2.. => at..high,
        ..=-2 => low..at + 1,
        _ => low..high,
    }
}

/// What hides floor from one frame's camera.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shadow<'a> {
    /// The camera in the map frame, m.
    eye_m: [f64; 3],
    /// How far behind an obstacle floor is not believed, m over the ground.
    reach_m: f64,
    /// The map as it was before the frame.
    view: &'a FloorView,
    /// Its voxels.
    occupancy: &'a OccupancyGrid,
    /// Where a closer look is needed.
    surroundings: &'a Surroundings,
    /// Where the view's cells are.
    locator: Locator<2>,
}

impl<'a> Shadow<'a> {
    /// Behind the obstacles of a map, as far as `reach_m`, seen from `eye_m`.
    pub(crate) fn new(
        eye_m: [f64; 3],
        reach_m: f64,
        (view, occupancy): (&'a FloorView, &'a OccupancyGrid),
        surroundings: &'a mut Surroundings,
    ) -> Self {
        // A cell more for what rounding may add.
        let cells = (reach_m / view.lattice.cell_m).round() as usize + 1;
        let eye = view.lattice.cell_at(eye_m[0], eye_m[1]);
        surroundings.find(view, cells, eye);
        Self {
            locator: Locator::of_cells(&view.lattice, view.size()),
            eye_m,
            reach_m,
            view,
            occupancy,
            surroundings,
        }
    }

    /// Whether the line of sight to a point of the map frame, in the cell that is stored at `index`, passes an obstacle shortly
    /// before it.
    #[inline]
    pub(crate) fn holds(&self, at_m: [f64; 3], index: Option<usize>) -> bool {
        index.is_none_or(|index| self.surroundings.near[index]) && self.is_behind(at_m)
    }

    /// Whether an obstacle is found shortly before a point by going back along its line of sight, cell by cell.
    fn is_behind(&self, [x_m, y_m, z_m]: [f64; 3]) -> bool {
        let back = [
            self.eye_m[0] - x_m,
            self.eye_m[1] - y_m,
            self.eye_m[2] - z_m,
        ];
        let distance_m = geometry::hypot(back[0], back[1]);
        let cell_m = self.view.lattice.cell_m;
        let cells = (self.reach_m.min(distance_m) / cell_m).round() as i32;
        (1..=cells).any(|cell| {
            let part = f64::from(cell) * cell_m / distance_m;
            let at_m = [x_m + part * back[0], y_m + part * back[1]];
            let surface = |index: usize| self.view.cells.values()[index];
            let index = self.locator.index_at(at_m);
            index.is_some_and(|index| matches!(surface(index), Surface::Obstacle(_)))
                && self.is_barred(
                    self.view.lattice.cell_at(at_m[0], at_m[1]),
                    z_m + part * back[2],
                )
        })
    }

    /// Whether a cell is occupied at a height, or so near that a layer's width may be the reason why it is not.
    fn is_barred(&self, cell: Cell, height_m: f64) -> bool {
        let layer_m = self.occupancy.placement.layer_m;
        [-layer_m, 0.0, layer_m]
            .iter()
            .any(|above_m| self.occupancy.is_occupied_at(cell, height_m + above_m))
    }
}

#[cfg(test)]
mod tests {
    use geometry::Lattice;
    use proptest::prelude::*;

    use super::*;
    use crate::{Clearing, Update};
    use volume::{Placement, ProbabilityTable, Ray, Size};

    const CELLS: usize = 12;
    const CELL_M: f64 = 0.04;

    proptest! {
        #[test]
        fn without_a_closer_look_nothing_is_behind_an_obstacle(
            obstacles in prop::collection::vec((0..CELLS, 0..CELLS), 1..4),
            at in prop::array::uniform2(-0.1..0.6_f64),
            eye in prop::array::uniform2(-0.5..1.0_f64),
            reach_m in 0.0..0.2_f64,
        ) {
            let lattice = Lattice { origin_m: [0.0; 2], cell_m: CELL_M };
            let placement = Placement { lattice, bottom_m: 0.0, layer_m: CELL_M };
            let size = Size { cols: CELLS, rows: CELLS, layers: 4 };
            let table = ProbabilityTable::new(0.9, 0.7, 0.05, 0.95);
            let mut occupancy = OccupancyGrid::new(size, placement, table);
            let mut view = FloorView::unknown(lattice, CELLS);
            for (col, row) in obstacles {
                let cell = Cell::new(col as i32, row as i32);
                view.set(cell, Surface::Obstacle(0.1), 0);
                let [x_m, y_m] = lattice.center_of(cell);
                let ray = Ray { end_m: [x_m, y_m, 0.06], hit: true };
                let _ = occupancy.insert([x_m, y_m, 0.1], [ray].into_iter(), Update::PerFrame, Clearing::EveryRay);
            }
            let mut surroundings = Surroundings::default();
            let eye_m = [eye[0], eye[1], 0.1];
            let shadow = Shadow::new(eye_m, reach_m, (&view, &occupancy), &mut surroundings);
            let at_m = [at[0], at[1], 0.05];
            let index = view.cells.index(lattice.cell_at(at[0], at[1]));
            prop_assert_eq!(shadow.holds(at_m, index), shadow.is_behind(at_m));
        }
    }
}
