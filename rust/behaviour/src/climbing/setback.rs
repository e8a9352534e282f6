//! What follows when a step fails: a new try, back to where the robot came from, or giving up.

use robot::Side;

use super::{Phase, StairClimbing, State};
use crate::climbing::footsteps::Foothold;
use crate::climbing::stepper::Stepped;
use crate::machine::Tick;
use crate::{Misstep, Motion};

/// What a misstep says of the world.
pub(super) const fn told(misstep: Misstep) -> &'static str {
    match misstep {
        Misstep::NoGround => "the next step is not where it was seen",
        Misstep::Obstructed => "something is in the way of the foot",
    }
}

impl StairClimbing {
    /// A step was taken back: look again, let the other foot try again, or give up.
    pub(super) fn after_misstep(&mut self, tick: &Tick<'_>, misstep: Misstep, landed: usize) {
        self.tries.missteps += 1;
        let what = told(misstep);
        let holds = self.stepper.holds().to_vec();
        let missed = holds.get(landed).copied();
        let stands_on = landed.checked_sub(1).and_then(|last| self.run.get(last));
        if let (Some(stance), Some(missed), true) = (stands_on, missed, self.run.len() > 1) {
            // Together on the step that the other foot stands on, and on step by step.
            let beside = stance.foothold(missed.side, self.feet.stance_m);
            self.run.clear();
            self.pauses = true;
            self.stepper.start(vec![beside], &tick.pose, tick.ground_m);
            self.phase(Phase::Step);
        } else if landed == 0 {
            if self.tries.missteps >= self.config.tries {
                self.refuse(format!("blocked: {what}"));
            } else {
                self.pauses = true;
                self.begin_look(tick);
            }
        } else if self.tries.missteps == 1 && missed.is_some() {
            // The feet stand on two levels: the other one tries once more.
            self.stepper
                .start(holds[landed..].to_vec(), &tick.pose, tick.ground_m);
            self.phase(Phase::Step);
        } else {
            self.take_back(tick, &holds[..landed.min(holds.len())]);
            self.refusal = format!("blocked: {what}");
        }
    }

    /// A walking foot came upon a level that was not seen: look for stairs from here, or give up.
    pub(super) fn after_stumble(&mut self, tick: &Tick<'_>) {
        self.tries.stumbles += 1;
        if self.tries.stumbles > self.config.tries {
            self.refuse(format!("blocked: {}", told(Misstep::Obstructed)));
        } else if self.state.may_become(State::Search) {
            self.on = None;
            self.head.gazer.start(tick.situation.gaze);
            self.flight.clear();
            self.begin_search(tick);
        }
    }

    /// Back to where the robot stood before the last list.
    fn take_back(&mut self, tick: &Tick<'_>, landed: &[Foothold]) {
        let Some(from) = self.came_from else {
            self.refuse("blocked: a step could not be finished".to_owned());
            return;
        };
        let sides = Side::BOTH
            .into_iter()
            .filter(|side| landed.iter().any(|hold| hold.side == *side));
        let holds = sides
            .map(|side| from.foothold(side, self.feet.stance_m))
            .collect();
        self.enter(State::StepBack);
        self.stepper.start(holds, &tick.pose, tick.ground_m);
        self.phase(Phase::Step);
    }

    /// One tick of moving back: on the level to look again, from a step that failed to give up.
    pub(super) fn step_back(&mut self, tick: &Tick<'_>) -> Motion {
        match self.stepper.advance(tick.situation, tick.passed_s) {
            Stepped::Running => {}
            _ if self.on.is_some() || self.tries.missteps > 1 => {
                let reason = std::mem::take(&mut self.refusal);
                self.refuse(reason);
            }
            _ => self.begin_search(tick),
        }
        self.stepper.motion()
    }
}

#[cfg(test)]
#[path = "setback_tests.rs"]
mod tests;
