//! One plane after the other out of a picture: guessed, refined by least squares, its pixels taken away.

use super::draws::Draws;
use super::planes::FreePlanes;
use super::remaining::Remaining;
use super::tuning::{FreePlaneTuning, PeelingTuning};
use crate::picture::{Linear, Picture, View};
use crate::regions::{Look, Region};

/// What is left of a picture, and the planes that were taken out of it. Keeps its buffers.
#[derive(Debug, Clone)]
pub(crate) struct Peeling {
    tuning: PeelingTuning,
    accept_px: f32,
    min_plane: usize,
    planes: FreePlanes,
    remaining: Remaining,
}

impl Peeling {
    /// A pixel is a plane's when nearer than `accept_px`, and a plane has `min_plane` pixels or more.
    pub(crate) fn new(
        accept_px: f32,
        min_plane: usize,
        tuning: PeelingTuning,
        free_planes: FreePlaneTuning,
    ) -> Self {
        Self {
            tuning,
            accept_px,
            min_plane,
            planes: FreePlanes::new(free_planes),
            remaining: Remaining::default(),
        }
    }

    /// Labels the planes of a picture. `guess` proposes the next one from the pixels that are left and the labels so far;
    /// the search ends with what it cannot propose, or with one that has too few pixels.
    pub(crate) fn peel(
        &mut self,
        picture: Picture<'_>,
        labels: &mut [u16],
        mut guess: impl FnMut(&Remaining, &[u16], &mut Draws) -> Option<Linear>,
    ) {
        let mut draws = Draws::of_frame(picture.disparity_px);
        self.remaining.read(picture);
        self.planes.clear();
        labels.fill(0);
        while self.remaining.count() >= self.min_plane && !self.planes.is_full() {
            let Some(guessed) = guess(&self.remaining, labels, &mut draws) else {
                return;
            };
            let plane = self
                .remaining
                .refine(guessed, self.accept_px, self.tuning.refinements);
            if self.remaining.on(&plane, self.accept_px, 1) < self.min_plane {
                return;
            }
            let label = self.planes.add(plane);
            self.remaining.take(&plane, self.accept_px, label, labels);
        }
    }

    /// Fills `regions` with the planes as a view shows them.
    pub(crate) fn show(
        &mut self,
        view: &View,
        look: Look,
        labels: &mut [u16],
        regions: &mut Vec<Region>,
    ) {
        self.planes.show(view, look, labels, regions);
    }
}
