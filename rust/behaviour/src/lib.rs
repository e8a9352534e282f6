//! What to do next: follow the path, look around, stop, arrive, refuse.

mod command;
mod decision;

pub use command::{Command, Footstep, Gaze, Motion, Velocity};
pub use decision::{Behaviour, BehaviourError, Decision, Outcome, Situation};
