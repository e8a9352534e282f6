//! What the robot remembers of the climb that it is on.

use planning::Step;

use super::footsteps::Stance;

/// The climb so far: forgotten at its end.
#[derive(Debug, Clone, Default)]
pub(super) struct Memory {
    /// The stair that the robot stands on, once it has climbed one.
    pub(super) on: Option<Step>,
    /// Where it stood before the last step.
    pub(super) came_from: Option<Stance>,
    /// Whether a climb without stops goes on step by step, after a step of it failed.
    pub(super) pauses: bool,
    /// What was tried since the last step.
    pub(super) tries: Tries,
}

/// How often something was tried without success.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Tries {
    /// Looks at the same step.
    pub(super) looks: u32,
    /// Moves to the place from which a step is taken.
    pub(super) moves: u32,
    /// Lanes that were left for another one before the first step.
    pub(super) lanes: u32,
    /// Steps that were taken back.
    pub(super) missteps: u32,
    /// Searches for stairs without a climb after them.
    pub(super) searches: u32,
    /// Stairs that were looked at from near by.
    pub(super) inspections: u32,
}
