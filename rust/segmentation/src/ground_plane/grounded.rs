//! A segmenter: a way to find surfaces, and all that is kept from frame to frame.

use sensing::Intrinsics;
use settings::{ConfigError, Table};

use super::buffers::ProductBuffers;
use crate::camera_pose::correction::Correction;
use crate::camera_pose::horizon::HorizonSearch;
use crate::camera_pose::known::KnownLevels;
use crate::ground_plane::config::GroundConfig;
use crate::picture::median::Median;
use crate::picture::noise::NoiseMap;
use crate::picture::pixels::fineness;
use crate::regions::cuts::Cuts;
use crate::regions::finder::Finder;
use crate::regions::roughness::Roughness;
use crate::regions::slivers::Slivers;
use crate::regions::slopes::Slopes;
use crate::regions::surfaces::{SurfaceParts, Surfaces};
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
        let tuning = config.tuning.clone();
        let pixels = camera.width * camera.height;
        let finer = fineness(pixels, tuning.enough_pixels);
        let parts = surface_parts(&config, &camera, finer);
        Ok(Self {
            surfaces: Surfaces::new(finder, parts, &camera, finer),
            correction: Correction::new(tuning.correction),
            search: HorizonSearch::new(tuning.tilt_search),
            known: KnownLevels::new(tuning.known_floor),
            walls: Walls::new(tuning.walls, tuning.tilted.least_rise),
            product: ProductBuffers::new(tuning.steps),
            config,
            camera,
        })
    }

    /// Whether the ground is searched from nothing, as at the start and after it was lost for long.
    pub(super) fn searching(&self) -> bool {
        !self.correction.is_settled()
    }
}

/// What surfaces are found with, beside the finder.
fn surface_parts(config: &GroundConfig, camera: &Intrinsics, finer: usize) -> SurfaceParts {
    let tuning = config.tuning.clone();
    let size = [camera.width, camera.height];
    let noise = [config.noise_floor, config.noise_ceiling];
    SurfaceParts {
        tuning: tuning.surfaces,
        fit_tuning: tuning.fits,
        floor_tilt_rad: config.floor_tilt,
        median: Median::new(tuning.median),
        noise: NoiseMap::new(size, finer, noise, tuning.noise),
        roughness: Roughness::new(config.noise_floor as f32, tuning.roughness),
        slivers: Slivers::new(tuning.slivers),
        cuts: Cuts::new(tuning.cuts),
        slopes: Slopes::new(tuning.slopes),
    }
}
