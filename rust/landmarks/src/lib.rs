//! Maps of landmarks (handbook, section 36.2.4): K small Gaussians where the robot's place is known, and FastSLAM on top where it is not.

mod config;
mod embedding;
mod extraction;
mod fast_slam;
mod landmark;
mod landmark_map;
mod recognition;
mod selection;
mod sighting;

pub use config::LandmarksConfig;
pub use embedding::{Embedding, EmbeddingConfig, EmbeddingError};
pub use extraction::{ExtractionConfig, StandingThing, ThingShape, standing_things};
pub use fast_slam::{FastSlam, FastSlamConfig, OdometryStep};
pub use landmark::Landmark;
pub use landmark_map::LandmarkMap;
pub use recognition::{LookingLike, Recognised, RecognitionConfig, recognise};
pub use selection::{SelectionConfig, most_useful};
pub use sighting::{ExpectedReading, LandmarkReading, RangeBearing};

use settings::TableDescription;

/// The tables of settings of this crate.
pub const TABLES: &[TableDescription] = &[
    TableDescription::of::<EmbeddingConfig>(),
    TableDescription::of::<ExtractionConfig>(),
    TableDescription::of::<FastSlamConfig>(),
    TableDescription::of::<LandmarksConfig>(),
    TableDescription::of::<RecognitionConfig>(),
    TableDescription::of::<SelectionConfig>(),
];
