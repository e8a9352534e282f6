//! Where there is room on a floor, for whoever plans over a view with rules of his own.

use geometry::Cell;
use geometry::distance::{CellDistances, NOTHING_NEAR};

use crate::{FloorView, Surface};

impl FloorView {
    /// For each cell, row by row, the distance from its middle to that of the nearest cell that blocks, m; infinite where none does.
    ///
    /// What blocks is an obstacle, and floor beside which another floor lies lower by more than a cell's side: what is steeper than 45
    /// degrees is the rim of a drop, or the side of a thing with a flat top.
    pub fn clearance_m(&self) -> Vec<f32> {
        let shown = self.shown();
        let blocked = blocked(&shown, |cell, height_m| shown.is_rim(cell, height_m));
        self.distances_m(&blocked)
    }

    /// For each cell, row by row, whether a robot of a radius that stands at a height and steps up and down by no more than `rise_m` may
    /// have its middle there: the cell was seen (or `unknown` ones count, too), and nothing that blocks reaches within the radius.
    ///
    /// What blocks is an obstacle, and floor that lies more than `rise_m` above or below `z_m`, however flat it is.
    pub fn passable(&self, z_m: f64, rise_m: f64, radius_m: f64, unknown: bool) -> Vec<bool> {
        let shown = self.shown();
        let another_level = |_, height: f32| (f64::from(height) - z_m).abs() > rise_m;
        let blocked = blocked(&shown, another_level);
        let far_m = (radius_m + 0.5 * self.lattice.cell_m) as f32;
        let distances_m = self.distances_m(&blocked);
        let cells = shown.cells.values().iter().zip(distances_m);
        cells
            .map(|(surface, distance_m)| {
                (unknown || *surface != Surface::Unknown) && distance_m >= far_m
            })
            .collect()
    }

    fn is_rim(&self, cell: Cell, height: f32) -> bool {
        let sides = [(1, 0), (-1, 0), (0, 1), (0, -1)];
        sides.into_iter().any(|(cols, rows)| {
            let beside = self.cell(Cell::new(cell.col + cols, cell.row + rows));
            matches!(beside, Surface::Floor(other) if f64::from(height - other) > self.lattice.cell_m)
        })
    }

    fn distances_m(&self, blocked: &[bool]) -> Vec<f32> {
        let mut distances = CellDistances::default();
        distances.compute(blocked, self.cells.cols());
        let cell_m = self.lattice.cell_m;
        let in_metres = |squared: &u32| match *squared {
            NOTHING_NEAR.. => f32::INFINITY,
            squared => (f64::from(squared).sqrt() * cell_m) as f32,
        };
        distances.squared.iter().map(in_metres).collect()
    }
}

/// For each cell, whether it is an obstacle, or floor of which `also` says that it blocks.
fn blocked(view: &FloorView, also: impl Fn(Cell, f32) -> bool) -> Vec<bool> {
    let surfaces = view.cells.area().cells().zip(view.cells.values());
    surfaces
        .map(|(cell, surface)| match *surface {
            Surface::Unknown => false,
            Surface::Obstacle(_) => true,
            Surface::Floor(height) => also(cell, height),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use geometry::{Grid, Lattice};
    use proptest::prelude::*;

    use super::*;

    const CELL_M: f64 = 0.05;

    fn view(cells: Grid<Surface>) -> FloorView {
        let lattice = Lattice {
            origin_m: [0.0; 2],
            cell_m: CELL_M,
        };
        FloorView::new(lattice, cells, 10)
    }

    /// A floor of 20 by 10 cells on which a box with a flat top, seen from above, takes up the cells of columns 10 to 13.
    fn with_a_box(top_m: f32) -> FloorView {
        let mut cells = Grid::filled(20, 10, Surface::Floor(0.0));
        for (row, col) in (0..10).flat_map(|row| (10..14).map(move |col| (row, col))) {
            *cells.get_mut(Cell::new(col, row)).unwrap() = Surface::Floor(top_m);
        }
        view(cells)
    }

    #[test]
    fn the_flat_top_of_a_box_is_no_way_and_a_doormat_is() {
        let index = 5 * 20;
        let high = with_a_box(0.3);
        let free = high.passable(0.0, 0.015, 0.1, false);
        assert!(free[index + 5] && !free[index + 8] && !free[index + 11]);
        assert!((high.clearance_m()[index + 5] - 5.0 * CELL_M as f32).abs() < 1e-6);
        let low = with_a_box(0.01);
        assert!(
            low.passable(0.0, 0.015, 0.1, false)
                .iter()
                .all(|&free| free)
        );
        assert!(low.clearance_m().iter().all(|far| far.is_infinite()));
        // On the box the ground is what is out of reach.
        let above = high.passable(0.3, 0.015, 0.05, false);
        assert!(above[index + 12] && !above[index + 5]);
    }

    #[test]
    fn what_nobody_saw_is_passable_if_asked_for() {
        let nothing = view(Grid::filled(4, 4, Surface::Unknown));
        assert!(
            nothing
                .passable(0.0, 0.01, 0.1, true)
                .iter()
                .all(|&free| free)
        );
        assert!(
            !nothing
                .passable(0.0, 0.01, 0.1, false)
                .iter()
                .any(|&free| free)
        );
    }

    proptest! {
        /// What a wider robot may do, or one that steps less high, a narrower one that steps higher may do, too.
        #[test]
        fn less_is_passable_to_the_wider_and_the_lower_step(
            kinds in prop::collection::vec((0_u8..3, -0.1_f32..0.1), 144),
            radii in (0.0_f64..0.3, 0.0_f64..0.3),
            rises in (0.0_f64..0.1, 0.0_f64..0.1),
        ) {
            let mut cells = Grid::filled(12, 12, Surface::Unknown);
            for (slot, (kind, height)) in cells.values_mut().iter_mut().zip(kinds) {
                *slot = match kind {
                    0 => Surface::Unknown,
                    1 => Surface::Floor(height),
                    _ => Surface::Obstacle(height),
                };
            }
            let view = view(cells);
            let wide = view.passable(0.0, rises.0.min(rises.1), radii.0.max(radii.1), false);
            let narrow = view.passable(0.0, rises.0.max(rises.1), radii.0.min(radii.1), false);
            prop_assert!(wide.iter().zip(&narrow).all(|(wide, narrow)| !wide || *narrow));
        }
    }
}
