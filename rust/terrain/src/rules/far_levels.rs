//! Rule: from afar the steps of a staircase run into each other, so what is seen there on a higher level is not believed before it was
//! seen from near by. Drops are believed from anywhere.

use geometry::{Cell, Lattice};
use mapping::{FloorView, Surface};
use settings::{settings, within};

use crate::{Sight, Terrain};

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
    /// Of each column: how far aside of the robot it is, m, and which column of `before_m` it is.
    columns: Vec<(f64, usize)>,
}

impl FarLevels {
    pub(super) fn apply(
        &mut self,
        terrain: &mut Terrain,
        sight: &Sight<'_>,
        config: &FarLevelsConfig,
    ) {
        self.look(&mut terrain.nearest_m, sight.view, sight.stand.at_m);
        doubt(terrain, sight, config.low);
    }

    /// Takes in where the robot is; moves with the view's window.
    fn look(&mut self, nearest_m: &mut Vec<f32>, view: &FloorView, at_m: [f64; 2]) {
        let (cols, rows) = (view.cells.cols(), view.cells.rows());
        std::mem::swap(nearest_m, &mut self.before_m);
        nearest_m.clear();
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
            nearest_m.extend(self.columns.iter().map(|&(aside_m, col)| {
                let away_m = (aside_m * aside_m + ahead_m * ahead_m).sqrt() as f32;
                known
                    .get(col)
                    .map_or(away_m, |&before_m| away_m.min(before_m))
            }));
        }
        self.lattice = Some(view.lattice);
        self.cols = cols;
    }
}

/// Makes unknown what lies on a higher level and was never near, unless a recognised stair or a slope says what it is. What ends lower than `low_m` above
/// the ground may be a riser.
fn doubt(terrain: &mut Terrain, sight: &Sight<'_>, low_m: f64) {
    let range_m = terrain.settings.judge_range;
    let (floor_m, ground_m) = (terrain.needs.limits.floor_m, sight.stand.height_m);
    for (index, surface) in sight.view.cells.values().iter().enumerate() {
        let sloped = sight.view.gradients.values()[index] != [0.0; 2];
        let was_near = f64::from(terrain.nearest_m[index]) <= range_m;
        if was_near || terrain.stairs.covers(index) || sloped {
            continue;
        }
        let doubtful = match *surface {
            Surface::Floor(height) => f64::from(height) - ground_m > floor_m,
            Surface::Obstacle(top) => f64::from(top) - ground_m < low_m,
            Surface::Unknown => false,
        };
        if doubtful {
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
    use crate::testing::{Floor, terrain};

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
}
