//! The rows of strips: of the few pixels of each, the mean over those that agree with the middle one.

use std::ops::Range;

use super::config::ScanLineConfig;
use crate::picture::Picture;

/// The rows of one strip. The loops run over the rows, so that pixel `k` of every row is taken at once: *lanes*. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct StripRows {
    /// Disparity over `g` of each row; of no use where the weight is 0.
    pub(super) q: Vec<f32>,
    /// Weight of each row, `(g / sigma)^2`; 0 where too few of its pixels agree.
    pub(super) weight: Vec<f32>,
    // Pixel by pixel of the strip: disparity, g, and q in order, without what was not seen.
    disparity_px: Vec<f32>,
    g: Vec<f32>,
    sorted: Vec<f32>,
    // One value a row: noise, pixels that were seen, the middle q, and pixels that agree with it.
    sigma_px: Vec<f32>,
    seen: Vec<f32>,
    middle: Vec<f32>,
    agree: Vec<f32>,
}

impl StripRows {
    /// Takes in a strip of a picture that has these columns; the last strip may have fewer than others. Of a finer picture as many of
    /// its pixels are looked at as of a coarse one's.
    pub(super) fn read(
        &mut self,
        picture: Picture<'_>,
        cols: Range<usize>,
        config: &ScanLineConfig,
        scale: f32,
    ) {
        let (strip, tuning) = (config.strip, &config.tuning);
        let least_fall = tuning.min_fall * scale;
        let lanes = (picture.disparity_px.len() / picture.width).div_ceil(picture.finer);
        let needed = (tuning.agreeing * cols.len().div_ceil(picture.finer) as f64).ceil() as f32;
        self.spread(picture, cols, strip, lanes);
        self.sort(strip, least_fall, lanes);
        self.find_middles(strip, lanes);
        self.average(least_fall, tuning.agree, lanes, needed);
    }

    /// Brings the pictures into lanes; what the strip lacks is not seen.
    fn spread(&mut self, picture: Picture<'_>, cols: Range<usize>, strip: usize, lanes: usize) {
        let column_of = |image, col| column(picture, col, image);
        self.disparity_px.clear();
        self.g.clear();
        for col in cols.clone().step_by(picture.finer) {
            self.disparity_px
                .extend(column_of(picture.disparity_px, col));
            self.g.extend(column_of(picture.g, col));
        }
        self.disparity_px.resize(strip * lanes, f32::NAN);
        self.g.resize(strip * lanes, 0.0);
        self.sigma_px.clear();
        let middle = cols.start + cols.len() / 2;
        self.sigma_px.extend(column_of(picture.sigma_px, middle));
    }

    /// Sorts the `q` of each lane, what was not seen at the end, and counts those that were.
    fn sort(&mut self, strip: usize, least_fall: f32, lanes: usize) {
        self.seen.clear();
        self.seen.resize(lanes, 0.0);
        self.sorted.clear();
        let pixels = self.disparity_px.iter().zip(&self.g);
        self.sorted.extend(pixels.map(|(&d, &g)| {
            let q = d / g;
            let usable = g >= least_fall && !q.is_nan();
            if usable { q } else { f32::INFINITY }
        }));
        for values in self.sorted.chunks_exact(lanes) {
            for (seen, &q) in self.seen.iter_mut().zip(values) {
                *seen += if q < f32::INFINITY { 1.0 } else { 0.0 };
            }
        }
        // By odd-even merging (Batcher 1968): the same steps in all lanes.
        let mut run = 1;
        while run < strip {
            let mut apart = run;
            while apart > 0 {
                for k in apart % run..strip - apart {
                    let starts = (k - apart % run) / apart % 2 == 0;
                    if starts && k / (2 * run) == (k + apart) / (2 * run) {
                        self.exchange(k, k + apart, lanes);
                    }
                }
                apart /= 2;
            }
            run *= 2;
        }
    }

