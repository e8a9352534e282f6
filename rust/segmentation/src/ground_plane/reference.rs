//! What a frame is levelled and lifted by: the ground, or on stairs the other treads that are known.

use geometry::{Camera, Pose, Robot};
use nalgebra::Vector2;

use super::tuning::ReferenceTuning;

use crate::camera_pose::Levelled;
use crate::ground_plane::grounded::Grounded;
use crate::picture::NearFeet;
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
    /// Level surfaces are seen of which no height is known: the track holds.
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

    /// The ground among the regions: the largest level one close to where the ground is expected, but none where another
    /// level is known to lie.
    fn find_ground(&self, levelled: &Levelled) -> Option<usize> {
        let config = &self.config;
        let ReferenceTuning {
            smooth, core_part, ..
        } = config.tuning.reference;
        let surfaces = &self.surfaces;
        let pixels = surfaces.labels.len() as f64;
        let (gate_m, least) = if self.searching() {
            let least = (config.open_floor * pixels) as usize;
            (config.ground_height, least.max(config.min_ground))
        } else {
            (config.track_height, config.min_ground)
        };
        let camera_m = levelled.predicted.inner.translation.z;
        (0..surfaces.regions.len())
            .filter(|&i| {
                let region = &surfaces.regions[i];
                let height_m = camera_m - 1.0 / f64::from(region.q);
                let off_the_joints_m = height_m - self.correction.raised_m;
                region.support >= least
                    && core_part * region.core >= config.min_ground
                    && height_m.abs() < gate_m
                    && (height_m.abs() < config.known_height || !self.has_level_beside(i, camera_m))
                    && off_the_joints_m.abs() < config.ground_height
                    && surfaces.is_level(i)
                    && !self.known.is_elsewhere(i, height_m, config.known_height)
                    && (!self.searching()
                        || surfaces.fits[i].roughness() < smooth && self.is_underfoot(levelled, i))
            })
            .max_by_key(|&i| (surfaces.regions[i].support, std::cmp::Reverse(i)))
    }

    /// Whether most of what is seen near the feet belongs to a region.
    fn is_underfoot(&self, levelled: &Levelled, index: usize) -> bool {
        let camera_m = &levelled.predicted.inner.translation.vector;
        let reach = NearFeet::new(&levelled.view, camera_m, self.config.search_reach);
        let width = self.camera.width;
        let lines = self.surfaces.images.disparity_px.chunks_exact(width);
        let labels = self.surfaces.labels.chunks_exact(width);
        let (mut near, mut own) = (0, 0);
        for (row, (line, labels)) in lines.zip(labels).enumerate() {
            for (is_near, &label) in reach.along(row, line).zip(labels) {
                near += usize::from(is_near);
                own += usize::from(is_near && usize::from(label) == index + 1);
            }
        }
        let least = self.config.tuning.reference.underfoot * near as f64;
        own >= self.config.min_region && own as f64 > least
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
        let config = &self.config;
        let ground = self.find_ground(levelled);
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
        if levels.count() > 0 {
            PoseReference::Level
        } else {
            PoseReference::None
        }
    }
}
