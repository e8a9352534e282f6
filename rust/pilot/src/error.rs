//! Everything that can stop the core, with the stage that said so.

use behaviour::BehaviourError;
use localization::LocalizerError;
use mapping::MapError;
use planning::PlanError;
use proprioception::ProprioceptionError;
use robot::BodyError;
use segmentation::SegmentError;
use sensing::{ObservationError, ScanError};
use settings::{ConfigError, MakeError};
use stairs::StairsError;
use walking::WalkError;

/// Why the core could not be built, or could not take an observation.
#[derive(Debug, thiserror::Error)]
pub enum PilotError {
    /// A setting that cannot be used.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// A robot that is none.
    #[error("robot: {0}")]
    Body(#[from] BodyError),
    /// Settings that are not what they should be.
    #[error("{0}")]
    Settings(String),
    /// An observation that is refused; nothing changed.
    #[error("observation: {0}")]
    Observation(#[from] ObservationError),
    /// A depth image that is refused.
    #[error("scan: {0}")]
    Scan(#[from] ScanError),
    /// Proprioception failed.
    #[error("body state: {0}")]
    BodyState(#[from] ProprioceptionError),
    /// The segmenter failed.
    #[error("segmenter: {0}")]
    Segmenter(#[from] SegmentError),
    /// The world model failed.
    #[error("world_model: {0}")]
    WorldModel(#[from] MapError),
    /// Recognition of stairs failed.
    #[error("stairs: {0}")]
    Stairs(#[from] StairsError),
    /// The localizer failed.
    #[error("localizer: {0}")]
    Localizer(#[from] LocalizerError),
    /// The planner failed.
    #[error("planner: {0}")]
    Planner(#[from] PlanError),
    /// The behaviour failed.
    #[error("behaviour: {0}")]
    Behaviour(#[from] BehaviourError),
    /// The walker failed.
    #[error("walker: {0}")]
    Walker(#[from] WalkError),
}

impl From<MakeError> for PilotError {
    fn from(error: MakeError) -> Self {
        match error {
            MakeError::Config(error) => Self::Config(error),
            MakeError::Text(text) => Self::Settings(text),
        }
    }
}
