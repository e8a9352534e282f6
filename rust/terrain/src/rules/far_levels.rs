//! Rule: from afar the steps of a staircase run into each other, so what is seen there on a higher level is not believed before it was
//! seen from near by. Drops are believed from anywhere.

use std::ops::Range;

use geometry::{Cell, Lattice, in_step, same_level};
use mapping::{FloorView, Surface};
use settings::{settings, within};

use crate::{Sight, Terrain, cells::beside};

settings! {
    /// What is not believed from afar.
    pub struct FarLevelsConfig("navigation.terrain.far_levels") {
        /// An obstacle that ends lower than this above the robot's feet may be a riser.
        low: f64 = 0.15, "m", within(0.0, 10.0);
    }
}

/// How near the cells were. Goes with the window.
#[derive(Debug, Clone, Default)]
pub(super) struct FarLevels {
    lattice: Option<Lattice>,
    cols: usize,
    before_m: Vec<f32>,
    /// Height of the ground that levels are compared with, m: the robot's own sways, on a slope more than elsewhere.
    ground_m: Option<f64>,
    /// How far aside of the robot each column is, m.
    aside_m: Vec<f64>,
    /// Cells that a slope leads up to without a step; empty where there is no slope.
    joined: Vec<bool>,
    next: Vec<usize>,
    /// Columns that lie side by side in `before_m`, too, and where their first one lies.
    columns: Vec<(Range<usize>, usize)>,
}

impl FarLevels {
    pub(super) fn apply(
        &mut self,
        terrain: &mut Terrain,
        sight: &Sight<'_>,
        config: &FarLevelsConfig,
    ) {
        self.look(&mut terrain.nearest_m, sight.view, sight.stand.at_m);
        let ground_m = self.steady_m(sight.stand.height_m, terrain.needs.limits.floor_m);
        self.find_joined(terrain, sight.view);
        doubt(terrain, sight, (ground_m, config.low), &self.joined);
    }

    /// The height that the robot stands at, m, but the one before while it differs by no more than floor does: who stands still must
    /// not believe a level in one frame and doubt it in the next.
    fn steady_m(&mut self, height_m: f64, floor_m: f64) -> f64 {
        let before_m = (self.ground_m).filter(|&before_m| same_level(before_m, height_m, floor_m));
        *self.ground_m.insert(before_m.unwrap_or(height_m))
    }

    /// Finds the floor that goes on from slopes without a step: what they lead up to is no riser.
    fn find_joined(&mut self, terrain: &Terrain, view: &FloorView) {
        let (slopes, floor_m) = (&terrain.slopes, terrain.needs.limits.floor_m as f32);
        self.joined.clear();
        if slopes.near.is_empty() {
            return;
        }
        let surfaces = view.cells.values();
        let is_slope = |index: &usize| slopes.is_slope(*index);
        self.joined
            .extend((0..surfaces.len()).map(|index| is_slope(&index)));
        self.next.clear();
        self.next.extend((0..surfaces.len()).filter(is_slope));
        while let Some(here) = self.next.pop() {
            let Surface::Floor(from_m) = surfaces[here] else {
                continue;
            };
            for there in beside(here, terrain.cols, surfaces.len()) {
                if let Surface::Floor(to_m) = surfaces[there]
                    && !self.joined[there]
                    && slopes.step_m(here, there, to_m - from_m) <= floor_m
                {
                    self.joined[there] = true;
                    self.next.push(there);
                }
            }
        }
    }

    /// Takes in where the robot is; moves with the view's window.
    fn look(&mut self, nearest_m: &mut Vec<f32>, view: &FloorView, at_m: [f64; 2]) {
        let (cols, rows) = (view.cells.cols(), view.cells.rows());
        std::mem::swap(nearest_m, &mut self.before_m);
        nearest_m.clear();
        let before = self.lattice.unwrap_or(view.lattice);
        let center_m =
            |axis: usize, at: usize| view.lattice.center_of(Cell::new(at as i32, at as i32))[axis];
        let then = |cell: i32, count: usize| usize::try_from(cell).ok().filter(|&at| at < count);
        self.aside_m.clear();
        (self.aside_m).extend((0..cols).map(|col| center_m(0, col) - at_m[0]));
        self.columns.clear();
        (self.columns).extend(in_step(0..cols, |col| {
            then(before.cell_at(center_m(0, col), 0.0).col, self.cols)
        }));
        let rows_before = self.before_m.len() / self.cols.max(1);
        for row in 0..rows {
            let ahead_m = center_m(1, row) - at_m[1];
            nearest_m.extend(
                (self.aside_m.iter())
                    .map(|aside_m| (aside_m * aside_m + ahead_m * ahead_m).sqrt() as f32),
            );
            let Some(row_then) = then(before.cell_at(0.0, center_m(1, row)).row, rows_before)
            else {
                continue;
            };
            let here_m = &mut nearest_m[row * cols..];
            let before_m = &self.before_m[row_then * self.cols..];
            for (columns, first) in &self.columns {
                let before_m = &before_m[*first..][..columns.len()];
                for (here_m, &before_m) in here_m[columns.clone()].iter_mut().zip(before_m) {
                    // No distance is no number.
                    *here_m = if before_m < *here_m {
                        before_m
                    } else {
                        *here_m
                    };
                }
            }
        }
        self.lattice = Some(view.lattice);
        self.cols = cols;
    }
}

