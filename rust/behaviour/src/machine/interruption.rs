//! What may end a state before its own end.

use super::{Machine, State, Tick};

/// What ends a state, the most urgent first.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Interruption {
    /// A walking foot came upon a level that nobody told it of.
    Stumble,
    /// The robot does not know where it is.
    Lost,
    /// It is where it was to go.
    Arrival,
    /// It sees nothing.
    Blind,
    /// Nothing has been done for the goal for too long: the reason to give up.
    Idle(String),
}

impl<S: State> Machine<S> {
    /// What ends the present state now.
    pub(crate) fn interruption(
        &self,
        tick: &Tick<'_>,
        has_arrived: impl FnOnce() -> bool,
    ) -> Option<Interruption> {
        if !self.state.is_interruptible() {
            return None;
        }
        if tick.situation.stepping.stumbled && self.state.ends_by_a_stumble() {
            Some(Interruption::Stumble)
        } else if tick.situation.estimate.lost {
            Some(Interruption::Lost)
        } else if has_arrived() {
            Some(Interruption::Arrival)
        } else if self.is_blind(tick) {
            Some(Interruption::Blind)
        } else {
            self.idleness(tick).map(Interruption::Idle)
        }
    }

    /// Why a robot gives up that has been idle for too long.
    fn idleness(&self, tick: &Tick<'_>) -> Option<String> {
        let (limit_s, words) = (self.limits.idle_limit_s, self.limits.idle_words);
        (self.idle.s() > limit_s).then(|| {
            tick.no_way_reason()
                .unwrap_or_else(|| format!("lost: {words} for {limit_s:.0} s"))
        })
    }
}
