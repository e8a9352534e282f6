//! What follows when a step fails: a new try, back to where the robot came from, or giving up.

use mapping::FeltPlace;
use robot::Side;

use super::{StairClimbing, State};
use crate::climbing::stepper;
use crate::climbing::stepper::Stepped;
use crate::machine::{State as _, Tick};
use crate::things_met::given_up;
use crate::{Footstep, Misstep, Motion, Situation};

/// What a misstep says of the world.
pub(super) const fn told(misstep: Misstep) -> &'static str {
    match misstep {
        Misstep::NoGround => "the next step is not where it was seen",
        Misstep::Obstructed => "something is in the way of the foot",
        Misstep::Buckled(_) => "a leg buckles",
    }
}

/// Whether what was felt last is no part of what was felt before.
fn is_another_thing(felt: &[FeltPlace]) -> bool {
    felt.split_last()
        .is_none_or(|(last, before)| before.iter().all(|one| one.thing != last.thing))
}

impl StairClimbing {
    /// Looks again, lets the other foot try again, or gives up: a step was taken back.
    pub(super) fn after_misstep(&mut self, tick: &Tick<'_>, misstep: Misstep, landed: usize) {
        if let Some(reason) = stepper::given_up(misstep) {
            self.refuse(reason);
            return;
        }
        self.memory.tries.missteps += 1;
        let what = told(misstep);
        let holds = self.stepper.holds.clone();
        let missed = holds.get(landed).copied();
        let run = self.run();
        let stands_on = landed.checked_sub(1).and_then(|last| run.get(last));
        if let (Some(stance), Some(missed), true) = (stands_on, missed, run.len() > 1) {
            // Together on the step that the other foot stands on, and on step by step.
            let beside = stance.foothold(missed.side, self.feet.stance_m);
            self.memory.pauses = true;
            self.stepper.start(vec![beside], &tick.pose, tick.ground_m);
            self.move_feet(Vec::new());
        } else if landed == 0 {
            if self.memory.tries.missteps >= self.walking.config().tries {
                self.refuse(format!("blocked: {what}"));
            } else {
                self.memory.pauses = true;
                self.begin_look(tick);
            }
        } else if self.tries_again() && missed.is_some() {
            // The feet stand on two levels: the other one tries again.
            self.stepper
                .start(holds[landed..].to_vec(), &tick.pose, tick.ground_m);
            self.move_feet(run);
        } else {
            let reason = format!("blocked: {what}");
            self.take_back(tick, &holds[..landed.min(holds.len())], reason);
        }
    }

    /// Whether so few steps failed that another try is worth while.
    const fn tries_again(&self) -> bool {
        self.memory.tries.missteps <= self.config.tuning.setback.second_tries
    }

    /// Looks for stairs from here, or gives up: a walking foot came upon a level that was not seen.
    pub(super) fn after_stumble(&mut self, tick: &Tick<'_>) {
        let felt = &tick.situation.view.felt;
        if self.is_walking() {
            self.touched = is_another_thing(felt);
        } else if !self.walking.counts_touch(felt) {
            self.refuse(given_up(felt));
        } else if self.machine.state().may_become(&State::Search) {
            self.look_for_what_was_met(tick);
        }
    }

    /// Whether a foot of the walk has met something and the robot has stepped back from it.
    pub(super) fn has_stepped_off(&self, situation: &Situation<'_>) -> bool {
        self.touched && !situation.stepping.stumbled && self.walking.goes_on()
    }

    /// Looks for stairs after a walking foot came upon something and the robot has stepped back: it may be a step.
    pub(super) fn after_stepping_off(&mut self, tick: &Tick<'_>) {
        self.touched = false;
        self.look_for_what_was_met(tick);
    }

    /// Looks for stairs whose step a foot may have met.
    fn look_for_what_was_met(&mut self, tick: &Tick<'_>) {
        self.memory.on = None;
        self.head.gazer.start(tick.situation.gaze);
        self.flight.clear();
        self.look_for_steps(tick);
    }

    /// Moves back to where the robot stood before the last list, and gives up for this reason.
    fn take_back(&mut self, tick: &Tick<'_>, landed: &[Footstep], reason: String) {
        let Some(from) = self.memory.came_from else {
            self.refuse(reason);
            return;
        };
        let sides = Side::BOTH
            .into_iter()
            .filter(|side| landed.iter().any(|hold| hold.side == *side));
        let holds = sides
            .map(|side| from.foothold(side, self.feet.stance_m))
            .collect();
        self.enter(State::StepBack { reason });
        self.stepper.start(holds, &tick.pose, tick.ground_m);
    }

    /// One tick of moving back: on the level to look again, from a step that failed to give up.
    pub(super) fn step_back(&mut self, tick: &Tick<'_>) -> Motion {
        match self.stepper.advance(tick.situation, tick.passed_s) {
            Stepped::Running => {}
            _ if self.memory.on.is_some() || !self.tries_again() => {
                if let State::StepBack { reason } = self.machine.state() {
                    self.refuse(reason.clone());
                }
            }
            _ => self.begin_search(tick),
        }
        self.stepper.motion()
    }
}

#[cfg(test)]
#[path = "setback_tests.rs"]
mod tests;
