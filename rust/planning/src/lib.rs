//! The way: distance transform, clearance by the robot's radius, A*.

mod plan;

pub use plan::{Goal, NoWay, Path, Plan, PlanError, Planner, Refusal};