    /// Puts the lower one of the `a`-th and the `b`-th value of each lane first.
    fn exchange(&mut self, a: usize, b: usize, lanes: usize) {
        let (before, behind) = self.sorted.split_at_mut(b * lanes);
        for (a, b) in before[a * lanes..][..lanes].iter_mut().zip(behind) {
            let (low, high) = (if *a < *b { *a } else { *b }, if *b > *a { *b } else { *a });
            (*a, *b) = (low, high);
        }
    }

    /// The upper one of the two middle ones, or the middle one.
    fn find_middles(&mut self, strip: usize, lanes: usize) {
        self.middle.clear();
        self.middle.resize(lanes, f32::INFINITY);
        for (k, values) in self
            .sorted
            .chunks_exact(lanes)
            .enumerate()
            .take(strip / 2 + 1)
        {
            let (least, below) = ((2 * k) as f32, (2 * k + 2) as f32);
            for ((middle, &q), &seen) in self.middle.iter_mut().zip(values).zip(&self.seen) {
                *middle = if seen >= least && seen < below {
                    q
                } else {
                    *middle
                };
            }
        }
    }

    /// Least squares over the pixels that agree with the middle one.
    fn average(&mut self, least_fall: f32, agree_within: f32, lanes: usize, needed: f32) {
        for sums in [&mut self.q, &mut self.weight, &mut self.agree] {
            sums.clear();
            sums.resize(lanes, 0.0);
        }
        let pixels = self.disparity_px.chunks_exact(lanes);
        for (disparity_px, g) in pixels.zip(self.g.chunks_exact(lanes)) {
            let sums = self.q.iter_mut().zip(&mut self.weight).zip(&mut self.agree);
            let middles = self.middle.iter().zip(&self.sigma_px);
            for (((sums, &d), &g), (&middle, &sigma)) in sums.zip(disparity_px).zip(g).zip(middles)
            {
                let ((dg, gg), agree) = sums;
                // False where it was not seen.
                let agrees = (d - middle * g).abs() < agree_within * sigma && g >= least_fall;
                *dg += if agrees { d * g } else { 0.0 };
                *gg += if agrees { g * g } else { 0.0 };
                *agree += if agrees { 1.0 } else { 0.0 };
            }
        }
        let sums = self.q.iter_mut().zip(&mut self.weight);
        let counts = self.agree.iter().zip(&self.sigma_px);
        for ((q, weight), (&agree, &sigma)) in sums.zip(counts) {
            *q /= *weight;
            let mean = *weight / agree / (sigma * sigma);
            *weight = if agree < needed { 0.0 } else { mean };
        }
    }
}

/// A column of one of the picture's images, of finer ones some rows.
fn column(picture: Picture<'_>, col: usize, image: &[f32]) -> impl Iterator<Item = f32> {
    let rows = image.chunks_exact(picture.width).step_by(picture.finer);
    rows.map(move |row| row[col])
}

#[cfg(test)]
mod tests {
    use super::super::config::ScanLineConfig;
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_values_of_every_lane_are_sorted_whatever_the_width_of_the_strips(
            disparity_px in prop::collection::vec(0.5..9.0f32, 66), strip in 1..=32usize,
        ) {
            let picture = Picture {
                width: 33,
                disparity_px: &disparity_px,
                g: &[1.0; 66],
                sigma_px: &[0.125; 66],
                finer: 1,
            };
            let config = ScanLineConfig { strip, ..ScanLineConfig::default() };
            let mut rows = StripRows::default();
            let mut seen = 0;
            for first in (0..33).step_by(strip) {
                rows.read(picture, first..(first + strip).min(33), &config, 6.0);
                let lanes = rows.seen.len();
                for lane in 0..lanes {
                    let sorted: Vec<_> = rows.sorted.iter().skip(lane).step_by(lanes).collect();
                    prop_assert!(sorted.is_sorted());
                }
                seen += rows.sorted.iter().filter(|q| q.is_finite()).count();
            }
            prop_assert_eq!(seen, disparity_px.len());
        }
    }
}
