//! What a machine must know of a state.

use std::fmt::Debug;
use std::mem::discriminant;

/// Whether the time in a state is idle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Idling {
    /// Nothing is done for the goal.
    Counts,
    /// The robot waits for what has a limit of its own.
    Pauses,
    /// The robot gets on.
    Ends,
}

/// A state of a behaviour, with what is known only while it lasts.
pub(crate) trait State: Debug + Clone {
    /// The name in the recording's lane.
    fn name(&self) -> &'static str;

    /// Whether `next` may follow.
    fn may_become(&self, next: &Self) -> bool;

    /// The state of a robot that has given up for this reason. It is final.
    fn refuse(reason: String) -> Self;

    /// Why the robot has given up, if it has.
    fn refusal(&self) -> Option<&str>;

    /// Whether the time in it is idle.
    fn idling(&self) -> Idling;

    /// Whether a stumble ends it, for as long as the walker tells of one.
    fn ends_by_a_stumble(&self) -> bool;

    /// Whether what happens may end it before its own end.
    fn is_interruptible(&self) -> bool;

    /// Whether nothing may be seen in it for longer than elsewhere.
    fn is_patient(&self) -> bool {
        false
    }

    /// Whether the robot walks by what it has seen ahead.
    fn walks(&self) -> bool {
        false
    }

    /// Whether it is the same state, whatever is known in it.
    fn is_kind_of(&self, other: &Self) -> bool {
        discriminant(self) == discriminant(other)
    }
}
