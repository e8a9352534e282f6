//! The randomised Hough transform on planes: the segmenter `hough`.
//!
//! After Xu, Oja and Kultanen (1990), and Okada et al. (2001), the plane segment finder that 003 saw merge the steps of a
//! staircase: triples of pixels that lie close to each other vote for the plane through them; the plane of the cell with
//! most votes is refined by least squares, its pixels are taken away, and so on.

mod accumulator;
mod config;

use geometry::ConfigError;
use nalgebra::{Matrix3, Vector3};
use sensing::Intrinsics;

use crate::free_planes::{Draws, FreePlanes, Pixel, Remaining, through};
use crate::grounded::{Finder, GroundConfig, Grounded, Look, Picture, Region, View};
use accumulator::Accumulator;
pub use config::HoughConfig;

/// The segmenter of free planes by votes.
pub type Hough = Grounded<Votes>;

impl Hough {
    /// A segmenter for this camera that knows nothing of the camera's errors yet.
    pub fn new(
        config: &HoughConfig,
        ground: GroundConfig,
        camera: Intrinsics,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        let finder = Votes {
            accumulator: Accumulator::new(config.angle, config.distance),
            samples: config.samples,
            window: config.window,
            accept_px: config.accept as f32,
            min_plane: config.min_plane,
            planes: FreePlanes::default(),
            remaining: Remaining::default(),
        };
        Self::around(finder, ground, camera)
    }
}

/// Finds planes by votes. Keeps its buffers.
#[derive(Debug, Clone)]
pub struct Votes {
    samples: usize,
    window: usize,
    accept_px: f32,
    min_plane: usize,
    accumulator: Accumulator,
    planes: FreePlanes,
    remaining: Remaining,
}

impl Votes {
    /// Lets triples of the remaining pixels vote.
    fn vote(
        &mut self,
        picture: Picture<'_>,
        labels: &[u16],
        parts_of: &Matrix3<f64>,
        draws: &mut Draws,
    ) {
        self.accumulator.clear();
        for _ in 0..self.samples {
            let first = self.remaining.draw(draws);
            let beside = [(); 2].map(|()| near(picture, labels, first, self.window, draws));
            let [Some(second), Some(third)] = beside else {
                continue;
            };
            if let Some(plane) = through([first, second, third]) {
                let parts = parts_of * plane.coefficients();
                let normal = Vector3::new(-parts.x, -parts.y, parts.z);
                self.accumulator.vote(plane, &normal);
            }
        }
    }

    fn find_planes(&mut self, picture: Picture<'_>, view: &View, labels: &mut [u16]) {
        let mut draws = Draws::of_frame(picture.disparity_px);
        self.remaining.read(picture);
        self.planes.clear();
        labels.fill(0);
        let Some(parts_of) = view.parts_of_planes() else {
            return;
        };
        while self.remaining.count() >= self.min_plane && !self.planes.is_full() {
            self.vote(picture, labels, &parts_of, &mut draws);
            let Some(peak) = self.accumulator.peak() else {
                return;
            };
            let plane = self.remaining.refine(peak, self.accept_px);
            if self.remaining.on(&plane, self.accept_px, 1) < self.min_plane {
                return;
            }
            let label = self.planes.add(plane);
            self.remaining.take(&plane, self.accept_px, label, labels);
        }
    }
}

/// A pixel in the window around another one, where one was seen there that no plane has taken.
fn near(
    picture: Picture<'_>,
    labels: &[u16],
    around: Pixel,
    window: usize,
    draws: &mut Draws,
) -> Option<Pixel> {
    let col = (around.col + draws.below(window + 1)).checked_sub(window / 2)?;
    let row = (around.row + draws.below(window + 1)).checked_sub(window / 2)?;
    let at = row * picture.width + col;
    let d = *picture.disparity_px.get(at)?;
    let free = col < picture.width && !d.is_nan() && labels[at] == 0;
    free.then_some(Pixel { col, row, d })
}

impl Finder for Votes {
    const ANY_DIRECTION: bool = true;

    fn find(
        &mut self,
        picture: Picture<'_>,
        view: &View,
        look: Look,
        regions: &mut Vec<Region>,
        labels: &mut [u16],
    ) {
        if look == Look::First {
            self.find_planes(picture, view, labels);
        }
        self.planes.show(view, labels, regions);
    }
}
