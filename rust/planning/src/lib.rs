//! The way: A* over cells and over the climbs that join levels, the path that is followed, and reasons to refuse.
#![doc = include_str!("../README.md")]

mod a_star;
mod built_in;
mod climb_links;
mod config;
pub mod footsteps;
mod guide;
mod outside_window;
mod part;
mod path;
mod plan;
mod refusal;
pub mod search;
mod sideways_passages;
mod steep_slopes;
mod tuning;

pub use a_star::AStar;
pub use config::{AStarConfig, Footprint};
pub use geometry::Goal;
pub use guide::{GuideConfig, GuideTuning, Guided};
pub use part::{PlannerNeeds, PlannerPart};
pub use plan::{Climb, NoWay, Path, PathEnd, Plan, PlanError, Planner, Refusal, Sidle, Step};
pub use terrain::{TerrainConfig, VoronoiConfig};
pub use tuning::PlanningTuning;

/// The planners that come with the crate: a new one is a file beside these, and its lines here.
pub const PARTS: &[PlannerPart] = &[
    built_in::A_STAR,
    built_in::VORONOI,
    built_in::D_STAR_LITE,
    built_in::FIELD_D_STAR,
    built_in::ARA_STAR,
    built_in::VORONOI_GRAPH,
    built_in::HIERARCHICAL,
];
