//! Climbing without a stop: one foot a step, as far as the steps ahead are known, and on with what is learnt on the way.

use super::{Pace, StairClimbing, State, state::Climb};
use crate::climbing::footsteps::{Stance, alternating};
use crate::climbing::placement::{Behind, Verdict};
use crate::machine::Tick;

impl StairClimbing {
    /// Adds the stances that can be taken behind the last one of the run; whether there was any.
    pub(super) fn lengthen_run(&self, tick: &Tick<'_>, run: &mut Vec<Stance>) -> bool {
        let before = run.len();
        while let Some(last) = run.last().copied() {
            let at = [last.pose.x_m, last.pose.y_m];
            let steps = &self.flight.steps;
            let Some(next) = steps
                .iter()
                .position(|step| step.stair.front.beyond_m(at) < 0.0)
            else {
                break;
            };
            let there = Tick {
                pose: last.pose,
                ground_m: last.height_m,
                ..*tick
            };
            if self.leaves_the_goal_by(&there, &steps[next]) {
                break;
            }
            let most_m = self.config.run_rise;
            if steps[..=next].iter().any(|step| step.rise_m.abs() > most_m) {
                break;
            }
            let mut stand = self.before(tick);
            stand.pose = last.pose;
            stand.ground_m = last.height_m;
            let behind = match steps.get(next + 1) {
                Some(after) if self.is_measured(after) => Behind::Step(after),
                Some(_) => break,
                None => stand.without_next(&steps[next]),
            };
            if !self.is_measured(&steps[next]) {
                break;
            }
            match stand.check(&steps[next], &behind) {
                Verdict::Go(stance) if !self.is_occupied(tick, &stance) => run.push(stance),
                _ => break,
            }
        }
        run.len() > before
    }

    /// The stances that the feet are on their way to.
    pub(super) fn run(&self) -> Vec<Stance> {
        match self.machine.state() {
            State::Climb(Climb::Step { run }) => run.clone(),
            _ => Vec::new(),
        }
    }

    /// Puts further steps where both feet would have come to stand, while the run is on its way.
    pub(super) fn go_on_without_a_stop(&mut self, tick: &Tick<'_>) {
        let holds = &self.stepper.holds;
        // The last step can be changed until the one before it has landed.
        let in_time = tick.situation.stepping.landed + 1 < holds.len();
        let Some(first) = holds.first().map(|hold| hold.side) else {
            return;
        };
        let mut run = self.run();
        if self.pace == Pace::Continuous
            && self.stepper.is_running()
            && !run.is_empty()
            && in_time
            && self.lengthen_run(tick, &mut run)
        {
            self.stepper
                .replace(alternating(first, &run, self.feet.stance_m));
            self.move_feet(run);
        }
    }
}

#[cfg(test)]
#[path = "continuous_tests.rs"]
mod tests;
