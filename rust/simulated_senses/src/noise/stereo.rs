//! From what the rays met to the depth image that a stereo camera would give.

use geometry::SplitMix64;
use settings::{ConfigError, Table};

use crate::error::{SceneError, of_length};
use crate::eye::CameraPose;
use crate::noise::creases::Crease;
use crate::noise::draws::{Rarely, bell, even, quantile};
use crate::noise::occlusion::hidden;
use crate::noise::pattern::Pattern;
use crate::noise::stereo_config::StereoConfig;
use crate::noise::window::{LastRows, add, fold_along, larger, smaller};
use crate::noise::{LARGEST, nearest};
use crate::picture::TruePicture;
use crate::pinhole::Pinhole;

/// A window of at least this makes of even numbers a sum that is nearly normal.
const SUMMING_WINDOW: usize = 3;

/// A stereo camera's errors. They have a fixed part, a smooth random function of the camera's pose, the disparity and the surface,
/// and a part that is new in each frame.
#[derive(Debug, Clone)]
pub struct StereoErrors {
    config: StereoConfig,
    pinhole: Pinhole,
    /// Disparity times depth, px m.
    scale: f32,
    /// Step of the disparities, 0 for none, px.
    quantum: f32,
    pattern: Pattern,
    stream: SplitMix64,
    mismatches: Rarely,
    /// For no body and then for each body: below which value of a standard normal it is matched.
    thresholds: Vec<f32>,
    crease: Crease,
    rows: StereoRows,
}

/// Rows that are made anew for each row of the picture, and the last ones of those that windows are summed over.
#[derive(Debug, Clone)]
struct StereoRows {
    /// The whole picture's, px.
    disparity: Vec<f32>,
    error: Vec<f32>,
    luck: Vec<f32>,
    place: Vec<f32>,
    hidden: Vec<bool>,
    errors: LastRows,
    lucks: LastRows,
    largest: LastRows,
    smallest: LastRows,
    /// Of the windows' middles: disparity, luck, largest and smallest disparity.
    measured: Vec<f32>,
    chance: Vec<f32>,
    high: Vec<f32>,
    low: Vec<f32>,
}

impl StereoRows {
    fn new(pinhole: &Pinhole, window: usize) -> Self {
        let inner = (pinhole.width + 1).saturating_sub(window);
        let row = || vec![0.0; pinhole.width];
        let last = || LastRows::new(window, inner);
        Self {
            disparity: vec![0.0; pinhole.pixels()],
            error: row(),
            luck: row(),
            place: row(),
            hidden: vec![false; pinhole.width],
            errors: last(),
            lucks: last(),
            largest: last(),
            smallest: last(),
            measured: vec![0.0; inner],
            chance: vec![0.0; inner],
            high: vec![0.0; inner],
            low: vec![0.0; inner],
        }
    }
}

impl StereoErrors {
    /// The camera's errors for bodies of these textures, 0 (blank) to 1. `pattern` seeds what stays, `noise` what is new in each frame.
    pub fn new(
        config: StereoConfig,
        pinhole: &Pinhole,
        textures: &[f64],
        pattern: u64,
        noise: u64,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        let mut stream = SplitMix64::new(noise);
        let tuning = &config.tuning;
        // A finer step than single precision tells is none.
        let steps = config.max_disparity / config.quantum;
        let quantum = if steps < f64::from(LARGEST) {
            config.quantum
        } else {
            0.0
        };
        Ok(Self {
            scale: (pinhole.focal_px * config.baseline) as f32,
            quantum: quantum as f32,
            pattern: Pattern::new(
                &tuning.pattern,
                pattern_scales(&config),
                pinhole,
                &mut SplitMix64::new(pattern),
            ),
            mismatches: Rarely::new(config.mismatch_rate, &mut stream),
            stream,
            thresholds: thresholds(&config, textures),
            crease: Crease::new(
                config.window,
                config.crease_bandwidth as f32,
                tuning.creases.iterations,
            ),
            rows: StereoRows::new(pinhole, config.window),
            pinhole: *pinhole,
            config,
        })
    }

    /// Writes the measured depth, m along the axis, NaN for no match.
    pub fn see(
        &mut self,
        picture: &TruePicture,
        view: &CameraPose,
        depth_m: &mut [f32],
    ) -> Result<(), SceneError> {
        of_length("depth", depth_m.len(), self.pinhole.pixels())?;
        of_length("picture", picture.body().len(), self.pinhole.pixels())?;
        depth_m.fill(f32::NAN);
        let (window, width) = (self.config.window, self.pinhole.width);
        if self.rows.measured.is_empty() {
            return Ok(());
        }
        self.pattern.turn_to(view);
        for row in 0..self.pinhole.height {
            let pixels = row * width..(row + 1) * width;
            let nearness = &picture.nearness()[pixels.clone()];
            self.read_row(row, nearness, &picture.body()[pixels]);
            if row + 1 >= window {
                let first = row + 1 - window;
                let at = (first + window / 2) * width + window / 2;
                let inner = at..at + self.rows.measured.len();
                self.match_row(first, &picture.body()[inner.clone()]);
                self.write_row(first, &picture.body()[inner.clone()], &mut depth_m[inner]);
            }
        }
        Ok(())
    }

