//! The states of the behaviour, and which may follow which.

use crate::machine::{self, Idling};

/// What the robot is doing.
#[derive(Debug, Clone)]
pub(crate) enum State {
    /// The behaviour `walking` decides; its states are shown.
    Walk,
    /// Stands and looks at where the next steps go.
    Look,
    /// Stands and looks around: where it looked there was no step.
    Search,
    /// Takes steps.
    Step,
    /// Stands because nothing is seen.
    Blind,
    /// Stands at the goal.
    Arrive,
    /// Stands, having given up.
    Refuse { reason: String },
}

impl State {
    /// All of them.
    #[cfg(test)]
    pub(crate) fn all() -> [Self; 7] {
        let reason = String::new();
        [
            Self::Walk,
            Self::Look,
            Self::Search,
            Self::Step,
            Self::Blind,
            Self::Arrive,
            Self::Refuse { reason },
        ]
    }
}

impl machine::State for State {
    fn name(&self) -> &'static str {
        match self {
            Self::Walk => "walk",
            Self::Look => "look",
            Self::Search => "search",
            Self::Step => "step",
            Self::Blind => "blind",
            Self::Arrive => "arrive",
            Self::Refuse { .. } => "refuse",
        }
    }

    fn may_become(&self, next: &Self) -> bool {
        match self {
            Self::Walk => matches!(next, Self::Look | Self::Refuse { .. }),
            Self::Refuse { .. } => false,
            Self::Arrive => matches!(next, Self::Walk | Self::Refuse { .. }),
            Self::Look | Self::Search | Self::Step | Self::Blind => true,
        }
    }

    fn refuse(reason: String) -> Self {
        Self::Refuse { reason }
    }

    fn refusal(&self) -> Option<&str> {
        match self {
            Self::Refuse { reason } => Some(reason),
            _ => None,
        }
    }

    fn idling(&self) -> Idling {
        match self {
            Self::Blind | Self::Walk => Idling::Pauses,
            Self::Arrive => Idling::Ends,
            _ => Idling::Counts,
        }
    }

    fn ends_by_a_stumble(&self) -> bool {
        false
    }

    fn is_interruptible(&self) -> bool {
        matches!(self, Self::Look | Self::Search | Self::Step)
    }
}
