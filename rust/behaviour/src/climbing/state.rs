//! The states of the behaviour, and which may follow which (003, section V).

use super::footsteps::Stance;
use crate::machine::{self, Idling};

/// What the robot is doing, and what it knows only while it does.
#[derive(Debug, Clone)]
pub(crate) enum State {
    /// The behaviour `walking` decides; its states are shown.
    Walk,
    /// Stands, looks down and swings the head to find stairs, or the one that was lost.
    Search,
    /// Moves to the place before the first edge from which it is measured, and turns square to it.
    Align,
    /// Measures the first edge and moves up to it.
    Approach(Approach),
    /// Looks for what comes next and takes steps, or stands and waits until the next one is free.
    Climb(Climb),
    /// Moves back to where it came from, to look again, or else to give up for a reason.
    StepBack { reason: String },
    /// Moves to a safe place behind the last step and is glad.
    Finish { part: Finish, lasted_s: f64 },
    /// Stands because nothing is seen; whether it looks around.
    Blind { looks: bool },
    /// Stands, having given up.
    Refuse { reason: String },
}

/// What a robot before the first edge is at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Approach {
    /// Stands and measures the edge.
    Measure,
    /// Moves up to it.
    MoveUp,
}

/// What a robot on stairs is at.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Climb {
    /// Stands and looks at what comes next.
    Look,
    /// Stands and looks, for so long now, s: something stands on the next step.
    Wait { waited_s: f64 },
    /// Moves its feet: to these stances, one after the other, or to a better place before the next step.
    Step { run: Vec<Stance> },
}

/// What a robot behind the last step is at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Finish {
    /// Walks away from the edge.
    Leave,
    /// Comes to stand.
    Stop,
    /// Stands and is glad.
    Cheer,
}

impl State {
    /// All of them.
    #[cfg(test)]
    pub(crate) fn all() -> [Self; 9] {
        let reason = String::new();
        [
            Self::Walk,
            Self::Search,
            Self::Align,
            Self::Approach(Approach::Measure),
            Self::Climb(Climb::Look),
            Self::StepBack {
                reason: reason.clone(),
            },
            Self::FINISH,
            Self::Blind { looks: false },
            Self::Refuse { reason },
        ]
    }

    /// The end of a climb as it begins.
    pub(super) const FINISH: Self = Self::Finish {
        part: Finish::Leave,
        lasted_s: 0.0,
    };
}

impl machine::State for State {
    fn name(&self) -> &'static str {
        match self {
            Self::Walk => "walk",
            Self::Search => "search",
            Self::Align => "align",
            Self::Approach(_) => "approach",
            Self::Climb(Climb::Wait { .. }) => "stop",
            Self::Climb(_) => "climb",
            Self::StepBack { .. } => "step_back",
            Self::Finish { .. } => "finish",
            Self::Blind { .. } => "blind",
            Self::Refuse { .. } => "refuse",
        }
    }

    fn may_become(&self, next: &Self) -> bool {
        match self {
            Self::Walk => matches!(next, Self::Search | Self::Align | Self::Refuse { .. }),
            Self::Search => matches!(
                next,
                Self::Walk | Self::Align | Self::Blind { .. } | Self::Refuse { .. }
            ),
            Self::Align => matches!(
                next,
                Self::Search
                    | Self::Approach(_)
                    | Self::Walk
                    | Self::Blind { .. }
                    | Self::Refuse { .. }
            ),
            Self::Approach(_) => matches!(
                next,
                Self::Search
                    | Self::Climb(_)
                    | Self::StepBack { .. }
                    | Self::Walk
                    | Self::Blind { .. }
                    | Self::Refuse { .. }
            ),
            Self::Climb(_) => matches!(
                next,
                Self::StepBack { .. }
                    | Self::Finish { .. }
                    | Self::Blind { .. }
                    | Self::Refuse { .. }
            ),
            Self::StepBack { .. } => matches!(
                next,
                Self::Search | Self::Climb(_) | Self::Blind { .. } | Self::Refuse { .. }
            ),
            Self::Finish { .. } => matches!(
                next,
                Self::Walk | Self::Search | Self::Blind { .. } | Self::Refuse { .. }
            ),
            Self::Blind { .. } => {
                matches!(
                    next,
                    Self::Walk | Self::Search | Self::Climb(_) | Self::Refuse { .. }
                )
            }
            Self::Refuse { .. } => false,
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

    /// A robot that sees nothing has a limit of its own for that.
    fn idling(&self) -> Idling {
        match self {
            Self::Blind { .. } => Idling::Pauses,
            _ => Idling::Counts,
        }
    }

    /// A stumble is dealt with once, when the walker tells of it, whatever the state.
    fn ends_by_a_stumble(&self) -> bool {
        false
    }

    fn is_interruptible(&self) -> bool {
        !matches!(self, Self::Refuse { .. } | Self::Blind { .. })
    }
}
