//! Rule: what a foot met stands there, whatever was seen, until something as high is seen there; and what was met again beside it goes
//! on for a while.

use geometry::distance_m;
use mapping::FeltPlace;
use settings::{NOT_NEGATIVE, settings, within};

use crate::{Sight, Terrain, cells::around};

settings! {
    /// What stands where a foot met something.
    pub struct FeltThingsConfig("navigation.terrain.felt") {
        /// What a foot met is seen where what is seen there is no more than this lower.
        seen_within: f64 = 0.004, "m", NOT_NEGATIVE;
        /// What is seen in so much of the place that a sole met is what it met.
        seen_share: f64 = 0.5, "1", within(0.0, 1.0);
        /// For each place but the first, one thing goes on by this share of its known length at both ends.
        goes_on: f64 = 0.5, "1", within(0.0, 10.0);
        /// It goes on no further than this.
        longest: f64 = 1.0, "m", NOT_NEGATIVE;
        /// Where the robot's middle was so near, nothing goes on: it would have met it.
        passed: f64 = 0.06, "m", NOT_NEGATIVE;
    }
}

/// Finds the things that a robot has only felt. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct FeltThings {
    /// Places at which something was met that is not seen.
    places: Vec<FeltPlace>,
    /// The places of one thing.
    thing: Vec<FeltPlace>,
}

impl FeltThings {
    pub(super) fn apply(
        &mut self,
        terrain: &mut Terrain,
        sight: &Sight<'_>,
        config: &FeltThingsConfig,
    ) {
        self.places.clear();
        let felt = sight.view.felt.iter();
        let unseen = felt.filter(|felt| !is_seen(terrain, felt, config));
        self.places.extend(unseen.copied());
        for felt in &self.places {
            for cell in felt.cells(terrain.lattice) {
                block(terrain, terrain.lattice.center_of(cell), 0.0);
            }
        }
        while self.gather() {
            if let Some((ends_m, further_m)) = goes_on(&self.thing, config) {
                lay(terrain, ends_m, further_m, config.passed);
            }
        }
    }

    /// Takes the places of one thing out of all; false where none is left.
    fn gather(&mut self) -> bool {
        self.thing.clear();
        let Some(last) = self.places.pop() else {
            return false;
        };
        self.thing.push(last);
        let beside = |other: &mut FeltPlace| other.thing == last.thing;
        self.thing.extend(self.places.extract_if(.., beside));
        true
    }
}

/// Whether what a foot met is seen by now.
fn is_seen(terrain: &Terrain, felt: &FeltPlace, config: &FeltThingsConfig) -> bool {
    let least_m = felt.top_m - config.seen_within;
    let size = [terrain.cols, terrain.rows];
    let as_high = |index: usize| {
        terrain.blocked[index] || terrain.level_m(index).is_some_and(|m| m >= least_m)
    };
    let cells = felt.cells(terrain.lattice);
    let known = cells.filter_map(|cell| terrain.index_at(terrain.lattice.center_of(cell)));
    let (mut seen, mut all) = (0_u32, 0_u32);
    for index in known {
        all += 1;
        seen += u32::from(around(index, 1, size).any(as_high));
    }
    f64::from(seen) >= config.seen_share * f64::from(all)
}

/// The two places of a thing that are furthest apart, m, and how much further it goes on at both, m.
fn goes_on(thing: &[FeltPlace], config: &FeltThingsConfig) -> Option<([[f64; 2]; 2], f64)> {
    let pairs = (thing.iter().enumerate())
        .flat_map(|(index, a)| thing[index + 1..].iter().map(|b| [a.at_m, b.at_m]));
    let ends_m = pairs.max_by(|a, b| distance_m(a[0], a[1]).total_cmp(&distance_m(b[0], b[1])))?;
    let again = thing.len() - 1;
    let further_m = config.goes_on * again as f64 * distance_m(ends_m[0], ends_m[1]);
    Some((ends_m, further_m.min(config.longest)))
}

