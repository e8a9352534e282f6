//! A segmenter: a way to find surfaces, and all that is kept from frame to frame.

use sensing::Intrinsics;
use settings::ConfigError;

use super::buffers::ProductBuffers;
use crate::camera_pose::correction::Correction;
use crate::camera_pose::horizon::HorizonSearch;
use crate::camera_pose::known::KnownLevels;
use crate::ground_plane::config::GroundConfig;
use crate::regions::finder::Finder;
use crate::regions::surfaces::Surfaces;
use crate::regions::walls::Walls;

/// A segmenter with this way to find surfaces.
#[derive(Debug, Clone)]
pub struct Grounded<F> {
    pub(super) config: GroundConfig,
    pub(super) camera: Intrinsics,
    pub(super) correction: Correction,
    pub(super) surfaces: Surfaces<F>,
    pub(super) search: HorizonSearch,
    pub(super) known: KnownLevels,
    pub(super) walls: Walls,
    pub(super) product: ProductBuffers,
}

impl<F: Finder> Grounded<F> {
    /// A segmenter for this camera that knows nothing of the camera's errors yet.
    pub(crate) fn around(
        finder: F,
        config: GroundConfig,
        camera: Intrinsics,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self {
            surfaces: Surfaces::new(finder, &config, &camera),
            correction: Correction::new(),
            search: HorizonSearch::default(),
            known: KnownLevels::default(),
            walls: Walls::default(),
            product: ProductBuffers::default(),
            config,
            camera,
        })
    }

    /// Whether the ground is searched from nothing, as at the start and after it was lost for long.
    pub(super) fn searching(&self) -> bool {
        !self.correction.is_settled()
    }
}
