//! The part of a stereo camera's error that stays while the picture stays: a smooth random function of the camera's pose, of the
//! disparity and of the surface (random Fourier features, Rahimi and Recht 2007).

use std::f64::consts::{SQRT_2, TAU};

use geometry::{GOLDEN, SplitMix64};

use crate::eye::CameraPose;
use crate::noise::draws::normals;
use crate::noise::nearest;
use crate::noise::stereo_config::PatternTuning;
use crate::pinhole::Pinhole;

/// Numbers of a pose: place and rotation.
const POSE: usize = 12;
/// Divisors of the terms of the sine's series, each of the one before: (2 n) (2 n + 1).
const SERIES: [f32; 4] = [over(2), over(4), over(6), over(8)];

/// One over the product of a number and the next one.
const fn over(n: u16) -> f32 {
    1.0 / (n * (n + 1)) as f32
}

/// A wave a pixel, whose phase runs with pose, disparity and surface. Pixels far apart share a wave, but not its phase.
#[derive(Debug, Clone)]
pub(super) struct Pattern {
    /// For each number of a pose, the turns of every wave.
    by_pose: [Vec<f64>; POSE],
    /// Turns of each wave a pixel of disparity; as many more as a row has pixels, so that a row can begin at any wave.
    by_disparity: Vec<f32>,
    by_surface: f32,
    /// Turns of each pixel.
    phase: Vec<f32>,
    /// Turns of each wave at the pose that was told last; as many as `by_disparity`.
    turned: Vec<f32>,
    sum: Vec<f64>,
    tuning: PatternTuning,
    scales: [f32; 2],
    width: usize,
}

impl Pattern {
    /// The error gets a wave's cosine times `scales[0]`, the luck of matches its sine times `scales[1]`.
    pub(super) fn new(
        tuning: &PatternTuning,
        scales: [f32; 2],
        pinhole: &Pinhole,
        stream: &mut SplitMix64,
    ) -> Self {
        let waves = tuning.waves;
        let mut draw = |scale: f64| -> Vec<f64> {
            let pairs = waves.div_ceil(2);
            let mut all: Vec<f64> = (0..pairs).flat_map(|_| normals(stream)).collect();
            all.truncate(waves);
            all.iter().map(|value| value * scale).collect()
        };
        let by_pose = std::array::from_fn(|_| draw(1.0 / TAU));
        let once = draw(1.0 / (TAU * tuning.disparity));
        let by_disparity = once.iter().cycle().take(waves + pinhole.width);
        Self {
            by_pose,
            by_disparity: by_disparity.map(|turns| *turns as f32).collect(),
            by_surface: stream.uniform() as f32,
            phase: (0..pinhole.pixels())
                .map(|_| stream.uniform() as f32)
                .collect(),
            turned: vec![0.0; waves + pinhole.width],
            sum: vec![0.0; waves],
            tuning: tuning.clone(),
            scales,
            width: pinhole.width,
        }
    }

    /// Takes the pattern to a pose.
    pub(super) fn turn_to(&mut self, view: &CameraPose) {
        let place = view.position_m.map(|x| x / self.tuning.way);
        let turn = view.rotation.map(|x| x / (SQRT_2 * self.tuning.turn));
        self.sum.fill(0.0);
        for (waves, value) in self.by_pose.iter().zip(place.iter().chain(&turn)) {
            for (sum, wave) in self.sum.iter_mut().zip(waves) {
                *sum += wave * value;
            }
        }
        let turns = self.sum.iter().cycle();
        for (turned, turns) in self.turned.iter_mut().zip(turns) {
            *turned = (turns - turns.floor()) as f32;
        }
    }

    /// Adds the pattern to the errors and the luck of a row of the picture.
    pub(super) fn add_row(
        &self,
        row: usize,
        disparity: &[f32],
        body: &[i32],
        error: &mut [f32],
        luck: &mut [f32],
    ) {
        // The golden ratio's multiples spread the rows evenly over the waves: none comes twice in a window.
        let spread = (row as u64).wrapping_mul(GOLDEN) >> 32;
        let begin = ((spread * self.sum.len() as u64) >> 32) as usize;
        let waves = self.turned[begin..].iter().zip(&self.by_disparity[begin..]);
        let phase = &self.phase[row * self.width..];
        let pixels = disparity.iter().zip(body).zip(phase).zip(waves);
        for ((((disparity, body), phase), (turned, slope)), (error, luck)) in
            pixels.zip(error.iter_mut().zip(luck))
        {
            let turns = turned + phase + slope * disparity + self.by_surface * *body as f32;
            let (cosine, sine) = circle(turns);
            *error += cosine * self.scales[0];
            *luck += sine * self.scales[1];
        }
    }
}

/// Cosine and sine of an angle in turns.
#[inline]
fn circle(turns: f32) -> (f32, f32) {
    let quarter = 0.5 * 0.5;
    let turn = turns - nearest(turns);
    let beside = turn - quarter;
    let beside = beside - nearest(beside);
    (sine(quarter - turn.abs()), sine(quarter - beside.abs()))
}

/// Sine of up to a quarter turn either way, by its series.
#[inline]
fn sine(turns: f32) -> f32 {
    let angle = turns * std::f32::consts::TAU;
    let square = angle * angle;
    let mut sum = 1.0;
    let mut term = SERIES.len();
    while term > 0 {
        term -= 1;
        sum = 1.0 - square * SERIES[term] * sum;
    }
    angle * sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cosine_and_sine_are_good_to_a_hundred_thousandth() {
        for i in -3000..3000_i16 {
            let turns = f32::from(i) / 1000.0;
            let (cosine, sine) = circle(turns);
            let angle = f64::from(turns) * TAU;
            assert!(
                (f64::from(cosine) - libm::cos(angle)).abs() < 1e-5,
                "{turns}"
            );
            assert!((f64::from(sine) - libm::sin(angle)).abs() < 1e-5, "{turns}");
        }
    }

    #[test]
    fn no_wave_comes_twice_in_a_window() {
        let waves = PatternTuning::default().waves as u64;
        let begin = |row: u64| ((row.wrapping_mul(GOLDEN) >> 32) * waves) >> 32;
        for row in 0..480 {
            for other in row + 1..row + 9 {
                let apart = begin(row).abs_diff(begin(other));
                assert!(apart.min(waves - apart) >= 9, "{row} {other}");
            }
        }
    }
}
