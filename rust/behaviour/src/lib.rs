//! What to do next: follow the path, look around, stop, arrive, refuse.

mod command;
mod decision;
mod walking;

pub use command::{Command, Footstep, Gaze, Motion, Velocity};
pub use decision::{Behaviour, BehaviourError, Decision, Outcome, Situation};
pub use walking::{WalkingBehaviour, WalkingConfig};