/// Makes unknown what lies on a higher level and was never near, unless a recognised stair or a slope says what it is. What ends lower than `low_m` above
/// the ground may be a riser. `joined` is what slopes lead up to.
fn doubt(terrain: &mut Terrain, sight: &Sight<'_>, (ground_m, low_m): (f64, f64), joined: &[bool]) {
    let range_m = terrain.settings.judge_range;
    let floor_m = terrain.needs.limits.floor_m;
    let surfaces = sight.view.cells.values().iter();
    for (index, (surface, &nearest_m)) in surfaces.zip(&terrain.nearest_m).enumerate() {
        let doubtful = match *surface {
            Surface::Floor(height) => f64::from(height) - ground_m > floor_m,
            Surface::Obstacle(top) => f64::from(top) - ground_m < low_m,
            Surface::Unknown => false,
        };
        if !doubtful || f64::from(nearest_m) <= range_m {
            continue;
        }
        let sloped = sight.view.gradients.values()[index] != [0.0; 2];
        let is_joined = joined.get(index) == Some(&true);
        if !(sloped || is_joined || terrain.stairs.covers(index)) {
            terrain.blocked[index] = false;
            terrain.unknown[index] = true;
        }
    }
}

#[cfg(test)]
mod tests {
    use geometry::{Grid, Lattice};
    use mapping::{FloorView, Surface};

    use crate::Rules;
    use crate::testing::{Floor, cell, terrain};

    fn view(origin_m: f64, surface: Surface) -> FloorView {
        FloorView::new(
            Lattice {
                origin_m: [origin_m, -1.0],
                cell_m: 0.1,
            },
            Grid::filled(40, 20, surface),
            9,
        )
    }

    /// Whether the place at (x, 0) is unknown for a robot that was at `places` before.
    fn is_doubted(surface: Surface, places: &[f64], x_m: f64) -> bool {
        let (mut rules, mut terrain) = (Rules::default(), terrain());
        let mut floor = Floor::new();
        for &place in places {
            floor.view = view(place - 2.0, surface);
            floor.stand.at_m = [place, 0.0];
            floor.read(&mut rules, &mut terrain, "far_levels");
        }
        let index = terrain.index_at([x_m, 0.05]).unwrap();
        assert!(!(terrain.blocked[index] && terrain.unknown[index]));
        terrain.unknown[index]
    }

    #[test]
    fn a_higher_level_is_believed_once_it_was_near() {
        let level = Surface::Floor(0.09);
        assert!(is_doubted(level, &[0.0], 1.25));
        assert!(!is_doubted(level, &[0.0], 0.55));
        assert!(!is_doubted(level, &[1.0, 0.0], 1.25), "it was near before");
    }

    #[test]
    fn the_own_level_a_drop_and_what_is_tall_are_believed_from_afar() {
        assert!(!is_doubted(Surface::Floor(0.004), &[0.0], 1.25));
        assert!(!is_doubted(Surface::Floor(-0.09), &[0.0], 1.25));
        assert!(!is_doubted(Surface::Obstacle(0.3), &[0.0], 1.25));
        assert!(is_doubted(Surface::Obstacle(0.1), &[0.0], 1.25));
    }

    #[test]
    fn what_a_slope_leads_up_to_is_believed_from_afar_and_what_lies_behind_a_step_beside_it_is_not()
    {
        let mut floor = Floor::new();
        floor.ramp([0.3, -0.5], [0.8, 0.5], [0.0, 0.08]);
        floor.paint([0.8, -0.5], [1.9, 0.5], Surface::Floor(0.08));
        floor.paint([0.3, 0.6], [1.9, 1.5], Surface::Floor(0.04));
        let terrain = floor.after("far_levels");
        let doubted = |x_m: f64, y_m: f64| terrain.unknown[cell(&terrain, x_m, y_m)];
        assert!(!doubted(0.825, 0.025) && !doubted(1.825, 0.025));
        assert!(doubted(1.225, 0.925), "a step of 4 cm leads up to it");
        floor.paint([1.0, -0.5], [1.2, 0.5], Surface::Floor(0.12));
        let terrain = floor.after("far_levels");
        assert!(
            terrain.unknown[cell(&terrain, 1.825, 0.025)],
            "behind a step"
        );
    }

    #[test]
    fn what_is_believed_or_doubted_stays_so_while_the_own_height_sways() {
        let (mut rules, mut terrain, mut floor) = (Rules::default(), terrain(), Floor::new());
        floor.view = view(-2.0, Surface::Floor(0.055));
        let mut doubted = |height_m: f64| {
            floor.stand.height_m = height_m;
            floor.read(&mut rules, &mut terrain, "far_levels");
            terrain.unknown[terrain.index_at([1.25, 0.05]).unwrap()]
        };
        let swaying = [0.041, 0.047, 0.043, 0.049, 0.041].map(&mut doubted);
        assert_eq!(swaying, [true; 5]);
        assert!(!doubted(0.06), "it has climbed");
        assert!(!doubted(0.051), "and sways");
    }
}
