//! The occupancy grid: cells that are occupied or free, each independent of the others (004, section 36.2.1).

mod beam_likelihood;
mod config;
mod extent;
mod insertion;
mod laser;
mod map;
mod odds;
mod said;
mod sonar;

pub use beam_likelihood::{BeamLikelihood, BeamLikelihoodConfig};
pub use config::OccupancyConfig;
pub use insertion::ScanCounts;
pub use laser::LaserModel;
pub use map::{CellBelief, OccupancyError, OccupancyMap};
pub use odds::{log_odds, odds, probability_of_log_odds, probability_of_odds, updated_odds};
pub use sonar::{SonarConfig, SonarModel};
