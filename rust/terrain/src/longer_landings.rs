//! A landing of which a part was seen: it is taken to go on to the goal on it, as far as nothing that was seen speaks against that.
//!
//! While the robot looks at the steps, the far end of a landing is out of view. Without this, unseen ground that is walked to beside the
//! stairs would be as good a place to end as unseen ground behind their last step.

use geometry::{Goal, Map, Point, same_level};
use mapping::{FloorView, Surface};
use settings::{settings, within};
use stairs::{Edge, LevelsConfig, Stair, Staircase};

use crate::StandingAt;

settings! {
    /// Which landings are taken to go on to the goal.
    pub struct LongerLandingsConfig("navigation.terrain.longer_landings") {
        /// No landing is taken to go on further than this.
        farthest: f64 = 1.5, "m", within(0.0, 10.0);
    }
}

/// The stairs with such a landing. Reused.
#[derive(Debug, Clone, Default)]
pub struct LongerLandings {
    stairs: Staircase,
}

impl LongerLandings {
    /// The stairs for a robot that stands there; cells that were seen in fewer than `sightings` frames say nothing.
    pub fn read(
        &mut self,
        stairs: &Staircase,
        view: &FloorView,
        (stand, goal): (&StandingAt, &Goal),
        sightings: u16,
        (config, levels): (&LongerLandingsConfig, &LevelsConfig),
    ) -> &Staircase {
        self.stairs.clone_from(stairs);
        let Some(goal_m) = goal.height_m else {
            return &self.stairs;
        };
        let same = |a_m: f64, b_m: f64| same_level(a_m, b_m, levels.told);
        // On the goal's own level the floor is no landing, but what the robot climbed to is.
        let climbs = !same(goal_m, stand.height_m);
        for stair in &mut self.stairs.stairs {
            if same(stair.height_m(), goal_m)
                && (climbs || is_on(stair, stand.at_m))
                && let Some(missing_m) = missing_m(stair, goal, config.farthest)
                && goes_on(stair, missing_m, view, sightings, levels.same)
            {
                lengthen(stair, missing_m);
            }
        }
        &self.stairs
    }
}

/// Whether a place lies between a stair's edges.
fn is_on(stair: &Stair<Map>, at_m: [f64; 2]) -> bool {
    let (front, back) = (stair.front.as_line(), stair.back.as_line());
    let beside = front.offset_m(at_m).abs() <= front.half_m();
    beside && front.beyond_m(at_m) >= 0.0 && back.beyond_m(at_m) <= 0.0
}

/// How much deeper a stair would be if the goal's disc were on it, m, where it lies straight behind and no further than this, m.
fn missing_m(stair: &Stair<Map>, goal: &Goal, farthest_m: f64) -> Option<f64> {
    let (front, at_m) = (stair.front.as_line(), [goal.x_m, goal.y_m]);
    let straight = front.offset_m(at_m).abs() <= front.half_m();
    let missing_m = stair.back.as_line().beyond_m(at_m) + goal.radius_m;
    let wanted = straight && front.beyond_m(at_m) > 0.0 && stair.back_fit.is_none();
    (wanted && (0.0..=farthest_m).contains(&missing_m)).then_some(missing_m)
}

/// Whether no floor of another level was seen where it would go on.
fn goes_on(
    stair: &Stair<Map>,
    missing_m: f64,
    view: &FloorView,
    sightings: u16,
    tolerance_m: f64,
) -> bool {
    let (back, cell_m) = (stair.back.as_line(), view.lattice.cell_m);
    // Beside its edges a tread's cells may have either height.
    let half_m = (back.half_m() - cell_m).max(0.0);
    let (rows, cols) = (missing_m / cell_m, 2.0 * half_m / cell_m);
    let level = |at_m: [f64; 2]| {
        let cell = view.lattice.cell_at(at_m[0], at_m[1]);
        let index = view.cells.index(cell)?;
        match view.cells.values()[index] {
            Surface::Floor(height_m) if view.sightings.values()[index] >= sightings => {
                Some(f64::from(height_m))
            }
            _ => None,
        }
    };
    (1..=rows as usize).all(|row| {
        (0..=cols as usize).all(|col| {
            let at_m = back.at(col as f64 * cell_m - half_m, row as f64 * cell_m);
            level(at_m).is_none_or(|level_m| same_level(level_m, stair.height_m(), tolerance_m))
        })
    })
}

fn lengthen(stair: &mut Stair<Map>, by_m: f64) {
    let (sin, cos) = libm::sincos(stair.back.heading_rad());
    let moved =
        |p: &Point<Map>| Point::new(p.inner.x + by_m * cos, p.inner.y + by_m * sin, p.inner.z);
    stair.back = Edge {
        left: moved(&stair.back.left),
        right: moved(&stair.back.right),
    };
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Floor, stair, stand};

    #[test]
    fn a_landing_goes_on_to_the_goal_on_it_unless_other_floor_was_seen_there() {
        let config = (&LongerLandingsConfig::default(), &LevelsConfig::default());
        let goal = Goal {
            x_m: 1.0,
            y_m: 0.0,
            radius_m: 0.1,
            height_m: Some(0.04),
        };
        let depth_m = |floor: &Floor, goal: &Goal| {
            let stairs = Staircase {
                stairs: vec![stair(0.5, 0.3, 0.04, 0.8)],
                ..Staircase::default()
            };
            let mut landings = LongerLandings::default();
            let seen = (&stand(), goal);
            landings.read(&stairs, &floor.view, seen, 3, config).stairs[0].depth_m()
        };
        let mut floor = Floor::new();
        assert!(
            (depth_m(&floor, &goal) - 0.3).abs() < 1e-9,
            "the floor speaks against it"
        );
        floor.paint([0.5, -0.5], [2.0, 0.5], Surface::Unknown);
        assert!((depth_m(&floor, &goal) - 0.6).abs() < 1e-9);
        let below = Goal {
            height_m: Some(0.0),
            ..goal
        };
        assert!((depth_m(&floor, &below) - 0.3).abs() < 1e-9);
    }
}
