//! Where the robot is: the localizers.

mod fast_slam;
mod localizer;
mod monte_carlo;
mod odometry;
mod part;
mod particle_maps;
mod scan_match;

pub use fast_slam::{FastSlamLocalizer, FastSlamLocalizerConfig};
pub use localizer::{Estimate, Guess, Localizer, LocalizerError};
pub use monte_carlo::{
    Belief, CameraEstimate, CameraLocalizer, MonteCarloConfig, MonteCarloLocalizer, RangeModel,
    StaticMap, TorsoPose,
};
pub use odometry::{OdometryLocalizer, OdometryLocalizerConfig};
pub use part::{LocalizerNeeds, LocalizerPart};
pub use particle_maps::{ParticleMap, ParticleMaps, ParticleMapsRule};
pub use scan_match::{MatchingConfig, MatchingLocalizer};

/// The localizers that come with the crate: a new one is a file or folder beside these, and its lines here.
pub const PARTS: &[LocalizerPart] = &[
    odometry::PART,
    scan_match::PART,
    monte_carlo::PART,
    fast_slam::PART,
];
