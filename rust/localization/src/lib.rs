//! Where the robot is: the localizers.

mod localizer;
mod matching;
mod monte_carlo;
mod odometry;

pub use localizer::{Estimate, Guess, Localizer, LocalizerError};
pub use matching::{MatchingConfig, MatchingLocalizer};
pub use monte_carlo::{
    Belief, MonteCarloConfig, MonteCarloLocalizer, RangeModel, StaticMap, TorsoPose,
};
pub use odometry::{OdometryLocalizer, OdometryLocalizerConfig};
