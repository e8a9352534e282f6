//! Where the feet go: a sequence of steps over a height map, each onto a place where a sole finds support.
//!
//! ARA* over the foot that stands (after 004, ref 36.31, whose search it shares with `ara_star`): a step leads to the other foot's place.
//! What a step costs is the time that it takes. The search is led by a field over coarse cells that is rooted at the goal.

mod config;
mod exits;
mod field_steps;
mod goal_field;
mod kept;
mod lattice_tables;
mod layer;
mod limits;
mod listed;
mod passes;
mod plan;
mod question;
mod single_step;
mod space;
mod spots;
mod step_table;
#[cfg(test)]
mod tests;
mod unseen;

pub use config::FootstepsConfig;
pub use layer::{FootstepLayer, PlanTimes};
pub use limits::StepLimits;
pub use listed::{ListedStep, RefusedStep, StepFault};
pub use plan::{FootstepPlan, NoFootsteps, PlannedFootstep, StepCost, StepManner};
pub use question::FootstepQuestion;
pub use terrain::footholds::SoleSize;
pub use unseen::Unseen;
