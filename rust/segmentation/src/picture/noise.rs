//! The local noise of the disparities, for thresholds that adapt to it (003, section III).

use std::ops::Range;

use settings::{POSITIVE, settings, within};

settings! {
    /// How the noise of the disparities is measured in the image.
    pub struct NoiseTuning("navigation.ground.tuning.noise") {
        /// Pixels between the three disparities of which the middle one is compared with the mean of the others. They must lie
        /// further apart than a matching window is wide, so that they err independently.
        reach: usize = 6, "1", within(1.0, 100.0), "003, section III";
        /// Blocks across and down the image that have a noise of their own.
        blocks: [usize; 2] = [4, 3], "1", within(1.0, 100.0), "003, section III";
        /// Every so many columns a pixel of each row is compared.
        stride: usize = 2, "1", within(1.0, 100.0);
        /// Step of the histogram of differences from which the noise is read, as a share of `noise_floor`.
        step: f32 = 0.1, "1", POSITIVE;
        /// Fewest differences in a block that tell its noise; with fewer it has `noise_floor`.
        min_samples: u32 = 60, "1", within(1.0, 1e6);
    }
}

/// Steps of the histogram of differences: as many as its array has. The last one holds all that is larger, and is more than any
/// believed noise.
const BINS: usize = 64;
/// Lower quartile of the size of a normal variable with sigma 1.
const QUARTILE: f32 = 0.318_64;
/// Noise of one value over that of three independent ones with the weights 1, -2, 1: one over the root of 6.
const OF_ONE: f32 = 0.408_25;
/// Bin of what was not seen.
const UNSEEN: usize = BINS + 1;

/// A noise for each block of the image. Keeps its buffer.
#[derive(Debug, Clone)]
pub(crate) struct NoiseMap {
    tuning: NoiseTuning,
    width: usize,
    height: usize,
    // Every so many rows one is looked at.
    finer: usize,
    floor_px: f32,
    ceiling_px: f32,
    // Block by block.
    sigma_px: Vec<f32>,
    // Bin of the difference at each pixel of a line.
    bins: Vec<u32>,
}

impl NoiseMap {
    /// For images of this size that are so many times finer than needed; the noise lies between a floor and a multiple of it.
    pub(crate) fn new(
        [width, height]: [usize; 2],
        finer: usize,
        [floor_px, ceiling]: [f64; 2],
        tuning: NoiseTuning,
    ) -> Self {
        let blocks = tuning.blocks[0] * tuning.blocks[1];
        Self {
            tuning,
            width,
            height,
            finer,
            floor_px: floor_px as f32,
            ceiling_px: (floor_px * ceiling) as f32,
            sigma_px: vec![floor_px as f32; blocks],
            bins: Vec::with_capacity(width),
        }
    }

    /// Measures the noise in each block.
    ///
    /// A plane is linear in column and row, so second differences `d(-6) - 2 d(0) + d(6)` hold noise alone; their lower
    /// quartile ignores the pixels at edges. Rows and columns are measured apart and the smaller one counts: edges
    /// that run across the image disturb the columns alone.
    pub(crate) fn measure(&mut self, disparity_px: &[f32]) {
        let [across, down] = self.tuning.blocks;
        for block in 0..across * down {
            let (i, j) = (block % across, block / across);
            let cols = (i * self.width / across, (i + 1) * self.width / across);
            let rows = (j * self.height / down, (j + 1) * self.height / down);
            let reach = self.tuning.reach;
            let along_rows = self.quartile(disparity_px, cols, rows, (reach, 0));
            let along_cols = self.quartile(disparity_px, cols, rows, (0, reach));
            let sigma = match (along_rows, along_cols) {
                (Some(a), Some(b)) => a.min(b),
                (Some(a), None) | (None, Some(a)) => a,
                (None, None) => self.floor_px,
            };
            self.sigma_px[block] = sigma.clamp(self.floor_px, self.ceiling_px);
        }
    }

    fn quartile(
        &mut self,
        disparity_px: &[f32],
        cols: (usize, usize),
        rows: (usize, usize),
        reach: (usize, usize),
    ) -> Option<f32> {
        let mut counts = [0_u32; UNSEEN + 1];
        let offset = reach.1 * self.width + reach.0;
        let rows = rows.0.max(reach.1)..rows.1.min(self.height.saturating_sub(reach.1));
        for row in rows.step_by(self.finer) {
            let from = row * self.width + cols.0.max(reach.0);
            let to = row * self.width + cols.1.min(self.width.saturating_sub(reach.0));
            if from >= to {
                continue; // all of the block lies too near to the image's sides
            }
            self.find_bins(disparity_px, from..to, offset);
            for &bin in self.bins.iter().step_by(self.tuning.stride) {
                counts[bin as usize] += 1;
            }
        }
        let total: u32 = counts[..UNSEEN].iter().sum();
        if total < self.tuning.min_samples {
            return None;
        }
        let mut below = 0.0;
        let wanted = total as f32 / 4.0;
        for (bin, &count) in counts[..UNSEEN].iter().enumerate() {
            let count = count as f32;
            if below + count >= wanted {
                let part = (wanted - below) / count;
                return Some((bin as f32 + part) * self.tuning.step * self.floor_px / QUARTILE);
            }
            below += count;
        }
        None
    }

