//! How near the robot has been to each cell. From afar the steps of a staircase run into each other: what is seen there on a higher
//! level is not believed before it was seen from near by. Drops are believed from anywhere.

use geometry::{Cell, Lattice};
use mapping::{FloorView, Surface};

use crate::levels::Stand;
use crate::treads::Treads;

/// An obstacle that ends lower than this above the robot's feet may be a riser, m.
const LOW_M: f64 = 0.15;

/// How near the cells were. Goes with the window.
#[derive(Debug, Clone, Default)]
pub(crate) struct Judged {
    lattice: Option<Lattice>,
    cols: usize,
    /// Least distance of each cell to the robot so far, m.
    nearest_m: Vec<f32>,
    before_m: Vec<f32>,
    /// Of each column: how far aside of the robot it is, m, and which column of `before_m` it is.
    columns: Vec<(f64, usize)>,
}

impl Judged {
    /// Takes in where the robot is; moves with the view's window.
    pub(crate) fn look(&mut self, view: &FloorView, at_m: [f64; 2]) {
        let (cols, rows) = (view.cells.cols(), view.cells.rows());
        std::mem::swap(&mut self.nearest_m, &mut self.before_m);
        self.nearest_m.clear();
        let before = self.lattice.unwrap_or(view.lattice);
        self.columns.clear();
        self.columns.extend((0..cols).map(|col| {
            let [x, y] = view.lattice.center_of(Cell::new(col as i32, 0));
            let then = usize::try_from(before.cell_at(x, y).col).ok();
            (x - at_m[0], then.unwrap_or(usize::MAX))
        }));
        for row in 0..rows {
            let [x, y] = view.lattice.center_of(Cell::new(0, row as i32));
            let then = usize::try_from(before.cell_at(x, y).row).ok();
            let known = then.and_then(|row| {
                let first = row * self.cols;
                self.before_m.get(first..first + self.cols)
            });
            let known = known.unwrap_or_default();
            let ahead_m = y - at_m[1];
            self.nearest_m
                .extend(self.columns.iter().map(|&(aside_m, col)| {
                    let away_m = (aside_m * aside_m + ahead_m * ahead_m).sqrt() as f32;
                    known
                        .get(col)
                        .map_or(away_m, |&before_m| away_m.min(before_m))
                }));
        }
        self.lattice = Some(view.lattice);
        self.cols = cols;
    }

    /// How near the robot has been to a place, m; infinite where it was never looked at.
    pub(crate) fn nearest_m(&self, [x, y]: [f64; 2]) -> f64 {
        let Some(lattice) = self.lattice else {
            return f64::INFINITY;
        };
        let cell = lattice.cell_at(x, y);
        let inside = cell.row >= 0 && cell.col >= 0 && (cell.col as usize) < self.cols;
        let index = || cell.row as usize * self.cols + cell.col as usize;
        let known_m = inside.then(|| self.nearest_m.get(index())).flatten();
        known_m.map_or(f64::INFINITY, |&known_m| f64::from(known_m))
    }

    /// Makes unknown what lies on a higher level and was never as near as `range_m`, unless a recognised stair or a slope says what
    /// it is.
    pub(crate) fn doubt(
        &self,
        (view, treads): (&FloorView, &Treads),
        range_m: f64,
        (stand, floor_m): (&Stand, f64),
        blocked: &mut [bool],
        unknown: &mut [bool],
    ) {
        for (index, surface) in view.cells.values().iter().enumerate() {
            let sloped = view.gradients.values()[index] != [0.0; 2];
            if f64::from(self.nearest_m[index]) <= range_m || treads.covers(index) || sloped {
                continue;
            }
            let doubtful = match *surface {
                Surface::Floor(height) => f64::from(height) - stand.height_m > floor_m,
                Surface::Obstacle(top) => f64::from(top) - stand.height_m < LOW_M,
                Surface::Unknown => false,
            };
            if doubtful {
                blocked[index] = false;
                unknown[index] = true;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::Grid;
    use stairs::Staircase;

    fn view(origin_m: f64, surface: Surface) -> FloorView {
        FloorView {
            lattice: Lattice {
                origin_m: [origin_m, -1.0],
                cell_m: 0.1,
            },
            cells: Grid::filled(40, 20, surface),
            sightings: Grid::filled(40, 20, 9),
            gradients: Grid::filled(40, 20, [0.0; 2]),
        }
    }

    /// Whether the place at (x, 0) is unknown for a robot that was at `places` before.
    fn is_doubted(surface: Surface, places: &[f64], x_m: f64) -> bool {
        let mut judged = Judged::default();
        for &place in places {
            judged.look(&view(place - 2.0, surface), [place, 0.0]);
        }
        let view = view(places[places.len() - 1] - 2.0, surface);
        let mut treads = Treads::default();
        treads.read(&view, &Staircase::default(), 0.05);
        let (mut blocked, mut unknown) = (vec![true; 800], vec![false; 800]);
        let stand = Stand {
            at_m: [0.0; 2],
            height_m: 0.0,
            heading_rad: 0.0,
            gradient: [0.0; 2],
        };
        let seen = (&view, &treads);
        judged.doubt(seen, 0.8, (&stand, 0.01), &mut blocked, &mut unknown);
        let cell = view.lattice.cell_at(x_m, 0.05);
        let index = cell.row as usize * 40 + cell.col as usize;
        assert_eq!(blocked[index], !unknown[index]);
        unknown[index]
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
}
