//! What a cell is, said once: whether something stands there, how high the ground is, where its level ends, and what a metre costs.
//!
//! [`RULES`] is the list of all rules in the order in which they act. They read a view, the stairs and what the known map laid under
//! the view ([`Sight`]) into a [`Terrain`], which planner and behaviour ask. [`support`] says what lies under soles and around a place.
//!
//! Two questions come before the rules, as they turn on the goal: which level it lies on ([`GoalLevel`]), and which landing goes on to it
//! ([`LongerLandings`]).

mod cells;
pub mod footholds;
mod goal_level;
pub mod ground_map;
mod longer_landings;
mod over_slopes;
pub mod rules;
mod sight;
mod slope_cells;
mod stair_cells;
mod stair_outline;
pub mod support;
mod terrain;
#[cfg(test)]
mod testing;

pub use goal_level::{GoalLevel, GoalLevelConfig};
pub use longer_landings::{LongerLandings, LongerLandingsConfig};
pub use rules::config::TerrainConfig;
pub use rules::voronoi::VoronoiConfig;
pub use rules::{RULES, Rule, RuleName, Rules};
pub use sight::{CellSettings, HeightLimits, Needs, Rectangle, Sight, StandingAt};
pub use slope_cells::SlopeCells;
pub use stair_cells::StairCells;
pub use stair_outline::StairOutline;
pub use terrain::{RoomConfig, Terrain};