/// Lays a thing from one end to the other and so much further, m, but where the robot passed.
fn lay(terrain: &mut Terrain, [from, to]: [[f64; 2]; 2], further_m: f64, passed_m: f64) {
    let length_m = distance_m(from, to);
    if length_m <= 0.0 {
        return;
    }
    let pieces =
        ((length_m + 2.0 * further_m) / (terrain.room.stride * terrain.lattice.cell_m)).ceil();
    for piece in 0..=pieces as usize {
        let along_m = (length_m + 2.0 * further_m) * piece as f64 / pieces - further_m;
        let share = along_m / length_m;
        let place_m = [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
        block(terrain, place_m, passed_m);
    }
}

/// Something stands at a place, m, unless the robot's middle was nearer than this, m.
fn block(terrain: &mut Terrain, place_m: [f64; 2], passed_m: f64) {
    if let Some(index) = terrain.index_at(place_m)
        && terrain.nearest_m(place_m) >= passed_m
    {
        terrain.blocked[index] = true;
        terrain.unknown[index] = false;
        terrain.height_m[index] = f32::NAN;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mapping::Surface;

    use crate::testing::{Floor, cell, stair};

    /// A foot that came along x met something at 0.5 m.
    fn met(floor: &mut Floor, y_m: f64) {
        floor.view.felt.push(FeltPlace {
            at_m: [0.525, y_m],
            heading_rad: 0.0,
            top_m: 0.015,
            ground_m: 0.0,
            half_width_m: 0.04,
            thing: 0,
        });
    }

    fn blocked_at(floor: &Floor, x_m: f64, y_m: f64) -> bool {
        let terrain = floor.after("felt");
        terrain.blocked[cell(&terrain, x_m, y_m)]
    }

    #[test]
    fn what_a_foot_met_stands_there_though_floor_is_seen() {
        let mut floor = Floor::new();
        met(&mut floor, 0.025);
        let terrain = floor.after("felt");
        for y_m in [-0.01, 0.025, 0.06] {
            let at = cell(&terrain, 0.525, y_m);
            assert!(terrain.blocked[at] && !terrain.unknown[at]);
        }
        for [x_m, y_m] in [[0.475, 0.025], [0.575, 0.025], [0.525, 0.125]] {
            assert!(!blocked_at(&floor, x_m, y_m));
        }
        let distances = floor.after("clearance");
        assert!(distances.clearance_m(cell(&distances, 0.325, 0.025)) < 0.21);
    }

    #[test]
    fn a_step_that_is_seen_is_what_the_foot_met() {
        let mut floor = Floor::new();
        met(&mut floor, 0.025);
        floor.paint([0.5, -2.0], [2.0, 2.0], Surface::Floor(0.017));
        assert!(!blocked_at(&floor, 0.525, 0.025));
    }

    #[test]
    fn a_stair_that_is_known_is_what_the_foot_met() {
        let mut floor = Floor::new();
        met(&mut floor, 0.025);
        floor.stairs.stairs = vec![stair(0.5, 0.4, 0.017, 0.6)];
        assert!(!blocked_at(&floor, 0.525, 0.025));
    }

    #[test]
    fn what_was_met_again_beside_it_is_one_thing_that_goes_on_the_further_the_more_often_it_was_met()
     {
        let mut floor = Floor::new();
        met(&mut floor, 0.025);
        met(&mut floor, 0.225);
        // 0.1 m further at both ends.
        for (y_m, stands) in [
            (0.125, true),
            (0.305, true),
            (0.405, false),
            (-0.055, true),
            (-0.155, false),
        ] {
            assert_eq!(blocked_at(&floor, 0.525, y_m), stands, "{y_m}");
        }
        met(&mut floor, 0.425);
        assert!(blocked_at(&floor, 0.525, 0.8) && blocked_at(&floor, 0.525, -0.35));
        assert!(!blocked_at(&floor, 0.525, 0.93) && !blocked_at(&floor, 0.525, -0.48));
    }

    #[test]
    fn two_things_that_are_far_apart_leave_the_way_between_them() {
        let mut floor = Floor::new();
        met(&mut floor, 0.525);
        met(&mut floor, -0.525);
        floor.view.felt[1].thing = 1;
        assert!(!blocked_at(&floor, 0.525, 0.0) && blocked_at(&floor, 0.525, 0.525));
    }

    #[test]
    fn where_the_robot_passed_nothing_goes_on() {
        let mut floor = Floor::new();
        for x_m in [0.2, 0.3, 0.4] {
            floor.view.felt.push(FeltPlace {
                at_m: [x_m, 0.025],
                heading_rad: 1.57,
                top_m: 0.015,
                ground_m: 0.0,
                half_width_m: 0.04,
                thing: 0,
            });
        }
        assert!(!blocked_at(&floor, 0.025, 0.025) && blocked_at(&floor, 0.1, 0.025));
    }

    #[test]
    fn what_was_met_outside_of_the_window_is_left_out() {
        let mut floor = Floor::new();
        met(&mut floor, 0.025);
        floor.view.felt[0].at_m = [50.0, 0.0];
        assert!(!floor.after("felt").blocked.contains(&true));
    }
}
