//! What a frame is levelled and lifted by: the ground, or on stairs the other treads that are known.

use geometry::{Camera, Pose, Robot};
use nalgebra::Vector2;

use super::tuning::ReferenceTuning;

use crate::camera_pose::Levelled;
use crate::ground_plane::grounded::Grounded;
use crate::planes::KnownFloor;
use crate::regions::Finder;

/// What a frame's level surfaces tell of the camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum PoseReference {
    /// The ground is seen: tilt and height.
    Ground {
        /// Which region it is.
        region: usize,
        /// What brings it to height 0, m.
        rise_m: f64,
    },
    /// Other surfaces of known height are seen: tilt and height.
    Known {
        /// What brings them to where they are known to lie, m.
        rise_m: f64,
    },
    /// Level surfaces are seen of which no height is known, or a slope that lies as it is known to: the track holds.
    Level,
    /// Nothing level is seen.
    None,
}

impl<F: Finder> Grounded<F> {
    /// The camera's pose, and what it is told by. A ground that is searched, or that a young track follows, must not slope near the
    /// feet: the robot stands on it, and what is further away may be stairs. So what is near is looked at first; where that is too little or cluttered, all.
    pub(super) fn level_and_refer(
        &mut self,
        by_joints: &Pose<Robot, Camera>,
        known: &KnownFloor<'_>,
    ) -> (Levelled, PoseReference) {
        let predicted = self.correction.predict(by_joints);
        if !self.correction.is_seasoned()
            && self.look_near(&Levelled::new(&self.camera, predicted, Vector2::zeros()))
        {
            let (levelled, reference) = self.refer(predicted, known, true);
            if reference != PoseReference::None {
                return (levelled, reference);
            }
        }
        // Anew: what was found from afar may have been given up.
        let predicted = self.correction.predict(by_joints);
        self.refer(predicted, known, false)
    }

    /// One look: by all that is seen, or with the rest hidden at first by what is `near`.
    fn refer(
        &mut self,
        predicted: Pose<Robot, Camera>,
        known: &KnownFloor<'_>,
        near: bool,
    ) -> (Levelled, PoseReference) {
        let mut levelled = self.level(predicted, near);
        let mut reference = self.find_reference(&levelled, known);
        if (!self.correction.is_seasoned() || !self.correction.near)
            && let PoseReference::Ground { region, .. } = reference
        {
            match self.slopes_near(&levelled, region) {
                Some(true) => {
                    reference = PoseReference::None;
                    self.correction.doubt_afar();
                }
                Some(false) => levelled.near = true,
                None => {}
            }
        }
        (levelled, reference)
    }

    /// Leaves out what is not near the feet in this view; says no, and leaves nothing out, where too little is.
    fn look_near(&mut self, levelled: &Levelled) -> bool {
        let camera_m = levelled.predicted.inner.translation.vector;
        let least = self.config.near_floor * self.surfaces.labels.len() as f64;
        let (reach_m, least) = (self.config.near_reach, least as usize);
        self.surfaces
            .hide_far(&levelled.view, &camera_m, reach_m, least)
    }

    /// The ground among the regions: while it is tracked the largest level one close to where it is expected, but none where another
    /// level is known to lie, nor for a robot on a slope: the floor at its foot, or on top, is near to its height on the way. While it
    /// is searched, what the feet stand on.
    fn find_ground(&mut self, levelled: &Levelled) -> Option<usize> {
        if self.searching() {
            return self.find_underfoot(levelled);
        }
        if self.on_slope {
            return None;
        }
        let camera_m = levelled.predicted.inner.translation.z;
        (0..self.surfaces.regions.len())
            .filter(|&i| self.may_be_ground(i, camera_m, self.config.track_height))
            .filter(|&i| {
                let height_m = camera_m - 1.0 / f64::from(self.surfaces.regions[i].q);
                height_m.abs() < self.config.known_height || !self.has_level_beside(i, camera_m)
            })
            .max_by_key(|&i| (self.surfaces.regions[i].support, std::cmp::Reverse(i)))
    }

