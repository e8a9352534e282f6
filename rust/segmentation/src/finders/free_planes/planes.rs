//! The planes that were found in one picture, and which of them are level.

use crate::picture::{Linear, MAX_REGIONS, Picture, View};
use crate::regions::Region;

use super::{flood::flood, tuning::FreePlaneTuning};

/// The planes that were found in one picture.
#[derive(Debug, Clone, Default)]
pub(crate) struct FreePlanes {
    tuning: FreePlaneTuning,
    planes: Vec<Linear>,
}

impl FreePlanes {
    /// No planes yet.
    pub(crate) const fn new(tuning: FreePlaneTuning) -> Self {
        Self {
            tuning,
            planes: Vec::new(),
        }
    }

    pub(crate) fn clear(&mut self) {
        self.planes.clear();
    }

    pub(crate) fn is_full(&self) -> bool {
        self.planes.len() == MAX_REGIONS
    }

    /// Adds a plane; the label of its pixels.
    pub(crate) fn add(&mut self, plane: Linear) -> u16 {
        self.planes.push(plane);
        self.planes.len() as u16
    }

    /// Lets planes take in pixels beside theirs that lie on them and have none yet.
    pub(crate) fn spread(
        &self,
        picture: Picture<'_>,
        accept_px: f32,
        labels: &mut [u16],
        queue: &mut Vec<usize>,
    ) {
        let width = picture.width;
        flood(labels, width, queue, |label, at| {
            let plane = &self.planes[usize::from(label) - 1];
            plane.passes(at % width, at / width, picture.disparity_px[at], accept_px)
        });
    }

    /// Fills `regions` with the planes as a view shows them: those that are level in it are horizontal.
    pub(crate) fn show(&self, view: &View, labels: &[u16], regions: &mut Vec<Region>) {
        let level_rad = self.tuning.level;
        let parts_of = view.parts_of_planes();
        regions.clear();
        regions.extend(self.planes.iter().map(|plane| {
            let q = parts_of
                .map(|parts_of| parts_of * plane.coefficients())
                .filter(|parts| parts.xy().norm() < level_rad * parts.z)
                .map_or(0.0, |parts| parts.z);
            Region {
                q: q as f32,
                plane: Some(*plane),
                ..Region::default()
            }
        }));
        for &label in labels.iter().filter(|&&label| label > 0) {
            regions[usize::from(label) - 1].support += 1;
        }
    }
}
