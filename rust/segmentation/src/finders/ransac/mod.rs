//! Repeated random sample consensus: the segmenter `ransac`.
//!
//! After Fischler and Bolles (1981): of many planes through three pixels anywhere in the picture the one that most pixels lie
//! on, refined by least squares; its pixels are taken away, and so on. Planes are free: where steps are lower than the
//! noise allows, the one through their edges has the most pixels.

mod config;

use sensing::Intrinsics;
use settings::ConfigError;

use crate::finders::free_planes::{Draws, Peeling, Remaining, through};
use crate::ground_plane::config::GroundConfig;
use crate::ground_plane::grounded::Grounded;
use crate::picture::pixels::Picture;
use crate::picture::view::{Linear, View};
use crate::regions::finder::{Finder, Look};
use crate::regions::region::Region;
pub use config::RansacConfig;

/// Every so many pixels one is asked whether it lies on a plane that is tried.
const STRIDE: usize = 4;

/// The segmenter of free planes by random samples.
pub type Ransac = Grounded<Consensus>;

impl Ransac {
    /// A segmenter for this camera that knows nothing of the camera's errors yet.
    pub fn new(
        config: &RansacConfig,
        ground: GroundConfig,
        camera: Intrinsics,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        let accept_px = config.accept as f32;
        let finder = Consensus {
            samples: config.samples,
            accept_px,
            peeling: Peeling::new(accept_px, config.min_plane),
        };
        Self::around(finder, ground, camera)
    }
}

/// Finds planes by random samples. Keeps its buffers.
#[derive(Debug, Clone)]
pub struct Consensus {
    samples: usize,
    accept_px: f32,
    peeling: Peeling,
}

/// Of `samples` planes that are tried, the one that most of the remaining pixels lie on; of equals the first.
fn best(
    samples: usize,
    accept_px: f32,
    remaining: &Remaining,
    draws: &mut Draws,
) -> Option<Linear> {
    let mut best: Option<(usize, Linear)> = None;
    for _ in 0..samples {
        let triple = std::array::from_fn(|_| remaining.draw(draws));
        let Some(plane) = through(triple) else {
            continue;
        };
        let count = remaining.on(&plane, accept_px, STRIDE);
        if best.is_none_or(|(most, _)| count > most) {
            best = Some((count, plane));
        }
    }
    best.map(|(_, plane)| plane)
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
            let (samples, accept_px) = (self.samples, self.accept_px);
            self.peeling.peel(picture, labels, |remaining, _, draws| {
                best(samples, accept_px, remaining, draws)
            });
        }
        self.peeling.show(view, labels, regions);
    }
}
