//! How the camera of one frame is levelled: by the tilt that the level surfaces share.

use geometry::{Camera, Pose, Robot};
use nalgebra::Vector2;

use crate::camera_pose::{Levelled, SearchArea};
use crate::ground_plane::grounded::Grounded;
use crate::regions::{Finder, Look, TiltPrior, shared_tilt};

impl<F: Finder> Grounded<F> {
    /// Finds the camera's tilt against the prediction and the regions that are seen with it; `near`: whether nothing but what is
    /// near the feet is shown at first.
    pub(super) fn level(&mut self, predicted: Pose<Robot, Camera>, near: bool) -> Levelled {
        let mut levelled = Levelled::new(&self.camera, predicted, Vector2::zeros());
        let searching = self.searching();
        let (sigma, level_rad) = self.tilt_rules();
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
                self.config.tuning.tilt.tracked_level
            };
            let nothing = Vector2::zeros();
            let near_rad = self.config.tuning.tilt.near;
            let tilt = shared_tilt(&self.surfaces.fits, level_rad, &nothing, near_rad);
            levelled = Levelled::new(&self.camera, predicted, levelled.further(&tilt));
        }
        if self.config.slopes && !searching {
            levelled = self.part_slopes(levelled, level_rad, sigma);
        }
        for _ in 0..self.config.tuning.tilt.cuts {
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

    /// How far a tilt may be from the predicted one, and how far a surface may be tilted that tells of it, rad.
    fn tilt_rules(&self) -> (f64, f64) {
        let tuning = &self.config.tuning.tilt;
        if self.searching() {
            (tuning.searched, tuning.searched_level)
        } else if self.correction.is_seasoned() {
            (tuning.tracked, tuning.tracked_level)
        } else {
            (tuning.tracked, self.config.floor_tilt)
        }
    }

    fn guess_tilt(&mut self, level: &Levelled) -> Vector2<f64> {
        let camera_m = level.predicted.inner.translation.vector;
        let height_m = camera_m.z;
        let tuning = &self.config.tuning.tilt_search;
        let area = if self.searching() {
            let slack = tuning.height_slack * self.config.ground_height;
            SearchArea {
                tilt_rad: self.config.search_tilt,
                step_rad: self.config.search_tilt / f64::from(tuning.first_steps),
                last_step_rad: tuning.last_step,
                below_m: (height_m - slack, height_m + slack),
                around_m: [-camera_m.x, -camera_m.y, self.config.search_reach]
                    .map(|value| value as f32),
            }
        } else {
            SearchArea {
                tilt_rad: tuning.tracked_step,
                step_rad: tuning.tracked_step,
                last_step_rad: tuning.tracked_step,
                below_m: (tuning.tracked_nearest, height_m + tuning.tracked_deeper),
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
