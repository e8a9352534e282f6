//! A first guess of the camera's tilt: the one under which the heights of all points pile up most sharply.

use nalgebra::Vector2;

use super::finder::Picture;
use super::view::View;

/// Every so many columns and rows one pixel is looked at.
const STRIDE: (usize, usize) = (2, 3);
/// Height of a bin, m.
const BIN_M: f32 = 0.006;
/// Number of bins.
const BINS: usize = 96;
/// Tilts that are tried together.
const TOGETHER: usize = 3;

/// Where the search looks.
#[derive(Debug, Clone, Copy)]
pub(super) struct SearchArea {
    /// Tilts up to this in both directions, rad.
    pub(super) tilt_rad: f64,
    /// First step of the search, rad; halved until it would be below the last one.
    pub(super) step_rad: f64,
    /// Smallest step of the search, rad.
    pub(super) last_step_rad: f64,
    /// Depths below the camera that count, m.
    pub(super) below_m: (f64, f64),
    /// Points further than a radius from a place count less, by the fourth power of the distance; from the camera, m:
    /// forward, to the left, and the radius.
    pub(super) around_m: [f32; 3],
}

/// Searches the tilt. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct HorizonSearch {
    // g, X, Y over the disparity: the depth below the camera is their combination; and a weight.
    samples: Vec<[f32; 4]>,
    // The tilts to be tried, in the order in which they count among equals.
    tilts: Vec<Vector2<f64>>,
}

impl HorizonSearch {
    /// The tilt `(a, b)` with the sharpest heights. `picture.g` must belong to `view`.
    pub(super) fn search(
        &mut self,
        picture: Picture<'_>,
        view: &View,
        area: SearchArea,
    ) -> Vector2<f64> {
        self.samples.clear();
        let height = picture.disparity_px.len() / picture.width;
        for row in (0..height).step_by(STRIDE.1) {
            for col in (row / STRIDE.1 % STRIDE.0..picture.width).step_by(STRIDE.0) {
                let d = picture.disparity_px[row * picture.width + col];
                if d.is_nan() {
                    continue;
                }
                let g = picture.g[row * picture.width + col];
                let sigma = picture.sigma_px[row * picture.width + col];
                let (x, y) = (view.x.at(col, row) / d, view.y.at(col, row) / d);
                let [around_x, around_y, radius] = area.around_m;
                let (dx, dy) = (x - around_x, y - around_y);
                let nearness = radius / (dx * dx + dy * dy).sqrt().max(radius);
                self.samples
                    .push([g / d, x, y, d / sigma * nearness.powi(4)]);
            }
        }
        let steps = (area.tilt_rad / area.step_rad).round() as i32;
        let mut best = self.sharpest(&Vector2::zeros(), area.step_rad, steps, area);
        let mut step = area.step_rad / 2.0;
        while step >= area.last_step_rad {
            best = self.sharpest(&best, step, 1, area);
            step /= 2.0;
        }
        best
    }

    /// The best of a square of tilts around `center`; of equals, the one nearest to it.
    fn sharpest(
        &mut self,
        center: &Vector2<f64>,
        step: f64,
        steps: i32,
        area: SearchArea,
    ) -> Vector2<f64> {
        self.tilts.clear();
        self.tilts.push(*center);
        for i in -steps..=steps {
            for j in -steps..=steps {
                if (i, j) != (0, 0) {
                    let off = Vector2::new(f64::from(i), f64::from(j)) * step;
                    self.tilts.push(center + off);
                }
            }
        }
        let mut best = *center;
        let mut most = f32::NEG_INFINITY;
        for tilts in self.tilts.chunks(TOGETHER) {
            // A chunk that is not full ends with its last tilt again, which changes nothing.
            let tilts: [_; TOGETHER] = std::array::from_fn(|i| tilts[i.min(tilts.len() - 1)]);
            for (tilt, sharpness) in tilts.iter().zip(self.sharpness(&tilts, area)) {
                if sharpness > most {
                    most = sharpness;
                    best = *tilt;
                }
            }
        }
        best
    }

    /// Sum of squares of the histogram of depths below the camera, for each of some tilts: histograms that do not wait for
    /// each other.
    fn sharpness(&self, tilts: &[Vector2<f64>; TOGETHER], area: SearchArea) -> [f32; TOGETHER] {
        let mut histograms = [[0.0_f32; BINS + 1]; TOGETHER];
        let tilts = tilts.map(|tilt| (tilt.x as f32, tilt.y as f32));
        let lowest = area.below_m.0 as f32;
        let span = ((area.below_m.1 - area.below_m.0) as f32 / BIN_M).min(BINS as f32 - 1.0);
        for [g, x, y, weight] in &self.samples {
            for (histogram, (a, b)) in histograms.iter_mut().zip(tilts) {
                let bin = (g - a * x - b * y - lowest) / BIN_M;
                if bin >= 0.0 && bin < span {
                    let index = bin as usize;
                    let part = bin - index as f32;
                    histogram[index] += weight * (1.0 - part);
                    histogram[index + 1] += weight * part;
                }
            }
        }
        histograms.map(|histogram| {
            let pairs = histogram.windows(2);
            pairs.map(|pair| (pair[0] + pair[1]).powi(2)).sum()
        })
    }
}
