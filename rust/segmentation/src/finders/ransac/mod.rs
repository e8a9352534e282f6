//! Repeated random sample consensus: the segmenter `ransac`.
//!
//! After Fischler and Bolles (1981): of many planes through three pixels anywhere in the picture the one that most pixels lie
//! on, refined by least squares; its pixels are taken away, and so on. Planes are free: where steps are lower than the
//! noise allows, the one through their edges has the most pixels.

mod config;

use crate::part::SegmenterPart;
use sensing::Intrinsics;
use settings::{Part, TableDescription};

use crate::finders::free_planes::draws::Draws;
use crate::finders::free_planes::peeling::Peeling;
use crate::finders::free_planes::remaining::{Remaining, through};
use crate::ground_plane::{Configured, GroundConfig, Grounded};
use crate::picture::{Linear, Picture, View};
use crate::regions::{Finder, Look, Region};
pub use config::RansacConfig;

/// How it is listed and made.
pub const PART: SegmenterPart = Part {
    name: "ransac",
    about: "planes in any direction by repeated random samples",
    source: Some("Fischler and Bolles 1981"),
    tables: &[TableDescription::of::<RansacConfig>()],
    make: Ransac::make,
};

/// The segmenter of free planes by random samples.
pub type Ransac = Grounded<Consensus>;

impl Configured for Consensus {
    type Config = RansacConfig;

    fn new(config: &RansacConfig, _: &GroundConfig, _: &Intrinsics) -> Self {
        let (accept_px, tuning) = (config.accept as f32, config.tuning.clone());
        Self {
            trials: Trials {
                samples: config.samples,
                accept_px,
                stride: tuning.stride,
                least_triangle: tuning.peeling.least_triangle,
            },
            peeling: Peeling::new(
                accept_px,
                config.min_plane,
                tuning.peeling,
                tuning.free_planes,
            ),
        }
    }
}

/// Finds planes by random samples. Keeps its buffers.
#[derive(Debug, Clone)]
pub struct Consensus {
    trials: Trials,
    peeling: Peeling,
}

/// How planes are tried.
#[derive(Debug, Clone, Copy)]
struct Trials {
    /// Planes that are tried.
    samples: usize,
    accept_px: f32,
    /// Every so many pixels one is asked.
    stride: usize,
    least_triangle: f64,
}

impl Trials {
    /// The plane that most of the remaining pixels lie on, among those that are tried; of equals the first.
    fn best(self, remaining: &Remaining, draws: &mut Draws) -> Option<Linear> {
        let mut best: Option<(usize, Linear)> = None;
        for _ in 0..self.samples {
            let triple = std::array::from_fn(|_| remaining.draw(draws));
            let Some(plane) = through(triple, self.least_triangle) else {
                continue;
            };
            let count = remaining.on(&plane, self.accept_px, self.stride);
            if best.is_none_or(|(most, _)| count > most) {
                best = Some((count, plane));
            }
        }
        best.map(|(_, plane)| plane)
    }
}

impl Finder for Consensus {
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
            let trials = self.trials;
            self.peeling.peel(picture, labels, |remaining, _, draws| {
                trials.best(remaining, draws)
            });
        }
        self.peeling.show(view, look, labels, regions);
    }
}
