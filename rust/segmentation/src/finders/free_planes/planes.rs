//! The planes that were found in one picture, and which of them are level.

use crate::picture::{Linear, MAX_REGIONS, Picture, View};
use crate::regions::{Look, Region};

use super::{flood::flood, tuning::FreePlaneTuning};

/// The planes that were found in one picture.
#[derive(Debug, Clone, Default)]
pub(crate) struct FreePlanes {
    tuning: FreePlaneTuning,
    planes: Vec<Linear>,
    /// Whose each pixel was found to be: between two looks, slopes are taken out of the labels.
    labels: Vec<u16>,
}

impl FreePlanes {
    /// No planes yet.
    pub(crate) const fn new(tuning: FreePlaneTuning) -> Self {
        Self {
            tuning,
            planes: Vec::new(),
            labels: Vec::new(),
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

    /// Fills `regions` with the planes as a view shows them: those that are level in it are horizontal. The first look keeps the labels
    /// that were found, any other gives them back.
    pub(crate) fn show(
        &mut self,
        view: &View,
        look: Look,
        labels: &mut [u16],
        regions: &mut Vec<Region>,
    ) {
        match look {
            Look::First => {
                self.labels.clear();
                self.labels.extend_from_slice(labels);
            }
            Look::Again => labels.copy_from_slice(&self.labels),
        }
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

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::synthetic::{CAMERA, camera_pose};

    #[test]
    fn labels_that_slopes_were_given_between_two_looks_are_the_planes_again() {
        let mut planes = FreePlanes::new(FreePlaneTuning::default());
        let _label = planes.add(Linear::default());
        let rotation = camera_pose(0.0, 0.8).inner.rotation.to_rotation_matrix();
        let view = View::new(&CAMERA, &rotation);
        let (mut labels, mut regions) = (vec![0, 1, 1], Vec::new());
        planes.show(&view, Look::First, &mut labels, &mut regions);
        labels[2] = 3;
        planes.show(&view, Look::Again, &mut labels, &mut regions);
        assert_eq!(labels, [0, 1, 1]);
        assert_eq!(regions[0].support, 2);
    }
}
