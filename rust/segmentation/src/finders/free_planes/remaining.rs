//! The pixels that no plane has taken yet.

use nalgebra::Vector3;

use super::draws::Draws;
use crate::picture::{Linear, Picture};
use crate::regions::PlaneSums;

/// A pixel that was seen.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SeenPixel {
    pub(crate) col: usize,
    pub(crate) row: usize,
    pub(crate) d: f32,
}

impl SeenPixel {
    /// Whether a plane explains it to within `accept_px`.
    fn lies_on(&self, plane: &Linear, accept_px: f32) -> bool {
        plane.passes(self.col, self.row, self.d, accept_px)
    }

    const fn place(&self) -> [f64; 3] {
        [self.col as f64, self.row as f64, 1.0]
    }
}

/// Seen pixels without a plane, row by row.
#[derive(Debug, Clone, Default)]
pub(crate) struct Remaining {
    width: usize,
    pixels: Vec<SeenPixel>,
}

impl Remaining {
    /// All that a picture shows.
    pub(crate) fn read(&mut self, picture: Picture<'_>) {
        self.width = picture.width;
        self.pixels.clear();
        for (row, line) in picture.disparity_px.chunks_exact(picture.width).enumerate() {
            let seen = line.iter().enumerate().filter(|(_, d)| !d.is_nan());
            self.pixels
                .extend(seen.map(|(col, &d)| SeenPixel { col, row, d }));
        }
    }

    pub(crate) const fn count(&self) -> usize {
        self.pixels.len()
    }

    /// One of them; there must be any.
    pub(crate) fn draw(&self, draws: &mut Draws) -> SeenPixel {
        self.pixels[draws.below(self.pixels.len())]
    }

    /// How many of every `stride`-th lie on a plane.
    pub(crate) fn on(&self, plane: &Linear, accept_px: f32, stride: usize) -> usize {
        let some = self.pixels.iter().step_by(stride);
        some.filter(|pixel| pixel.lies_on(plane, accept_px)).count()
    }

    /// The plane of least squares through what lies on a guessed one, and so on for some rounds.
    pub(crate) fn refine(&self, guess: Linear, accept_px: f32, rounds: usize) -> Linear {
        let mut plane = guess;
        for _ in 0..rounds {
            let mut sums = PlaneSums::default();
            for pixel in self
                .pixels
                .iter()
                .filter(|pixel| pixel.lies_on(&plane, accept_px))
            {
                sums.add(pixel.place(), f64::from(pixel.d));
            }
            plane = sums.plane().map_or(plane, |fitted| Linear::new(&fitted));
        }
        plane
    }

    /// Gives all that lies on a plane its label.
    pub(crate) fn take(&mut self, plane: &Linear, accept_px: f32, label: u16, labels: &mut [u16]) {
        let width = self.width;
        self.pixels.retain(|pixel| {
            let taken = pixel.lies_on(plane, accept_px);
            if taken {
                labels[pixel.row * width + pixel.col] = label;
            }
            !taken
        });
    }
}

/// The plane through three pixels; none where twice the area of their triangle in the picture is less than `least`, in pixels.
pub(crate) fn through(pixels: [SeenPixel; 3], least: f64) -> Option<Linear> {
    let [a, b, c] = pixels.map(|p| Vector3::new(p.col as f64, p.row as f64, f64::from(p.d)));
    let normal = (b - a).cross(&(c - a));
    if normal.z.abs() < least {
        return None;
    }
    let (per_col, per_row) = (-normal.x / normal.z, -normal.y / normal.z);
    let origin = a.z - per_col * a.x - per_row * a.y;
    Some(Linear::new(&Vector3::new(per_col, per_row, origin)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_plane_through_three_pixels_explains_all_three(
            at in prop::array::uniform3((0..88usize, 0..72usize, 1.0..24.0f32)),
        ) {
            let pixels = at.map(|(col, row, d)| SeenPixel { col, row, d });
            if let Some(plane) = through(pixels, 8.0) {
                for pixel in pixels {
                    prop_assert!((plane.at(pixel.col, pixel.row) - pixel.d).abs() < 1e-2);
                }
            }
        }
    }

    #[test]
    fn a_guess_is_refined_to_the_plane_that_is_there_and_takes_its_pixels() {
        let true_plane = Linear::new(&Vector3::new(0.01, 0.12, 3.0));
        let (width, pixels) = (40, 40 * 30);
        let mut disparity_px: Vec<f32> = (0..pixels)
            .map(|at| true_plane.at(at % width, at / width))
            .collect();
        disparity_px[5] = f32::NAN;
        disparity_px[700] = 20.0;
        let picture = Picture {
            width,
            disparity_px: &disparity_px,
            g: &disparity_px,
            sigma_px: &disparity_px,
            finer: 1,
        };
        let mut remaining = Remaining::default();
        remaining.read(picture);
        assert_eq!(remaining.count(), pixels - 1);
        let guess = Linear::new(&Vector3::new(0.012, 0.118, 3.05));
        let found = remaining.refine(guess, 0.3, 3);
        assert!((found.coefficients() - true_plane.coefficients()).norm() < 1e-4);
        assert_eq!(remaining.on(&found, 0.3, 1), pixels - 2);
        let mut labels = vec![0; pixels];
        remaining.take(&found, 0.3, 4, &mut labels);
        assert_eq!(remaining.count(), 1);
        assert_eq!(
            labels.iter().filter(|&&label| label == 4).count(),
            pixels - 2
        );
        assert_eq!((labels[5], labels[700]), (0, 0));
    }
}
