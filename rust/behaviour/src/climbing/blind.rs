//! Nothing is seen, or the robot does not know where it is: it stands before or on the stairs until that is over.

use super::{Phase, StairClimbing, State};
use crate::Motion;
use crate::machine::Tick;

/// Seeing nothing for this long is being blind, s;
const BLIND_AFTER_S: f64 = 2.0;
/// for this long, it is hopeless, s.
const BLIND_LIMIT_S: f64 = 12.0;

impl Tick<'_> {
    pub(super) fn sees_nothing(&self) -> bool {
        self.unseen_s().unwrap_or(0.0) > BLIND_AFTER_S
    }
}

impl StairClimbing {
    /// Stands and looks down and around: from where the head points now perhaps nothing can be told.
    pub(super) fn wait_for_sight(&mut self, tick: &Tick<'_>) -> Motion {
        let lost = tick.situation.estimate.lost;
        if lost && self.on.is_none() {
            // Not on stairs: whoever walks can find out where it is.
            self.flight.clear();
            self.walking.resume(tick.situation);
            self.enter(State::Walk);
            return Motion::Stand;
        }
        if self.phase == Phase::Look {
            self.head.search(0.0);
            self.phase(Phase::Wait);
        }
        if self.head.advance(tick.situation.frames_used, tick.passed_s) {
            self.phase(Phase::Look);
        }
        if !lost && !tick.sees_nothing() {
            if self.on.is_some() {
                self.begin_look(tick);
                self.enter(State::Climb);
            } else {
                self.begin_search(tick);
            }
        } else if self.state_s > BLIND_LIMIT_S {
            let unseen_s = tick.unseen_s().unwrap_or(0.0);
            self.refuse(if lost {
                format!(
                    "lost: the robot has not known where it is for {:.0} s, before or on stairs",
                    self.state_s
                )
            } else {
                format!("lost: nothing has been seen for {unseen_s:.0} s, before or on stairs")
            });
        }
        Motion::Stand
    }
}

#[cfg(test)]
mod tests {
    use geometry::PlanarPose;

    use crate::climbing::simulation::TICK_NS;
    use crate::climbing::tests::up;
    use crate::{Outcome, StairClimbingConfig};

    #[test]
    fn who_sees_nothing_on_the_stairs_for_a_while_is_not_idle_meanwhile() {
        let mut simulation = up(PlanarPose::default());
        simulation.run_until(60.0, |simulation| simulation.ground_m() > 0.05);
        simulation.blind = true;
        simulation.run_until(90.0, |simulation| simulation.was_in("blind"));
        simulation.behaviour.idle_s = 54.0;
        let sees_at_s = simulation.now_s() + 8.0;
        simulation.run_until(90.0, |simulation| simulation.now_s() > sees_at_s);
        simulation.blind = false;
        let (outcome, _) = simulation.run(120.0);
        let states = &simulation.states;
        assert_eq!(outcome, Some(Outcome::GoalReached), "{states:?}");
    }

    /// The walk goes on from where the head is by now, not from where it was when the walk was broken off.
    #[test]
    fn who_loses_its_place_before_the_stairs_walks_on_without_a_jerk_of_the_head() {
        let config = StairClimbingConfig::default();
        let fastest_rad = config.gaze_speed * TICK_NS as f64 * 1e-9 + 1e-9;
        let mut simulation = up(PlanarPose::default());
        simulation.run_until(60.0, |simulation| simulation.was_in("approach"));
        simulation.lost = true;
        let mut before = simulation.gaze();
        while !simulation.was_in("locate") {
            let gaze = simulation.tick().command.gaze;
            assert!((gaze.pan_rad - before.pan_rad).abs() <= fastest_rad);
            assert!((gaze.down_rad - before.down_rad).abs() <= fastest_rad);
            before = gaze;
        }
    }
}
