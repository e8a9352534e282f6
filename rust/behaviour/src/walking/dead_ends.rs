//! Places at which a look around showed no way.
//!
//! Each of two such places may hope for the other: from either, what lies before the other one is out of sight. Headway ends that no sooner
//! than time does, since on the way from one to the other there always is some.

use geometry::distance_m;

/// The places, and how often each was one.
#[derive(Debug, Clone, Default)]
pub(crate) struct DeadEnds {
    places: Vec<([f64; 2], u32)>,
}

impl DeadEnds {
    /// Adds a place, m; says how often it has been one, with all that lie within a radius, m.
    pub(super) fn meet(&mut self, place_m: [f64; 2], radius_m: f64) -> u32 {
        let met = (self.places.iter_mut()).find(|(at_m, _)| distance_m(*at_m, place_m) <= radius_m);
        if let Some((_, times)) = met {
            *times += 1;
            return *times;
        }
        self.places.push((place_m, 1));
        1
    }

    /// Nothing was looked at in vain.
    pub(super) fn forget(&mut self) {
        self.places.clear();
    }
}

#[cfg(test)]
mod tests {
    use geometry::PlanarPose;
    use planning::{NoWay, Plan, Refusal};

    use super::*;
    use crate::walking::simulation::{Simulation, walking};
    use crate::walking::track::tests::straight;
    use crate::{Outcome, WalkingConfig};

    #[test]
    fn a_place_is_counted_with_what_lies_near_and_others_for_themselves() {
        let mut ends = DeadEnds::default();
        let met = [[0.0, 0.0], [2.0, 0.0], [0.1, 0.1], [2.0, 0.3], [-0.1, 0.0]];
        let times = met.map(|place_m| ends.meet(place_m, 0.15));
        assert_eq!(times, [1, 1, 2, 1, 3]);
        ends.forget();
        assert_eq!(ends.meet([0.0, 0.0], 0.15), 1);
    }

    /// From x = 1 no way leads on, and who looks away from the goal there hopes for one elsewhere; from x < 0 it looks open before the goal.
    fn hopes_for_the_other_place(pose: &PlanarPose) -> Plan {
        let here_m = [pose.x_m, pose.y_m];
        let faces_goal = pose.yaw_rad.abs() < 1.5;
        let way = if pose.x_m < 0.0 || (faces_goal && pose.x_m < 0.95) {
            Ok(straight(here_m, [1.2, 0.0]))
        } else if faces_goal {
            Err(NoWay::new(Refusal::Blocked, "a wall".to_owned()))
        } else {
            Ok(straight(here_m, [-0.6, 0.0]))
        };
        let replanned = true;
        Plan { way, replanned }
    }

    #[test]
    fn who_finds_no_way_at_one_place_time_and_again_gives_up_there() {
        let mut simulation = Simulation::new(PlanarPose::default(), [3.0, 0.0]);
        simulation.plans = Some(hopes_for_the_other_place);
        let (outcome, after_s) = simulation.run(400.0);
        assert_eq!(
            outcome,
            Some(Outcome::Refused("blocked: a wall".to_owned())),
            "{:?}",
            simulation.states
        );
        assert!(after_s < 150.0, "{after_s}");
    }

    #[test]
    fn who_gives_up_at_once_has_looked_behind_itself_all_the_same() {
        let mut simulation = Simulation::new(PlanarPose::default(), [1.5, 0.0]);
        simulation.behaviour = walking(WalkingConfig {
            tries: 1,
            ..WalkingConfig::default()
        });
        simulation.closed = true;
        assert!(simulation.run(120.0).0.is_some());
        assert!(simulation.was_in("turn"), "{:?}", simulation.states);
    }
}
