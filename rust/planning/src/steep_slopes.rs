//! Slopes that are too steep to be walked on and would lead to the goal.

use geometry::{same_level, two_levels};
use terrain::{StandingAt, Terrain};

use crate::path::ends::PathEnds;
use crate::search::{Route, Search};
use crate::{Goal, NoWay, Refusal};

/// A way to the goal over slopes that are too steep.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SteepWay {
    route: Route,
    /// How steep the first of them is, rise per metre.
    rise_per_m: f64,
}

impl SteepWay {
    /// Its cost in cells.
    pub(crate) const fn cost(&self) -> f64 {
        self.route.cost
    }

    /// Whether it is seen to lead to the goal on another level than the robot's: then no way around the slope is hoped for. Ground that
    /// was not seen may lie behind the slope up to `unseen_m`.
    pub(crate) fn leads_to(
        &self,
        terrain: &Terrain,
        (goal, stand): (&Goal, &StandingAt),
        (level_m, unseen_m): (f64, f64),
    ) -> bool {
        let (mut height_m, mut unseen) = (None, 0_u32);
        for pair in self.route.cells.windows(2) {
            let [from, to] = [pair[0], pair[1]].map(|cell| cell as usize);
            let sloped_m = (height_m.zip(terrain.slopes.rise_on(from, to)))
                .map(|(height_m, rise_m): (f64, f64)| height_m + rise_m);
            unseen += 1;
            if let Some(seen_m) = terrain.level_m(to).or(sloped_m) {
                (height_m, unseen) = (Some(seen_m), 0);
            }
        }
        let Some(end_m) = height_m else {
            return false;
        };
        let behind_m = f64::from(unseen) * terrain.lattice.cell_m;
        // What was not seen of the slope may rise on like it.
        let on_m = level_m + self.rise_per_m * behind_m;
        let is_goals = (goal.height_m).is_none_or(|height_m| same_level(height_m, end_m, on_m));
        is_goals && behind_m <= unseen_m && two_levels(end_m, stand.height_m, level_m)
    }

    /// The word and sentence for it.
    pub(crate) fn refused(&self, terrain: &Terrain) -> NoWay {
        too_steep(terrain, self.rise_per_m)
    }
}

/// The way that would lead to the goal if nothing were too steep; none where no steep slope is part of it.
pub(crate) fn steep_way(terrain: &Terrain, ends: &PathEnds<'_>, start: usize) -> Option<SteepWay> {
    let weights = terrain.weights_over_slopes()?;
    let ending = |cell: usize| ends.cost(cell);
    let remaining = |cell: usize| ends.remaining(cell);
    let route = Search::default().run(&weights, terrain.cols, start, ending, remaining)?;
    let rise_per_m = first_too_steep(terrain, &route)?;
    Some(SteepWay { route, rise_per_m })
}

/// How steep the first slope on a way is that is too steep, rise per metre.
pub(crate) fn first_too_steep(terrain: &Terrain, route: &Route) -> Option<f64> {
    let slopes = &terrain.slopes;
    let mut cells = route.cells.iter();
    cells.find_map(|&cell| slopes.too_steep_at(cell as usize))
}

/// The word and sentence for a slope that is too steep, in rise per metre.
pub(crate) fn too_steep(terrain: &Terrain, rise_per_m: f64) -> NoWay {
    let degrees = |rise_per_m: f64| libm::atan(rise_per_m).to_degrees().round();
    NoWay::new(
        Refusal::TooSteep,
        format!(
            "the slope is {} degrees steep, {} degrees is the limit",
            degrees(rise_per_m),
            degrees(terrain.slopes.steepest_walked())
        ),
    )
}
