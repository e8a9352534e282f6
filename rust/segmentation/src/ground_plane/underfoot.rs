//! The ground of a search: what the feet stand on, named by how near to them it is seen and by the height that the joints state. Where
//! nothing is seen right before the feet, it must be even or most of what is seen near them, and have no other level beside it.

use crate::camera_pose::Levelled;
use crate::ground_plane::grounded::Grounded;
use crate::picture::NearFeet;
use crate::regions::Finder;

impl<F: Finder> Grounded<F> {
    /// The region that the feet stand on: of those that may be the ground, the level of the one that is seen nearest to the feet, and of
    /// its pieces the largest. None where what lies before the feet is not seen and another level lies so little higher or lower that the
    /// joints cannot tell the two apart, or something else is most of what is near: the robot has to look lower.
    pub(super) fn find_underfoot(&mut self, levelled: &Levelled) -> Option<usize> {
        let finer = self.surfaces.finer();
        let stride = self.config.tuning.reference.stride * finer;
        let enough = self.config.tuning.reference.nearest * finer * finer;
        self.nearness
            .measure(&self.surfaces, levelled, [stride, enough]);
        let camera_m = levelled.predicted.inner.translation.z;
        let smooth = self.config.tuning.reference.smooth;
        let nearest_m = &self.nearness.nearest_m;
        let candidates = || {
            (0..self.surfaces.regions.len()).filter(|&i| {
                self.may_be_ground(i, camera_m, self.config.ground_height)
                    && self.surfaces.fits[i].roughness() < smooth
            })
        };
        let nearest = candidates().min_by(|&a, &b| nearest_m[a].total_cmp(&nearest_m[b]))?;
        let is_before_the_feet = f64::from(nearest_m[nearest]) < self.config.underfoot_reach;
        let is_clear = || {
            let even = self.surfaces.fits[nearest].roughness() < self.config.tuning.reference.even;
            !self.has_rival(nearest) && (even || self.is_most(levelled, nearest))
        };
        if !is_before_the_feet && !is_clear() {
            return None;
        }
        candidates()
            .filter(|&i| self.apart_m(i, nearest) < self.config.known_height)
            .max_by_key(|&i| (self.surfaces.regions[i].support, std::cmp::Reverse(i)))
    }

    /// Joins the pieces of a ground that was just named: whatever stands on it and cuts it apart, what is level and as high is it.
    pub(super) fn join_pieces(&mut self, ground: usize) {
        let smooth = self.config.tuning.reference.smooth;
        for index in (0..self.surfaces.regions.len()).filter(|&index| index != ground) {
            if self.surfaces.fits[index].roughness() < smooth
                && self.surfaces.is_level(index)
                && self.apart_m(index, ground) < self.config.known_height
            {
                self.surfaces.join(index, ground);
            }
        }
    }

    /// Whether a region is most of what is seen near the feet.
    fn is_most(&self, levelled: &Levelled, index: usize) -> bool {
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

    /// Whether another level surface nearby, about as large, lies a low step above or below a region.
    fn has_rival(&self, index: usize) -> bool {
        let reference = &self.config.tuning.reference;
        let support = |i: usize| self.surfaces.regions[i].support as f64;
        (0..self.surfaces.regions.len()).any(|i| {
            let apart_m = self.apart_m(i, index);
            reference.core_part * self.surfaces.regions[i].core >= self.config.min_ground
                && support(i) > reference.as_large * support(index)
                && apart_m > self.config.known_height
                && apart_m < reference.rival
                && f64::from(self.nearness.nearest_m[i]) < reference.rival_reach
                && self.surfaces.is_level(i)
        })
    }

    /// How much higher or lower one level region lies than another, m.
    fn apart_m(&self, one: usize, other: usize) -> f64 {
        let below_m = |i: usize| 1.0 / f64::from(self.surfaces.regions[i].q);
        (below_m(one) - below_m(other)).abs()
    }
}
