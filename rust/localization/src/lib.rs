//! Where the robot is: attitude from the inertial measurement unit, foot contacts, leg odometry, and the localizer.

mod attitude;
mod body_state;
mod config;
mod contact;
mod history;
mod leg_odometry;
mod levelling;
mod localizer;
mod matching;
mod monte_carlo;
mod odometry_localizer;
mod play;
mod proprioception;
#[cfg(test)]
mod synthetic_walk;

pub use body_state::{BodyState, ProprioceptionError};
pub use config::ProprioceptionConfig;
pub use history::BodyStateHistory;
pub use localizer::{Estimate, Guess, Localizer, LocalizerError};
pub use matching::{MatchingConfig, MatchingLocalizer};
pub use monte_carlo::{
    Belief, MonteCarloConfig, MonteCarloLocalizer, RangeModel, StaticMap, TorsoPose,
};
pub use odometry_localizer::{OdometryLocalizer, OdometryLocalizerConfig};
pub use proprioception::Proprioception;
