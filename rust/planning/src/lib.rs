//! The way: distance transform, clearance by the robot's radius, A*.

mod a_star;
mod config;
pub mod distance;
mod plan;
mod refusal;
mod route;
pub mod search;
mod shortcut;
mod specks;
mod terrain;

pub use a_star::AStar;
pub use config::AStarConfig;
pub use plan::{Climb, Goal, NoWay, Path, Plan, PlanError, Planner, Refusal, Step};