    /// Whether a region is level, large enough, no farther from where the ground is expected than `gate_m`, nor from where the joints
    /// have it than they err, and not where another level is known to lie.
    pub(super) fn may_be_ground(&self, index: usize, camera_m: f64, gate_m: f64) -> bool {
        let config = &self.config;
        let region = &self.surfaces.regions[index];
        let height_m = camera_m - 1.0 / f64::from(region.q);
        let off_the_joints_m = height_m - self.correction.raised_m;
        region.support >= config.min_ground
            && config.tuning.reference.core_part * region.core >= config.min_ground
            && height_m.abs() < gate_m
            && off_the_joints_m.abs() < config.ground_height
            && self.surfaces.is_level(index)
            && !self
                .known
                .is_elsewhere(index, height_m, config.known_height)
    }

    /// Whether a ground slopes where it is near the feet; none where too little is seen there.
    fn slopes_near(&mut self, levelled: &Levelled, index: usize) -> Option<bool> {
        if !self.look_near(levelled) {
            return None;
        }
        let slopes = self.surfaces.shown_slopes(index, &levelled.view);
        self.surfaces.show_all();
        Some(slopes)
    }

    /// Whether another level surface lies so little above or below a region that one could be taken for the other: not where the
    /// other one is farther from where the joints have the ground than the ground can be, unless it is about as large: in a view
    /// that is off by degrees both may be parts of the ground.
    fn has_level_beside(&self, index: usize, camera_m: f64) -> bool {
        let ReferenceTuning {
            core_part,
            beside,
            as_large,
            ..
        } = self.config.tuning.reference;
        let surfaces = &self.surfaces;
        let support = |i: usize| surfaces.regions[i].support as f64;
        let below_m = |i: usize| 1.0 / f64::from(surfaces.regions[i].q);
        (0..surfaces.regions.len()).any(|i| {
            let apart_m = (below_m(i) - below_m(index)).abs();
            let off_the_joints_m = camera_m - below_m(i) - self.correction.raised_m;
            let could_be_ground = off_the_joints_m.abs() < self.config.ground_height
                || support(i) > as_large * support(index);
            core_part * surfaces.regions[i].core >= self.config.min_ground
                && apart_m > self.config.known_height
                && apart_m < beside * self.config.track_height
                && could_be_ground
                && surfaces.is_level(i)
        })
    }

    /// What the frame says of the camera's height, and which region is the ground.
    fn find_reference(&mut self, levelled: &Levelled, known: &KnownFloor<'_>) -> PoseReference {
        if !self.is_straight(levelled) {
            return PoseReference::None;
        }
        let camera_m = levelled.predicted.inner.translation.vector;
        self.known
            .compare(&self.surfaces, &levelled.view, &camera_m, known);
        let ground = self.find_ground(levelled);
        let config = &self.config;
        let near = ground.is_some_and(|region| self.known.is_near(region));
        // Ground behind the stairs tells less than the known treads before it.
        if !near
            && !self.searching()
            && let Some(rise_m) = self.known.rise_m(config.known_height, config.min_ground)
        {
            return PoseReference::Known { rise_m };
        }
        if let Some(region) = ground {
            let rise_m = 1.0 / f64::from(self.surfaces.regions[region].q) - camera_m.z;
            return PoseReference::Ground { region, rise_m };
        }
        if self.searching() {
            return PoseReference::None;
        }
        let surfaces = &self.surfaces;
        let levels = (0..surfaces.regions.len()).filter(|&i| {
            surfaces.regions[i].core >= config.min_ground
                && surfaces.is_level(i)
                && surfaces.fits[i].roughness() < config.tuning.reference.smooth
        });
        // Who looks at nothing but the slope that it stands on has not lost the ground.
        if levels.count() > 0 || self.known.has_known_slope(config.track_height) {
            PoseReference::Level
        } else {
            PoseReference::None
        }
    }
}
