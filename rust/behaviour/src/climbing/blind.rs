//! The state `blind`: nothing is seen, or the robot does not know where it is, and it stands before or on the stairs until that is
//! over.

use super::{StairClimbing, State, state::Climb};
use crate::Motion;
use crate::machine::{SightAgain, Tick};

impl StairClimbing {
    /// One tick of standing and looking down and around: from where the head points now perhaps nothing can be told.
    pub(super) fn wait_for_sight(&mut self, tick: &Tick<'_>, looks: bool) -> Motion {
        if tick.situation.estimate.lost && self.memory.on.is_none() {
            // Not on stairs: whoever walks can find out where it is.
            self.flight.clear();
            self.walking.resume(tick.situation);
            self.enter(State::Walk);
            return Motion::Stand;
        }
        if !looks {
            self.head.look_down();
        }
        let looks = !self.head.advance(tick.situation.frames_used, tick.passed_s);
        self.machine.go_on(State::Blind { looks });
        match self.machine.sight(tick) {
            SightAgain::Back if self.memory.on.is_some() => {
                self.enter(State::Climb(Climb::Look));
                self.begin_look(tick);
            }
            SightAgain::Back => self.begin_search(tick),
            SightAgain::Away => {}
            SightAgain::Hopeless(reason) => self.refuse(reason),
        }
        Motion::Stand
    }
}

#[cfg(test)]
mod tests {
    use geometry::PlanarPose;

    use crate::climbing::simulation::TICK_NS;
    use crate::climbing::tests::up;
    use crate::{Outcome, WalkingConfig};

    #[test]
    fn who_sees_nothing_on_the_stairs_for_a_while_is_not_idle_meanwhile() {
        let mut simulation = up(PlanarPose::default());
        simulation.run_until(60.0, |simulation| simulation.ground_m() > 0.05);
        simulation.blind = true;
        simulation.run_until(90.0, |simulation| simulation.was_in("blind"));
        simulation.behaviour.machine.set_idle_s(54.0);
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
        let config = WalkingConfig::default();
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
