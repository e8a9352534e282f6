//! A first guess of the camera's tilt: the one under which the heights of all points pile up most sharply.

use nalgebra::Vector2;
use settings::{NOT_NEGATIVE, POSITIVE, settings, within};

use crate::picture::{Picture, View};

settings! {
    /// How the camera's tilt is guessed at the beginning of each frame: by the heights of all points, which pile up most sharply under
    /// the right one.
    pub struct TiltSearchTuning("navigation.ground.tuning.tilt_search") {
        /// Every so many columns and rows one pixel is looked at; of finer images as many pixels as of coarse ones.
        stride: [usize; 2] = [2, 3], "1", within(1.0, 100.0);
        /// Height of a bin of the histogram of heights.
        bin: f32 = 0.006, "m", POSITIVE;
        /// Most bins of the histogram of heights; what lies deeper than they reach does not count.
        bins: usize = 96, "1", within(2.0, 255.0);
        /// Points further than `search_reach` from the robot count less while the ground is searched: by this power of the distance.
        nearness_power: i32 = 4, "1", within(0.0, 16.0);
        /// Steps from no tilt to `search_tilt` in the first round of a search from nothing.
        first_steps: u32 = 6, "1", within(1.0, 50.0);
        /// The step of a search from nothing is halved until it would be smaller than this.
        last_step: f64 = 0.006, "rad", POSITIVE;
        /// Step of the search while the ground is tracked: one is tried in each direction.
        tracked_step: f64 = 0.006, "rad", POSITIVE;
        /// Heights count in a search from nothing up to so many times `ground_height` from where the joints have the ground.
        height_slack: f64 = 2.0, "1", POSITIVE;
        /// Least depth below the camera at which heights count while the ground is tracked.
        tracked_nearest: f64 = 0.15, "m", NOT_NEGATIVE;
        /// Depth below the ground down to which heights count while the ground is tracked.
        tracked_deeper: f64 = 0.2, "m", NOT_NEGATIVE;
    }
}

/// Bins that a histogram has room for: no number of 8 bits lies outside.
const ROOM: usize = 257;
/// Samples whose bins are found together.
const LANES: usize = 8;
/// Tilts that are tried together.
const TOGETHER: usize = 3;

/// Where the search looks.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SearchArea {
    /// Tilts up to this in both directions, rad.
    pub(crate) tilt_rad: f64,
    /// First step of the search, rad; halved until it would be below the last one.
    pub(crate) step_rad: f64,
    /// Smallest step of the search, rad.
    pub(crate) last_step_rad: f64,
    /// Depths below the camera that count, m.
    pub(crate) below_m: (f64, f64),
    /// Points further than a radius from a place count less, by a power of the distance; from the camera, m:
    /// forward, to the left, and the radius.
    pub(crate) around_m: [f32; 3],
}

/// Some pixels: g, X, Y over the disparity, the depth below the camera is their combination; and a weight.
#[derive(Debug, Clone, Copy)]
struct Samples {
    g: [f32; LANES],
    x: [f32; LANES],
    y: [f32; LANES],
    weight: [f32; LANES],
}

impl Samples {
    /// No samples: they lie in no bin.
    const NONE: Self = Self {
        g: [f32::NAN; LANES],
        x: [0.0; LANES],
        y: [0.0; LANES],
        weight: [0.0; LANES],
    };

    /// The bins of these samples from the lowest depth on, under a tilt.
    fn bins(&self, (a, b): (f32, f32), lowest_m: f32, bin_m: f32) -> [f32; LANES] {
        std::array::from_fn(|i| (self.g[i] - a * self.x[i] - b * self.y[i] - lowest_m) / bin_m)
    }
}

/// Searches the tilt. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(crate) struct HorizonSearch {
    tuning: TiltSearchTuning,
    samples: Vec<Samples>,
    // The tilts to be tried, in the order in which they count among equals.
    tilts: Vec<Vector2<f64>>,
}

impl HorizonSearch {
    /// Buffers that are still empty.
    pub(crate) fn new(tuning: TiltSearchTuning) -> Self {
        Self {
            tuning,
            ..Self::default()
        }
    }

    /// The tilt `(a, b)` with the sharpest heights. `picture.g` must belong to `view`.
    pub(crate) fn search(
        &mut self,
        picture: Picture<'_>,
        view: &View,
        area: SearchArea,
    ) -> Vector2<f64> {
        self.samples.clear();
        let mut count = 0;
        let height = picture.disparity_px.len() / picture.width;
        let [across, down] = self.tuning.stride.map(|stride| stride * picture.finer);
        let power = self.tuning.nearness_power;
        for row in (0..height).step_by(down) {
            for col in (row / down % across..picture.width).step_by(across) {
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
                let lane = count % LANES;
                if lane == 0 {
                    self.samples.push(Samples::NONE);
                }
                count += 1;
                if let Some(samples) = self.samples.last_mut() {
                    samples.g[lane] = g / d;
                    (samples.x[lane], samples.y[lane]) = (x, y);
                    samples.weight[lane] = d / sigma * nearness.powi(power);
                }
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
        let mut histograms = [[0.0_f32; ROOM]; TOGETHER];
        let tilts = tilts.map(|tilt| (tilt.x as f32, tilt.y as f32));
        let (bin_m, bins) = (self.tuning.bin, self.tuning.bins);
        let lowest = area.below_m.0 as f32;
        let span = ((area.below_m.1 - area.below_m.0) as f32 / bin_m).min(bins as f32 - 1.0);
        for samples in &self.samples {
            let of_tilts = tilts.map(|tilt| samples.bins(tilt, lowest, bin_m));
            for (lane, weight) in samples.weight.iter().enumerate() {
                for (histogram, bins) in histograms.iter_mut().zip(&of_tilts) {
                    let bin = bins[lane];
                    if bin >= 0.0 && bin < span {
                        let index = bin as u8;
                        let part = bin - f32::from(index);
                        let index = usize::from(index);
                        histogram[index] += weight * (1.0 - part);
                        histogram[index + 1] += weight * part;
                    }
                }
            }
        }
        histograms.map(|histogram| {
            let pairs = histogram[..=bins].windows(2);
            pairs.map(|pair| (pair[0] + pair[1]).powi(2)).sum()
        })
    }
}
