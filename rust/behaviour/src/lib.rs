//! What to do next: follow the path, look around, stop, arrive, refuse.

mod climbing;
mod command;
mod decision;
mod machine;
mod place;
mod walking;

pub use climbing::{Pace, StairClimbing, StairClimbingConfig};
pub use command::{Arms, Command, Footstep, Gaze, Misstep, Motion, Stepping, Velocity};
pub use decision::{Behaviour, BehaviourError, Decision, Outcome, Situation};
pub use walking::{WalkingBehaviour, WalkingConfig};
