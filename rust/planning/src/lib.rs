//! The way: distance transform, clearance by the robot's radius, levels and the climbs that join them, A*.

mod a_star;
mod chains;
mod choice;
mod config;
pub mod distance;
mod faces;
mod find;
mod guide;
mod judged;
mod keep;
mod legs;
mod levels;
mod line;
pub mod links;
mod neighbours;
mod plan;
mod portals;
mod queue;
mod refusal;
mod room;
mod route;
pub mod search;
mod seek;
mod shortcut;
mod slits;
mod slopes;
mod specks;
mod steps;
mod terrain;
mod treads;
mod verge;

pub use a_star::AStar;
pub use config::{AStarConfig, Footprint};
pub use guide::Guided;
pub use plan::{Climb, Goal, NoWay, Path, Plan, PlanError, Planner, Refusal, Sidle, Step};
