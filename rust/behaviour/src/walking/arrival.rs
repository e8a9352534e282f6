//! Whether the robot has arrived: in the goal's disc, and on its level where one is told.

use terrain::support::is_roomy;

use super::{WalkingBehaviour, state::State, tick::WayTick, track::Track};
use crate::{Motion, Outcome, machine::Tick};

/// Both the goal's height and the robot's own may be off by what told heights may: a robot that has walked and climbed for long knows
/// its height no better.
const OWN_AND_TOLD: f64 = 2.0;

impl WalkingBehaviour {
    /// Whether the robot is on the goal's level, as far as one is told: below a platform it may stand in the disc and be nowhere near.
    fn is_on_the_goals_level(&self, tick: &Tick<'_>) -> bool {
        tick.goal_off_level_m()
            .is_none_or(|off_m| off_m <= OWN_AND_TOLD * self.levels.told)
    }

    /// Whether the robot is no further from the goal's middle than this, m, and on its level.
    fn is_within(&self, tick: &Tick<'_>, radius_m: f64) -> bool {
        tick.goal_away_m() <= radius_m && self.is_on_the_goals_level(tick)
    }

    fn is_in_the_disc(&self, tick: &Tick<'_>) -> bool {
        self.is_within(tick, tick.situation.goal.radius_m)
    }

    /// A path may end at the rim of the goal's disc: where there is room, the way goes on to its middle.
    pub(super) fn lengthened(&self, track: Track, tick: &Tick<'_>) -> Track {
        let (pose, [x_m, y_m]) = (&tick.pose, tick.goal_m());
        let half_way = [f64::midpoint(x_m, pose.x_m), f64::midpoint(y_m, pose.y_m)];
        let roomy = |place_m| is_roomy(tick.situation.view, place_m, self.config.slow_clearance);
        let near = tick.goal_away_m()
            < tick.situation.goal.radius_m + self.config.tuning.arrival.path_end
            && self.is_on_the_goals_level(tick);
        if near && roomy([x_m, y_m]) && roomy(half_way) {
            track.going_on_to(pose.inverse().apply(x_m, y_m))
        } else {
            track
        }
    }

    /// Deep inside the goal's disc, or as deep as the way leads.
    pub(super) fn has_arrived(&self, tick: &WayTick<'_>) -> bool {
        let radius_m = tick.situation.goal.radius_m;
        let way_done = tick.track.map_or(tick.finds_no_way(), |(_, track)| {
            track.whole_m() < self.config.tuning.arrival.path_end
        });
        tick.situation.last_goal
            && (self.is_within(tick, self.config.arrive_share * radius_m)
                || (way_done && self.is_in_the_disc(tick)))
    }

    /// Well inside the goal's disc.
    pub(super) fn is_inside(&self, tick: &WayTick<'_>) -> bool {
        let radius_m = tick.situation.goal.radius_m;
        let most_m = self.config.tuning.arrival.via_share * radius_m;
        self.is_within(tick, radius_m - self.config.via_margin.min(most_m))
    }

    /// Stands at the goal for a while, and goes on when it has slipped out.
    pub(super) fn arrive(&mut self, tick: &WayTick<'_>) -> Motion {
        self.gaze_at(tick, 0.0, self.config.gaze_far);
        if self.rests() && !self.is_in_the_disc(tick) {
            self.watched_m = None;
            self.enter(State::Stop);
        }
        Motion::Stand
    }

    /// Whether it has stood long enough to say that it has arrived.
    fn rests(&self) -> bool {
        self.standing.s() > self.config.arrive_time
    }

    pub(super) fn outcome(&self, tick: &WayTick<'_>) -> Option<Outcome> {
        match self.machine.state() {
            State::Arrive => {
                (self.rests() && self.is_in_the_disc(tick)).then_some(Outcome::GoalReached)
            }
            _ => self.machine.refusal(tick.situation.standing),
        }
    }
}

#[cfg(test)]
mod tests {
    use geometry::PlanarPose;

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
