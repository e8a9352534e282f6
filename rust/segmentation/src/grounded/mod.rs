//! What all segmenters share: a way to find surfaces, put right by the ground (003, section III).
//!
//! In disparity instead of metres: first the floor's normal, then surfaces, by whatever [`Finder`], heights fitted away
//! from the regions' borders, and the ground, whose plane corrects the camera's pose.

mod config;
mod correction;
mod cuts;
mod erosion;
mod finder;
mod fit;
mod horizon;
mod known;
mod median;
mod near;
mod noise;
mod product;
mod reference;
mod roughness;
mod slivers;
mod slopes;
mod steps;
mod surfaces;
#[cfg(test)]
mod tests;
mod tilted;
mod view;
mod walls;

use geometry::{Camera, Pose, Robot};
use nalgebra::{Rotation3, Vector2, Vector3};
use sensing::{Intrinsics, Scan};
use settings::ConfigError;

use crate::{KnownFloor, NothingKnown, Planes, SegmentError, Segmenter};
pub use config::GroundConfig;
use correction::Correction;
use cuts::TiltPrior;
pub(crate) use finder::{Finder, Look, MAX_REGIONS, Picture, Region, count_labels};
use fit::shared_tilt;
use horizon::{HorizonSearch, SearchArea};
use known::KnownLevels;
use product::ProductBuffers;
use reference::Reference;
use surfaces::Surfaces;
pub(crate) use tilted::PlaneSums;
use view::levelling;
pub(crate) use view::{Linear, View};
use walls::Walls;

/// How far a tilt may be from the predicted one: sigma, rad, while tracked and while searched.
const TRACKED_RAD: f64 = 0.008;
const SEARCHED_RAD: f64 = 0.1;
/// How far off the tilt may be that is found by what is near the feet: sigma, rad.
const NEAR_RAD: f64 = 0.015;
/// How far a surface may be tilted that tells of the tilt, rad: to a seasoned track little, for treads that are taken for one surface
/// would turn the track into the slope of the stairs, by a bit each frame; and while it is searched. Between them it is as much as a
/// floor may be tilted: the first finds may be bad ones, and a track that takes in nothing else is never put right.
const TRACKED_LEVEL_RAD: f64 = 0.015;
const SEARCHED_LEVEL_RAD: f64 = 0.09;
/// How often the regions of a frame are cut: one may hold three levels.
const CUTS: usize = 2;
/// Step of the search for the tilt while tracked, and last step of the search from nothing, rad.
const TRACK_STEP_RAD: f64 = 0.006;
const LAST_STEP_RAD: f64 = 0.006;

/// A segmenter with this way to find surfaces.
#[derive(Debug, Clone)]
pub struct Grounded<F> {
    config: GroundConfig,
    camera: Intrinsics,
    correction: Correction,
    surfaces: Surfaces<F>,
    search: HorizonSearch,
    known: KnownLevels,
    walls: Walls,
    product: ProductBuffers,
}

/// A frame's camera: where it was predicted, and the tilt found on top.
#[derive(Debug, Clone, Copy)]
struct Levelled {
    /// Whether what is near the feet told it, or bears it out.
    near: bool,
    predicted: Pose<Robot, Camera>,
    tilt: Vector2<f64>,
    view: View,
}

impl Levelled {
    fn new(camera: &Intrinsics, predicted: Pose<Robot, Camera>, tilt: Vector2<f64>) -> Self {
        let rotation = levelling(tilt.x, tilt.y) * predicted.inner.rotation.to_rotation_matrix();
        Self {
            near: false,
            predicted,
            tilt,
            view: View::new(camera, &rotation),
        }
    }

    /// The turn from the predicted camera to the levelled one, robot's axes.
    fn turn(&self) -> Rotation3<f64> {
        levelling(self.tilt.x, self.tilt.y)
    }

    /// The tilt on top of the prediction after a further one was found in the levelled axes.
    fn further(&self, tilt: &Vector2<f64>) -> Vector2<f64> {
        let up = self.turn().inverse() * Vector3::new(tilt.x, tilt.y, 1.0);
        Vector2::new(up.x / up.z, up.y / up.z)
    }
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
    fn searching(&self) -> bool {
        !self.correction.is_settled()
    }

