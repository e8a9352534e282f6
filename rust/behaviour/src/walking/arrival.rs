//! Whether the robot has arrived: in the goal's disc, and on its level where one is told.

use geometry::PlanarPose;
use planning::Goal;

use super::state::State;
use super::track::Track;
use super::{Moment, WalkingBehaviour};
use crate::walking::is_roomy;
use crate::{Outcome, Situation};

/// Nearer than this to its end a path is done, m.
const PATH_END_M: f64 = 0.04;
/// A goal whose height is further than this from that of the ground under the robot is on another level, m: a robot that has walked
/// and climbed for long knows its height no better.
const SAME_LEVEL_M: f64 = 0.04;

/// Whether the robot is on the goal's level, as far as one is told: below a platform it may stand in the disc and be nowhere near.
fn is_on_the_level(situation: &Situation<'_>) -> bool {
    let ground_m = situation.estimate.map_from_robot.origin().inner.z;
    let height_m = situation.goal.height_m;
    height_m.is_none_or(|height_m| (height_m - ground_m).abs() <= SAME_LEVEL_M)
}

impl Moment<'_> {
    /// Whether the robot is no further from the goal's middle than this, m, and on its level.
    fn is_within(&self, radius_m: f64) -> bool {
        let goal = self.situation.goal;
        let away_m = (goal.x_m - self.pose.x_m).hypot(goal.y_m - self.pose.y_m);
        away_m <= radius_m && is_on_the_level(self.situation)
    }

    pub(super) fn is_in_the_disc(&self) -> bool {
        self.is_within(self.situation.goal.radius_m)
    }
}

impl WalkingBehaviour {
    /// A path may end at the rim of the goal's disc: where there is room, the way goes on to its middle.
    pub(super) fn lengthened(
        &self,
        track: Track,
        pose: &PlanarPose,
        situation: &Situation<'_>,
    ) -> Track {
        let Goal {
            x_m, y_m, radius_m, ..
        } = *situation.goal;
        let away_m = (x_m - pose.x_m).hypot(y_m - pose.y_m);
        let half_way = [f64::midpoint(x_m, pose.x_m), f64::midpoint(y_m, pose.y_m)];
        let roomy = |place_m| is_roomy(situation.view, place_m, self.config.slow_clearance);
        let near = away_m < radius_m + PATH_END_M && is_on_the_level(situation);
        if near && roomy([x_m, y_m]) && roomy(half_way) {
            track.going_on_to(pose.inverse().apply(x_m, y_m))
        } else {
            track
        }
    }

    /// Deep inside the goal's disc, or as deep as the way leads.
    pub(super) fn has_arrived(&self, moment: &Moment<'_>) -> bool {
        let radius_m = moment.situation.goal.radius_m;
        let way_done = moment
            .track
            .map_or(moment.no_way(), |(_, track)| track.whole_m() < PATH_END_M);
        moment.situation.last_goal
            && (moment.is_within(self.config.arrive_share * radius_m)
                || (way_done && moment.is_in_the_disc()))
    }

    /// Well inside the goal's disc.
    pub(super) fn is_inside(&self, moment: &Moment<'_>) -> bool {
        let radius_m = moment.situation.goal.radius_m;
        moment.is_within(radius_m - self.config.via_margin.min(0.5 * radius_m))
    }

    pub(super) fn outcome(&self, moment: &Moment<'_>) -> Option<Outcome> {
        match self.state {
            State::Arrive => {
                let rests = self.standing_s > self.config.arrive_time;
                (rests && moment.is_in_the_disc()).then_some(Outcome::GoalReached)
            }
            State::Refuse => moment
                .situation
                .standing
                .then(|| Outcome::Refused(self.refusal.clone())),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::walking::simulation::Simulation;

    /// In the disc of a goal at a height, with a plan that leads to its middle or one that leads nowhere.
    fn in_the_disc(height_m: f64, closed: bool) -> Simulation {
        let mut simulation = Simulation::new(PlanarPose::default(), [0.02, 0.0]);
        simulation.goal.height_m = Some(height_m);
        simulation.closed = closed;
        simulation
    }

    #[test]
    fn below_or_above_a_goal_the_robot_has_not_arrived_whatever_the_planner_says() {
        for (height_m, closed) in [(0.3, false), (0.3, true), (-0.05, false), (-0.05, true)] {
            let (outcome, _) = in_the_disc(height_m, closed).run(120.0);
            assert!(
                matches!(outcome, Some(Outcome::Refused(_))),
                "{height_m} {outcome:?}"
            );
        }
        for height_m in [0.03, -0.03] {
            let (outcome, _) = in_the_disc(height_m, false).run(120.0);
            assert_eq!(outcome, Some(Outcome::GoalReached), "{height_m}");
        }
    }

    #[test]
    fn a_via_point_is_not_passed_below_it() {
        for (height_m, passes) in [(0.3, false), (0.03, true)] {
            let mut simulation = in_the_disc(height_m, false);
            simulation.last_goal = false;
            let passed = (0..300).any(|_| simulation.tick().goal_passed);
            assert_eq!(passed, passes, "{height_m}");
        }
    }

    #[test]
    fn no_way_is_drawn_out_to_the_middle_of_a_goal_on_another_level() {
        for (height_m, goes_on) in [(0.3, false), (0.03, true)] {
            let mut simulation = Simulation::new(PlanarPose::default(), [1.0, 0.0]);
            simulation.ends_at_the_rim = true;
            simulation.goal.height_m = Some(height_m);
            let _ = simulation.run(60.0);
            assert_eq!(simulation.pose.x_m > 0.9, goes_on, "{height_m}");
        }
    }
}
