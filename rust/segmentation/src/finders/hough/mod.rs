//! The randomised Hough transform on planes: the segmenter `hough`.
//!
//! After Xu, Oja and Kultanen (1990), and Okada et al. (2001), the plane segment finder that 003 saw merge the steps of a
//! staircase: triples of pixels that lie close to each other vote for the plane through them; the plane of the cell with
//! most votes is refined by least squares, its pixels are taken away, and so on.

mod accumulator;
mod config;

use crate::part::SegmenterPart;
use nalgebra::{Matrix3, Vector3};
use sensing::Intrinsics;
use settings::{Part, TableDescription};

use crate::finders::free_planes::draws::Draws;
use crate::finders::free_planes::peeling::Peeling;
use crate::finders::free_planes::remaining::{Remaining, SeenPixel, through};
use crate::ground_plane::{Configured, GroundConfig, Grounded};
use crate::picture::{Linear, Picture, View};
use crate::regions::{Finder, Look, Region};
use accumulator::Accumulator;
pub use config::HoughConfig;

/// How it is listed and made.
pub const PART: SegmenterPart = Part {
    name: "hough",
    about: "planes in any direction by a randomised Hough transform",
    source: Some("Xu, Oja and Kultanen 1990; Okada et al. 2001 (003, section I)"),
    tables: &[TableDescription::of::<HoughConfig>()],
    make: Hough::make,
};

/// The segmenter of free planes by votes.
pub type Hough = Grounded<Votes>;

impl Configured for Votes {
    type Config = HoughConfig;

    fn new(config: &HoughConfig, _: &GroundConfig, _: &Intrinsics) -> Self {
        let tuning = config.tuning.clone();
        Self {
            ballot: Ballot {
                accumulator: Accumulator::new(config.angle, config.distance, tuning.farthest),
                least_triangle: tuning.peeling.least_triangle,
                samples: config.samples,
                window: config.window,
            },
            peeling: Peeling::new(
                config.accept as f32,
                config.min_plane,
                tuning.peeling,
                tuning.free_planes,
            ),
        }
    }
}

/// Finds planes by votes. Keeps its buffers.
#[derive(Debug, Clone)]
pub struct Votes {
    ballot: Ballot,
    peeling: Peeling,
}

#[derive(Debug, Clone)]
struct Ballot {
    samples: usize,
    window: usize,
    least_triangle: f64,
    accumulator: Accumulator,
}

impl Ballot {
    /// The plane that most triples of the remaining pixels vote for.
    fn elect(
        &mut self,
        picture: Picture<'_>,
        parts_of: &Matrix3<f64>,
        remaining: &Remaining,
        labels: &[u16],
        draws: &mut Draws,
    ) -> Option<Linear> {
        self.accumulator.clear();
        for _ in 0..self.samples {
            let first = remaining.draw(draws);
            let beside = [(); 2].map(|()| near(picture, labels, first, self.window, draws));
            let [Some(second), Some(third)] = beside else {
                continue;
            };
            if let Some(plane) = through([first, second, third], self.least_triangle) {
                let parts = parts_of * plane.coefficients();
                let normal = Vector3::new(-parts.x, -parts.y, parts.z);
                self.accumulator.vote(plane, &normal);
            }
        }
        self.accumulator.peak()
    }
}

/// A pixel in the window around another one, where one was seen there that no plane has taken.
fn near(
    picture: Picture<'_>,
    labels: &[u16],
    around: SeenPixel,
    window: usize,
    draws: &mut Draws,
) -> Option<SeenPixel> {
    let col = (around.col + draws.below(window + 1)).checked_sub(window / 2)?;
    let row = (around.row + draws.below(window + 1)).checked_sub(window / 2)?;
    let at = row * picture.width + col;
    let d = *picture.disparity_px.get(at)?;
    let free = col < picture.width && !d.is_nan() && labels[at] == 0;
    free.then_some(SeenPixel { col, row, d })
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
            let (ballot, parts_of) = (&mut self.ballot, view.parts_of_planes());
            self.peeling
                .peel(picture, labels, |remaining, labels, draws| {
                    ballot.elect(picture, &parts_of?, remaining, labels, draws)
                });
        }
        self.peeling.show(view, look, labels, regions);
    }
}