    /// Finds the camera's tilt against the prediction and the regions that are seen with it; `near`: whether nothing but what is
    /// near the feet is shown at first.
    fn level(&mut self, predicted: Pose<Robot, Camera>, near: bool) -> Levelled {
        let mut levelled = Levelled::new(&self.camera, predicted, Vector2::zeros());
        let searching = self.searching();
        let (sigma, level_rad) = if searching {
            (SEARCHED_RAD, SEARCHED_LEVEL_RAD)
        } else if self.correction.is_seasoned() {
            (TRACKED_RAD, TRACKED_LEVEL_RAD)
        } else {
            (TRACKED_RAD, self.config.floor_tilt)
        };
        let guess = self.guess_tilt(&levelled);
        levelled = Levelled::new(&self.camera, predicted, guess);
        for look in [Look::First, Look::Again] {
            self.surfaces.find(&levelled.view, look);
            let expected = -levelled.tilt;
            let tilt = shared_tilt(&self.surfaces.fits, level_rad, &expected, sigma);
            levelled = Levelled::new(&self.camera, predicted, levelled.further(&tilt));
        }
        if near {
            self.surfaces.show_all();
            for look in [Look::First, Look::Again] {
                self.surfaces.find(&levelled.view, look);
            }
            // What is further away and as level tells it more precisely.
            let level_rad = if searching {
                self.config.floor_tilt
            } else {
                TRACKED_LEVEL_RAD
            };
            let nothing = Vector2::zeros();
            let tilt = shared_tilt(&self.surfaces.fits, level_rad, &nothing, NEAR_RAD);
            levelled = Levelled::new(&self.camera, predicted, levelled.further(&tilt));
        }
        if self.config.slopes && !searching {
            levelled = self.part_slopes(levelled, level_rad, sigma);
        }
        for _ in 0..CUTS {
            let expected = -levelled.tilt;
            let prior = TiltPrior {
                expected,
                sigma_rad: sigma,
            };
            if F::ANY_DIRECTION || !self.surfaces.cut(&levelled.view, prior) {
                break;
            }
            let tilt = shared_tilt(&self.surfaces.fits, level_rad, &expected, sigma);
            levelled = Levelled::new(&self.camera, predicted, levelled.further(&tilt));
        }
        self.surfaces.refit(&levelled.view);
        Levelled { near, ..levelled }
    }

    fn guess_tilt(&mut self, level: &Levelled) -> Vector2<f64> {
        let camera_m = level.predicted.inner.translation.vector;
        let height_m = camera_m.z;
        let area = if self.searching() {
            let slack = 2.0 * self.config.ground_height;
            SearchArea {
                tilt_rad: self.config.search_tilt,
                step_rad: self.config.search_tilt / 6.0,
                last_step_rad: LAST_STEP_RAD,
                below_m: (height_m - slack, height_m + slack),
                around_m: [-camera_m.x, -camera_m.y, self.config.search_reach]
                    .map(|value| value as f32),
            }
        } else {
            SearchArea {
                tilt_rad: TRACK_STEP_RAD,
                step_rad: TRACK_STEP_RAD,
                last_step_rad: TRACK_STEP_RAD,
                below_m: (0.15, height_m + 0.2),
                around_m: [0.0, 0.0, f32::MAX],
            }
        };
        let picture = self.surfaces.picture(&level.view);
        self.search.search(picture, &level.view, area)
    }

    /// Shows the surfaces of the picture that was read as if the joints had the camera's pose right.
    fn show_uncorrected(&mut self, scan: &Scan, planes: &mut Planes) {
        let by_joints = Levelled::new(&self.camera, scan.robot_from_camera, Vector2::zeros());
        for look in [Look::First, Look::Again] {
            self.surfaces.find(&by_joints.view, look);
        }
        self.surfaces.refit(&by_joints.view);
        planes.exposure_ns = scan.exposure_ns;
        (planes.ground, planes.reliable) = (None, true);
        self.fill_product(&by_joints, 0.0, planes);
    }
}

impl<F: Finder> Segmenter for Grounded<F> {
    fn segment(&mut self, scan: &Scan, planes: &mut Planes) -> Result<(), SegmentError> {
        self.segment_known(scan, &NothingKnown, planes)
    }

    fn segment_known(
        &mut self,
        scan: &Scan,
        known: &dyn KnownFloor,
        planes: &mut Planes,
    ) -> Result<(), SegmentError> {
        let expected = self.surfaces.labels.len();
        for found in [scan.disparity_px.len(), planes.labels.len()] {
            if found != expected {
                return Err(SegmentError::WrongSize { expected, found });
            }
        }
        self.surfaces.read(scan);
        if !self.config.correct {
            self.show_uncorrected(scan, planes);
            return Ok(());
        }
        let (mut levelled, reference) = self.level_and_refer(&scan.robot_from_camera, known);
        let predicted = levelled.predicted;
        let turn = levelled.turn().scaled_axis().xy();
        let (mut ground, mut rise_m) = (None, 0.0);
        match reference {
            Reference::Ground {
                region,
                rise_m: rise,
            } => {
                (ground, rise_m) = (Some(region), rise);
                self.surfaces.roughness.learn(region);
                self.correction
                    .found(&predicted, &turn, rise_m, levelled.near);
            }
            Reference::Known { rise_m: rise } => {
                rise_m = rise;
                self.correction.found(&predicted, &turn, rise_m, false);
            }
            Reference::Level => self.correction.confirmed(),
            Reference::None => {
                if self.searching() || !self.is_straight(&levelled) {
                    // Nothing to hold on to: what is seen is shown where the joints have it.
                    levelled = Levelled::new(&self.camera, predicted, Vector2::zeros());
                    self.surfaces.find(&levelled.view, Look::Again);
                    self.surfaces.refit(&levelled.view);
                }
                self.correction.missed_one(self.config.forget_frames);
            }
        }
        planes.exposure_ns = scan.exposure_ns;
        planes.ground = ground;
        planes.reliable = self
            .correction
            .holds(self.config.hold_frames, self.config.hold_level_frames);
        self.fill_product(&levelled, rise_m, planes);
        Ok(())
    }
}
