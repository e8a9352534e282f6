//! What to do next: follow the path, look around, stop, arrive, refuse.

mod climbing;
mod command;
mod decision;
mod footsteps;
mod giving_way;
mod machine;
mod part;
mod things_met;
mod walking;

pub use climbing::{Pace, StairClimbing, StairClimbingConfig};
pub use command::{Arms, Command, Footstep, Gaze, Misstep, Motion, Stepping, Velocity};
pub use decision::{
    Behaviour, BehaviourError, Decision, Outcome, PlannedFootsteps, Situation, SoleAt,
};
pub use footsteps::{Footsteps, SteppingConfig};
pub use giving_way::{GivingWay, GivingWayConfig, Mover};
pub use part::{BehaviourNeeds, BehaviourPart};
pub use planning::footsteps::StepManner;
pub use walking::{WalkingBehaviour, WalkingConfig};

/// The behaviours that come with the crate: a new one is a file or folder beside these, and its lines here.
pub const PARTS: &[BehaviourPart] = &[
    climbing::STEP_BY_STEP,
    climbing::CONTINUOUS,
    walking::PART,
    footsteps::PART,
];