    /// Makes a row's disparities and the errors of its pixels, and folds them along the row.
    fn read_row(&mut self, row: usize, nearness: &[f64], body: &[i32]) {
        let (config, rows, width) = (&self.config, &mut self.rows, self.pinhole.width);
        let scale = f64::from(self.scale);
        let disparity = &mut rows.disparity[row * width..(row + 1) * width];
        for (disparity, near) in disparity.iter_mut().zip(nearness) {
            *disparity = (scale * near) as f32;
        }
        if config.window >= SUMMING_WINDOW {
            even(&mut self.stream, &mut rows.error, &mut rows.luck);
        } else {
            bell(&mut self.stream, &mut rows.error);
            bell(&mut self.stream, &mut rows.luck);
        }
        // A sum over n x n independent values has n times their deviation.
        let unit = 1.0 / config.window as f64;
        let temporal = config.tuning.matches.temporal;
        let mean = (unit * unit) as f32;
        let new = [
            (unit * config.disparity_noise_temporal) as f32,
            (unit * temporal) as f32,
        ];
        let pixels = disparity
            .iter()
            .zip(rows.error.iter_mut().zip(&mut rows.luck));
        for (disparity, (error, luck)) in pixels {
            *error = *error * new[0] + disparity * mean;
            *luck *= new[1];
        }
        self.pattern
            .add_row(row, disparity, body, &mut rows.error, &mut rows.luck);
        let window = config.window;
        fold_along(&rows.error, window, rows.errors.place(row), add);
        fold_along(&rows.luck, window, rows.lucks.place(row), add);
        fold_along(disparity, window, rows.largest.place(row), larger);
        fold_along(disparity, window, rows.smallest.place(row), smaller);
    }

    /// Finds the disparities of the windows whose first row this is, px.
    fn match_row(&mut self, first: usize, body: &[i32]) {
        let (config, rows, width) = (&self.config, &mut self.rows, self.pinhole.width);
        rows.errors.fold(&mut rows.measured, add);
        rows.lucks.fold(&mut rows.chance, add);
        rows.largest.fold(&mut rows.high, larger);
        rows.smallest.fold(&mut rows.low, smaller);
        let bandwidth = config.crease_bandwidth as f32;
        let spread = rows.high.iter().zip(&rows.low);
        for (column, (measured, (high, low))) in rows.measured.iter_mut().zip(spread).enumerate() {
            if high - low >= bandwidth {
                let at = first * width + column;
                let (mode, mean) = self.crease.mode(&rows.disparity, width, at);
                *measured += mode - mean;
            }
        }
        for (chance, body) in rows.chance.iter_mut().zip(body) {
            *chance -= threshold(&self.thresholds, *body);
        }
        // A few of the matched pixels are anywhere in the range of disparities.
        let count = rows.measured.len();
        let mut from = 0;
        while let Some(at) = self.mismatches.next(from, count, &mut self.stream) {
            let range = config.max_disparity - config.min_disparity;
            let anywhere = config.min_disparity + range * self.stream.uniform();
            rows.measured[at] = if rows.chance[at] < 0.0 {
                anywhere as f32
            } else {
                0.0
            };
            from = at + 1;
        }
    }

    /// Writes the depths of the windows' middles.
    fn write_row(&mut self, first: usize, body: &[i32], depth_m: &mut [f32]) {
        let (config, rows, width) = (&self.config, &mut self.rows, self.pinhole.width);
        let border = config.window / 2;
        let begin = (first + border) * width;
        let disparity = &rows.disparity[begin..begin + width];
        hidden(disparity, &mut rows.place, &mut rows.hidden);
        let (least, most) = (config.min_disparity as f32, config.max_disparity as f32);
        let (quantum, steps) = (self.quantum, 1.0 / self.quantum);
        if quantum > 0.0 {
            for measured in &mut rows.measured {
                *measured = nearest(*measured * steps) * quantum;
            }
        }
        let known = rows.measured.iter().zip(&rows.chance);
        let there = body.iter().zip(&rows.hidden[border..]);
        for (column, ((depth, (measured, chance)), (body, hidden))) in
            depth_m.iter_mut().zip(known).zip(there).enumerate()
        {
            let seen = *chance < 0.0 && !hidden && *body >= 0;
            let seen = seen && *measured >= least && *measured <= most;
            // The other eye has it in view.
            let seen = seen && column as f32 >= *measured;
            *depth = if seen {
                self.scale / measured
            } else {
                f32::NAN
            };
        }
    }
}

/// How much of the pattern is in a pixel's error and luck: over n x n pixels it sums up to n times its deviation, and a cosine's is
/// the root of a half.
fn pattern_scales(config: &StereoConfig) -> [f32; 2] {
    let unit = std::f64::consts::SQRT_2 / config.window as f64;
    let temporal = config.tuning.matches.temporal;
    [
        (unit * config.disparity_noise_fixed) as f32,
        (unit * (1.0 - temporal * temporal).sqrt()) as f32,
    ]
}

/// Below which value of a standard normal a body is matched; none is where there is no body.
fn threshold(thresholds: &[f32], body: i32) -> f32 {
    let index = usize::try_from(body + 1).unwrap_or(0);
    thresholds.get(index).copied().unwrap_or(f32::NEG_INFINITY)
}

/// The thresholds of no body and of each body.
fn thresholds(config: &StereoConfig, textures: &[f64]) -> Vec<f32> {
    let doubt = config.tuning.matches.doubt;
    let of = |texture: &f64| {
        let share = texture.clamp(0.0, 1.0);
        let valid = config.valid_blank + share * (config.valid_textured - config.valid_blank);
        quantile(valid.clamp(doubt, 1.0 - doubt)) as f32
    };
    let none = std::iter::once(f32::NEG_INFINITY);
    none.chain(textures.iter().map(of)).collect()
}
