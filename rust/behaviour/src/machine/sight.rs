//! Blindness: nothing is seen for a while, comes back into sight, or does not.

use super::{Machine, State, Tick};

/// How a robot fares that stands because it sees nothing, or does not know where it is.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum SightAgain {
    /// It sees again, and knows where it is.
    Back,
    /// It waits.
    Away,
    /// It has waited too long: the reason to give up.
    Hopeless(String),
}

impl<S: State> Machine<S> {
    /// Whether the robot sees nothing, by the patience of its state.
    pub(super) fn is_blind(&self, tick: &Tick<'_>) -> bool {
        let patience = if self.state.is_patient() {
            self.limits.patience
        } else {
            1.0
        };
        tick.unseen_s() > patience * self.limits.blind_after_s
            || (self.state.walks() && self.is_dark())
    }

    /// Whether the pictures have been dark for long.
    pub(crate) fn is_dark(&self) -> bool {
        self.dark.s() > self.limits.dark.1
    }

    /// Whether a robot sees again that stands for want of sight, since it entered its state.
    pub(crate) fn sight(&self, tick: &Tick<'_>) -> SightAgain {
        let lost = tick.situation.estimate.lost;
        if !lost && !self.is_blind(tick) {
            return SightAgain::Back;
        }
        if self.lasted_s() <= self.limits.blind_limit_s {
            return SightAgain::Away;
        }
        let place = self.limits.place_words;
        SightAgain::Hopeless(if lost {
            let lasted_s = self.lasted_s();
            format!("lost: the robot has not known where it is for {lasted_s:.0} s{place}")
        } else {
            let (unseen_s, share) = (tick.unseen_s(), tick.situation.measured_share);
            match share
                .filter(|&share| share > 0.0)
                .map(|share| 100.0 * share)
            {
                Some(percent) => format!(
                    "lost: no ground has been seen for {unseen_s:.0} s, in pictures with {percent:.0} % of their pixels{place}"
                ),
                None => format!("lost: nothing has been seen for {unseen_s:.0} s{place}"),
            }
        })
    }
}