    /// Fills `bins` with those of the second differences of these pixels, `offset` to both sides.
    fn find_bins(&mut self, disparity_px: &[f32], pixels: Range<usize>, offset: usize) {
        let per_bin = 1.0 / (self.tuning.step * self.floor_px);
        let [before, here, behind] = [pixels.start - offset, pixels.start, pixels.start + offset]
            .map(|start| &disparity_px[start..start + pixels.len()]);
        let values = before.iter().zip(here).zip(behind);
        self.bins.clear();
        self.bins.extend(values.map(|((&a, &b), &c)| {
            let bend = a - 2.0 * b + c;
            let bin = bend.abs() * per_bin * OF_ONE;
            let bin = if bin < BINS as f32 { bin } else { BINS as f32 };
            // Of no bin where one of the three was not seen.
            rounded_down(if bend.is_nan() { UNSEEN as f32 } else { bin })
        }));
    }

    /// Fills `image` with the noise at every pixel, px, row by row.
    pub(crate) fn fill(&self, image: &mut [f32]) {
        let [across, down] = self.tuning.blocks;
        for (row, line) in image.chunks_exact_mut(self.width).enumerate() {
            let j = (row * down / self.height).min(down - 1);
            for i in 0..across {
                let cols = i * self.width / across..(i + 1) * self.width / across;
                line[cols].fill(self.sigma_px[j * across + i]);
            }
        }
    }
}

/// A number of 0 to 2^22 as a whole one. Without a cast, which processors of all ages do one by one.
fn rounded_down(value: f32) -> u32 {
    // So large that a sum has no room for a fraction, and its lowest bits are the whole number.
    const NO_FRACTION: f32 = 8_388_608.0;
    let nearest = value + NO_FRACTION - NO_FRACTION;
    let below = if nearest > value {
        nearest - 1.0
    } else {
        nearest
    };
    (below + NO_FRACTION).to_bits() & 0x7f_ffff
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::synthetic::Noise;

    fn measured(sigma_px: f64) -> f32 {
        let (width, height) = (88, 72);
        let mut image: Vec<f32> = (0..width * height)
            .map(|i| 4.0 + 0.1 * (i / width) as f32 + 0.02 * (i % width) as f32)
            .collect();
        Noise::new(7).correlated(width, sigma_px, &mut image);
        let mut map = NoiseMap::new([width, height], 1, [0.05, 20.0], NoiseTuning::default());
        map.measure(&image);
        map.sigma_px.iter().sum::<f32>() / map.sigma_px.len() as f32
    }

    #[test]
    fn the_measured_noise_follows_the_true_one() {
        for sigma in [0.125, 0.25, 0.5] {
            let ratio = f64::from(measured(sigma)) / sigma;
            assert!((0.7..1.15).contains(&ratio), "{sigma}: {ratio}");
        }
    }

    #[test]
    fn numbers_are_rounded_down_like_a_cast_does() {
        for whole in 0..=65_u16 {
            let whole = f32::from(whole);
            for value in [
                whole,
                whole.next_up(),
                whole + 0.5,
                (whole + 1.0).next_down(),
            ] {
                assert_eq!(rounded_down(value), value as u32, "{value}");
            }
        }
    }

    #[test]
    fn an_image_too_small_to_tell_its_noise_has_the_calibrated_floor() {
        for (width, height) in [(1, 1), (3, 40), (12, 9), (20, 20), (24, 13), (400, 2)] {
            let mut map = NoiseMap::new([width, height], 1, [0.125, 4.0], NoiseTuning::default());
            map.measure(&vec![5.0; width * height]);
            assert!(map.sigma_px.iter().all(|&sigma| sigma == 0.125));
            let mut image = vec![f32::NAN; width * height];
            map.fill(&mut image);
            assert!(
                image.iter().all(|&sigma| sigma == 0.125),
                "{width} {height}"
            );
        }
    }

    #[test]
    fn nothing_seen_means_the_calibrated_floor() {
        let mut map = NoiseMap::new([88, 72], 1, [0.125, 4.0], NoiseTuning::default());
        map.measure(&vec![f32::NAN; 88 * 72]);
        assert!(map.sigma_px.iter().all(|&sigma| sigma == 0.125));
    }
}
