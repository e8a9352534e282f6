//! The end of a climb: to the middle of where it led, arms up for a moment, and on (003, section V.D).

use super::{Memory, StairClimbing, State, state::Finish};
use crate::{Motion, Velocity, machine::Tick};

impl StairClimbing {
    /// No step is left.
    pub(super) fn end_climb(&mut self, tick: &Tick<'_>) {
        if self.has_room(tick) {
            self.enter(State::FINISH);
            return;
        }
        let reason = tick.no_way_reason().unwrap_or_else(|| {
            "blocked: the last step is too short to stand and to turn on".to_owned()
        });
        self.look_again(tick, || reason);
    }

    /// Whether the climb has ended at the goal, on a tread from which there is no walking on: there the robot stays.
    fn stays_here(&self, tick: &Tick<'_>) -> bool {
        self.is_in_the_goal(tick) && !self.has_room(tick)
    }

    /// Whether it declares from there that it has arrived: no walk will.
    pub(super) fn has_arrived(&self, tick: &Tick<'_>) -> bool {
        let cheered = matches!(self.machine.state(), State::Finish { part, lasted_s }
            if self.has_cheered(*part, *lasted_s));
        cheered && tick.situation.standing && self.stays_here(tick)
    }

    fn has_cheered(&self, part: Finish, lasted_s: f64) -> bool {
        part == Finish::Cheer && lasted_s > self.config.cheer
    }

    /// One tick; `part` had lasted so long at the last one, s.
    pub(super) fn finish(&mut self, tick: &Tick<'_>, part: Finish, lasted_s: f64) -> Motion {
        let lasted_s = lasted_s + tick.passed_s;
        let ahead_m = self.config.tuning.head.finish_ahead;
        self.head.turn_to([ahead_m, 0.0], tick.passed_s);
        let stays = self.stays_here(tick);
        let tuning = &self.config.tuning.finish;
        let slowest_mps = self.walking.config().tuning.track.slowest;
        let remaining_m = self.memory.on.filter(|_| !stays).map_or(0.0, |step| {
            let beyond_m = step.stair.front.beyond_m([tick.pose.x_m, tick.pose.y_m]);
            (0.5 * step.stair.depth_m()).min(tuning.farthest) - beyond_m
        });
        let next = match part {
            Finish::Leave if remaining_m > tuning.there && lasted_s < tuning.longest_walk => {
                let speed_mps = tuning.gain * remaining_m;
                let x_mps = speed_mps.clamp(slowest_mps, tuning.fastest.max(slowest_mps));
                self.machine.go_on(State::Finish { part, lasted_s });
                return Motion::Walk(Velocity {
                    x_mps,
                    ..Velocity::default()
                });
            }
            Finish::Leave => Finish::Stop,
            Finish::Stop if tick.situation.standing || lasted_s > tuning.longest_stop => {
                Finish::Cheer
            }
            Finish::Cheer if self.has_cheered(part, lasted_s) && !stays => {
                self.memory = Memory::default();
                self.flight.clear();
                self.walking.resume(tick.situation);
                self.enter(State::Walk);
                return Motion::Stand;
            }
            Finish::Stop | Finish::Cheer => part,
        };
        let lasted_s = if next == part { lasted_s } else { 0.0 };
        self.machine.go_on(State::Finish {
            part: next,
            lasted_s,
        });
        Motion::Stand
    }
}

#[cfg(test)]
mod tests {
    use geometry::PlanarPose;

    use crate::climbing::Pace;
    use crate::climbing::simulation::{Simulation, straight};
    use crate::{Motion, Outcome};

    /// Before four treads of 15 cm with the goal towards the back of the second, 6 cm high.
    fn goal_on_a_tread(height_m: Option<f64>, pace: Pace) -> Simulation {
        let course = straight(0.6, &[(0.03, 0.15); 4], 0.4);
        let mut simulation = Simulation::new(PlanarPose::default(), course, [0.88, 0.0], pace);
        simulation.goal.height_m = height_m;
        simulation
    }

    /// It stays where it came to stand with both feet, and says that it has arrived.
    fn assert_stays_on_the_tread(simulation: &mut Simulation) {
        simulation.run_until(60.0, |simulation| simulation.ground_m() > 0.05);
        let mut outcome = None;
        while outcome.is_none() && simulation.now_s() < 90.0 {
            let decision = simulation.tick();
            let walks = matches!(decision.command.motion, Motion::Walk(_));
            assert!(!walks, "{:?}", simulation.states);
            outcome = decision.outcome;
        }
        let states = &simulation.states;
        assert_eq!(outcome, Some(Outcome::GoalReached), "{states:?}");
        let heights_m = simulation.feet.map(|foot| foot.height_m);
        assert!(
            heights_m
                .iter()
                .all(|height_m| (height_m - 0.06).abs() < 1e-6)
        );
    }

    #[test]
    fn a_goal_on_a_tread_too_short_to_walk_on_is_reached_on_that_tread() {
        for pace in [Pace::StepByStep, Pace::Continuous] {
            for height_m in [Some(0.06), None] {
                assert_stays_on_the_tread(&mut goal_on_a_tread(height_m, pace));
            }
        }
    }

    /// Without a plan the stairs themselves show more steps.
    #[test]
    fn who_stands_at_the_goal_takes_no_step_away_from_it() {
        for pace in [Pace::StepByStep, Pace::Continuous] {
            let mut simulation = goal_on_a_tread(Some(0.06), pace);
            simulation.run_until(60.0, |simulation| simulation.was_in("approach"));
            simulation.planning = false;
            assert_stays_on_the_tread(&mut simulation);
        }
    }
}
