//! How the camera of one frame is levelled: by the tilt that the level surfaces share.

use geometry::{Camera, Pose, Robot};
use nalgebra::Vector2;

use crate::camera_pose::horizon::SearchArea;
use crate::camera_pose::levelled::Levelled;
use crate::ground_plane::grounded::Grounded;
use crate::regions::cuts::TiltPrior;
use crate::regions::finder::{Finder, Look};
use crate::regions::fit::shared_tilt;

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

impl<F: Finder> Grounded<F> {
    /// Finds the camera's tilt against the prediction and the regions that are seen with it; `near`: whether nothing but what is
    /// near the feet is shown at first.
    pub(super) fn level(&mut self, predicted: Pose<Robot, Camera>, near: bool) -> Levelled {
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

    /// Takes slopes out of the level regions: their strips have no part in the view that is left. In one that is off itself the treads
    /// of low stairs are as tilted as a slope is.
    pub(crate) fn part_slopes(
        &mut self,
        mut levelled: Levelled,
        level_rad: f64,
        sigma: f64,
    ) -> Levelled {
        let level_rad = level_rad.max(self.config.floor_tilt);
        for look in [Look::First, Look::Again] {
            if !self.is_straight(&levelled) || !self.surfaces.find_slopes(&levelled.view, look) {
                break;
            }
            let expected = -levelled.tilt;
            let tilt = shared_tilt(&self.surfaces.fits, level_rad, &expected, sigma);
            let tilt = levelled.further(&tilt);
            levelled = Levelled::new(&self.camera, levelled.predicted, tilt);
            if look == Look::First {
                self.surfaces.find(&levelled.view, Look::Again);
            }
        }
        levelled
    }

    /// Whether the tilt found lies within what the camera's error may be.
    pub(super) fn is_straight(&self, levelled: &Levelled) -> bool {
        if self.searching() {
            levelled.tilt.amax() < self.config.search_tilt
        } else {
            levelled.tilt.norm() < self.config.track_tilt
        }
    }
}
