//! What a behaviour made of states does, whatever its states are: reads a tick, enters a state, waits in bounded time, is
//! interrupted, and gives up.

mod clock;
mod interruption;
mod sight;
mod state;
mod tick;

#[cfg(test)]
mod tests;

use clock::Clock;
pub(crate) use clock::Stopwatch;
pub(crate) use interruption::Interruption;
pub(crate) use sight::SightAgain;
pub(crate) use state::{Idling, State};
pub(crate) use tick::Tick;

use crate::{Outcome, Situation};

/// The limits of a machine, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Limits {
    /// Seeing nothing for this long is being blind.
    pub(crate) blind_after_s: f64,
    /// In some states nothing may be seen for so many times as long ([`super::State::is_patient`]).
    pub(crate) patience: f64,
    /// Being blind for this long is hopeless.
    pub(crate) blind_limit_s: f64,
    /// While the robot walks, no more than this share of the picture being measured, for longer than that, s, is being blind, too: the
    /// whole view is filled by what is too near to be measured.
    pub(crate) dark: (f64, f64),
    /// Nothing has been done for the goal for this long: the robot gives up.
    pub(crate) idle_limit_s: f64,
    /// What could not be done then.
    pub(crate) idle_words: &'static str,
    /// Where the robot was blind, as the end of a sentence.
    pub(crate) place_words: &'static str,
}

/// The present state, how long it has lasted, and what the clocks say.
#[derive(Debug, Clone)]
pub(crate) struct Machine<S> {
    state: S,
    lasted: Stopwatch,
    /// How long nothing was done for the goal.
    idle: Stopwatch,
    /// How long next to nothing of the picture was measured.
    dark: Stopwatch,
    clock: Clock,
    limits: Limits,
}

impl<S: State> Machine<S> {
    /// A machine that begins in this state.
    pub(crate) fn new(state: S, limits: Limits) -> Self {
        Self {
            state,
            lasted: Stopwatch::default(),
            idle: Stopwatch::default(),
            dark: Stopwatch::default(),
            clock: Clock::default(),
            limits,
        }
    }

    /// The present state.
    pub(crate) const fn state(&self) -> &S {
        &self.state
    }

    /// What is known in the present state, to be changed while it lasts.
    pub(crate) const fn state_mut(&mut self) -> &mut S {
        &mut self.state
    }

    /// How long the present state has lasted, s.
    pub(crate) const fn lasted_s(&self) -> f64 {
        self.lasted.s()
    }

    /// Whether there was a tick.
    pub(crate) const fn has_begun(&self) -> bool {
        self.clock.has_begun()
    }

    /// What a tick brings.
    pub(crate) fn read<'a>(&self, situation: &'a Situation<'a>) -> Tick<'a> {
        self.clock.read(situation)
    }

    /// Counts a tick.
    pub(crate) fn keep_time(&mut self, tick: &Tick<'_>) {
        self.clock.count(tick);
        self.lasted.count(true, tick.passed_s);
        self.dark
            .count(tick.is_dark(self.limits.dark.0), tick.passed_s);
        match self.state.idling() {
            Idling::Counts => self.idle.count(true, tick.passed_s),
            Idling::Ends => self.idle.reset(),
            Idling::Pauses => {}
        }
    }

    /// Enters a state, and says whether it is another one. In a state that is on, nothing begins.
    pub(crate) fn enter(&mut self, next: S) -> bool {
        let enters = !self.state.is_kind_of(&next) && self.state.may_become(&next);
        debug_assert!(
            enters || self.state.is_kind_of(&next),
            "{:?} -> {next:?}",
            self.state
        );
        if enters {
            self.state = next;
            self.lasted.reset();
        }
        enters
    }

    /// Begins the present state again, with what is known now.
    pub(crate) fn begin_again(&mut self, state: S) {
        self.go_on(state);
        self.lasted.reset();
    }

    /// Goes on in the present state, with what is known now.
    pub(crate) fn go_on(&mut self, state: S) {
        let same = self.state.is_kind_of(&state);
        debug_assert!(same, "{:?} is not {state:?}", self.state);
        if same {
            self.state = state;
        }
    }

    /// Takes up a state where another behaviour left the robot: what was waited for before counts no more.
    pub(crate) fn resume(&mut self, state: S, time_ns: u64) {
        self.clock.skip_to(time_ns);
        self.state = state;
        self.lasted.reset();
        self.idle.reset();
    }

    /// Something was done for the goal.
    pub(crate) const fn gets_on(&mut self) {
        self.idle.reset();
    }

    /// Has it have done nothing for the goal for so long, s.
    #[cfg(test)]
    pub(crate) fn set_idle_s(&mut self, idle_s: f64) {
        self.idle.reset();
        self.idle.count(true, idle_s);
    }

    /// The refusal, once the robot has given up and stands.
    pub(crate) fn refusal(&self, standing: bool) -> Option<Outcome> {
        let reason = self.state.refusal().filter(|_| standing)?;
        Some(Outcome::Refused(reason.to_owned()))
    }
}
