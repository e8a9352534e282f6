//! A segmenter: a way to find surfaces, and all that is kept from frame to frame.

use sensing::Intrinsics;
use settings::{ConfigError, MakeError, Table, read};

use super::buffers::ProductBuffers;
use super::nearness::Nearness;
use crate::camera_pose::{Correction, HorizonSearch, KnownLevels};
use crate::ground_plane::config::GroundConfig;
use crate::part::SegmenterNeeds;
use crate::picture::{Median, NoiseMap, fineness};
use crate::planes::Segmenter;
use crate::regions::{
    Cuts, Finder, FrameSurfaces, Roughness, Slivers, SlopeSearch, SurfaceParts, Walls,
};

/// A segmenter with this way to find surfaces.
#[derive(Debug, Clone)]
pub struct Grounded<F> {
    pub(super) config: GroundConfig,
    pub(super) camera: Intrinsics,
    pub(super) correction: Correction,
    pub(super) surfaces: FrameSurfaces<F>,
    pub(super) search: HorizonSearch,
    pub(super) known: KnownLevels,
    pub(super) nearness: Nearness,
    pub(super) walls: Walls,
    pub(super) product: ProductBuffers,
    /// Whether the robot stood on a slope as the frame was taken.
    pub(super) on_slope: bool,
}

/// A finder with a table of settings.
pub trait Configured: Finder + 'static {
    /// The table.
    type Config: Table;

    /// Nothing was looked at yet.
    fn new(config: &Self::Config, ground: &GroundConfig, camera: &Intrinsics) -> Self;
}

impl<F: Configured> Grounded<F> {
    /// A segmenter for this camera that knows nothing of the camera's errors yet.
    pub fn new(
        finder: &F::Config,
        config: GroundConfig,
        camera: Intrinsics,
    ) -> Result<Self, ConfigError> {
        finder.check()?;
        config.check()?;
        let finder = F::new(finder, &config, &camera);
        let tuning = config.tuning.clone();
        let pixels = camera.width * camera.height;
        let finer = fineness(pixels, tuning.enough_pixels);
        let parts = surface_parts(&config, &camera, finer);
        Ok(Self {
            surfaces: FrameSurfaces::new(finder, parts, &camera, finer),
            correction: Correction::new(tuning.correction),
            search: HorizonSearch::new(tuning.tilt_search),
            known: KnownLevels::new(tuning.known_floor),
            nearness: Nearness::default(),
            walls: Walls::new(tuning.walls, tuning.tilted.least_rise),
            product: ProductBuffers::new(tuning.steps),
            on_slope: false,
            config,
            camera,
        })
    }

    /// A segmenter for a camera by the settings that a user wrote.
    pub(crate) fn make(needs: &SegmenterNeeds<'_>) -> Result<Box<dyn Segmenter>, MakeError> {
        let finder = read(
            needs.tables,
            F::Config::KEY.trim_start_matches("navigation."),
        )?;
        let ground = read(needs.tables, "ground")?;
        Ok(Box::new(Self::new(&finder, ground, needs.camera)?))
    }
}

impl<F> Grounded<F> {
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
        slopes: SlopeSearch::new(tuning.slopes),
    }
}
