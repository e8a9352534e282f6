//! A 3x3 median over the pixels that were seen: takes single mismatches out before anything is fitted.
//!
//! In the first and the last row that are seen it is one along the row: rows on one side alone would shift the disparity of a
//! floor by 0.1 px there, and so tilt the camera by a tenth of a degree, always the same way.

use settings::{settings, within};

settings! {
    /// How the median takes single mismatches out of the picture.
    pub struct MedianTuning("navigation.ground.tuning.median") {
        /// Fewest pixels of a square of nine that must be seen for the middle one to count as seen.
        min_seen: usize = 5, "1", within(5.0, 9.0);
    }
}

/// The smaller one; of no use with NaN.
const fn lower(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The larger one; of no use with NaN.
const fn upper(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

const fn middle(a: f32, b: f32, c: f32) -> f32 {
    upper(lower(a, b), lower(upper(a, b), c))
}

fn is_unseen(row: &[f32]) -> bool {
    row.iter().all(|d| d.is_nan())
}

/// The median of each three pixels side by side; NaN where one of them was not seen.
fn medians_along(row: &[f32], out: &mut [f32]) {
    for (value, beside) in out.iter_mut().zip(row.windows(3)) {
        let [a, b, c] = [beside[0], beside[1], beside[2]];
        *value = middle(a, b, c) + (a + b + c) * 0.0;
    }
}

/// Takes medians. Keeps its buffers: the sorted columns of three pixels, and how many of the three were seen.
#[derive(Debug, Clone, Default)]
pub(crate) struct Median {
    tuning: MedianTuning,
    low: Vec<f32>,
    middle: Vec<f32>,
    high: Vec<f32>,
    seen: Vec<f32>,
}

impl Median {
    /// Buffers that are still empty.
    pub(crate) fn new(tuning: MedianTuning) -> Self {
        Self {
            tuning,
            ..Self::default()
        }
    }

    /// Fills `target` with the 3x3 median of `source` (row by row, NaN where nothing was seen). A pixel that was not
    /// seen stays so; the outermost pixels are not seen.
    pub(crate) fn filter(&mut self, source: &[f32], width: usize, target: &mut [f32]) {
        target.fill(f32::NAN);
        let height = source.len() / width;
        if width < 3 {
            return;
        }
        for row in 1..height.saturating_sub(1) {
            let above = &source[(row - 1) * width..row * width];
            let here = &source[row * width..(row + 1) * width];
            let below = &source[(row + 1) * width..(row + 2) * width];
            if is_unseen(above) != is_unseen(below) {
                medians_along(here, &mut target[row * width + 1..(row + 1) * width - 1]);
                continue;
            }
            self.sort_columns(above, here, below);
            let out = &mut target[row * width + 1..(row + 1) * width - 1];
            self.medians_of_sorted(&here[1..], out);
        }
    }

    /// Sorts each column of three; what was not seen counts as farther than all.
    fn sort_columns(&mut self, above: &[f32], here: &[f32], below: &[f32]) {
        for buffer in [
            &mut self.low,
            &mut self.middle,
            &mut self.high,
            &mut self.seen,
        ] {
            buffer.resize(here.len(), 0.0);
        }
        let sorted = self
            .low
            .iter_mut()
            .zip(&mut self.middle)
            .zip(&mut self.high);
        let columns = above.iter().zip(here).zip(below);
        for ((sorted, seen), ((&a, &b), &c)) in sorted.zip(&mut self.seen).zip(columns) {
            let ((low, mid), high) = sorted;
            let [a, b, c] = [a, b, c].map(|d| if d.is_nan() { f32::INFINITY } else { d });
            *seen = one_if_seen(a) + one_if_seen(b) + one_if_seen(c);
            *low = lower(lower(a, b), c);
            *mid = middle(a, b, c);
            *high = upper(upper(a, b), c);
        }
    }

    /// The median of those that were seen among three columns. With the lows, middles and highs sorted, too, the third to
    /// the fifth of the nine can only be the largest two lows, the smaller two middles and the smallest high.
    fn medians_of_sorted(&self, here: &[f32], out: &mut [f32]) {
        let min_seen = self.tuning.min_seen as f32;
        let columns = self.low.windows(3).zip(self.middle.windows(3));
        let columns = columns.zip(self.high.windows(3)).zip(self.seen.windows(3));
        for ((value, &own), (((low, mid), high), seen)) in out.iter_mut().zip(here).zip(columns) {
            let largest_low = upper(upper(low[0], low[1]), low[2]);
            let middle_low = middle(low[0], low[1], low[2]);
            let smallest_middle = lower(lower(mid[0], mid[1]), mid[2]);
            let middle_middle = middle(mid[0], mid[1], mid[2]);
            let smallest_high = lower(lower(high[0], high[1]), high[2]);
            let (a, b) = (
                upper(middle_low, smallest_middle),
                lower(largest_low, smallest_high),
            );
            let third = lower(a, b);
            let fourth = lower(upper(a, b), middle_middle);
            let fifth = middle(largest_low, middle_middle, smallest_high);
            let seen = seen[0] + seen[1] + seen[2];
            let below = if seen > 8.0 {
                fifth
            } else if seen > 6.0 {
                fourth
            } else {
                third
            };
            let above = if seen > 7.0 {
                fifth
            } else if seen > 5.0 {
                fourth
            } else {
                third
            };
            let counts = seen >= min_seen && !own.is_nan();
            *value = if counts {
                0.5 * (below + above)
            } else {
                f32::NAN
            };
        }
    }
}

/// 1 for what was seen, 0 for what counts as farther than all.
const fn one_if_seen(d: f32) -> f32 {
    if d < f32::INFINITY { 1.0 } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn it_equals_the_middle_of_the_sorted_values(values in prop::array::uniform9(-10.0..10.0f32)) {
            let mut sorted = values;
            sorted.sort_by(f32::total_cmp);
            let mut target = vec![0.0; 9];
            Median::default().filter(&values, 3, &mut target);
            prop_assert_eq!(target[4], sorted[4]);
        }

        #[test]
        fn of_an_image_with_holes_every_median_is_that_of_the_seen(
            values in prop::collection::vec(prop::option::weighted(0.8, 1.0..9.0f32), 8 * 6),
        ) {
            let source: Vec<f32> = values.iter().map(|v| v.unwrap_or(f32::NAN)).collect();
            let mut target = vec![0.0; source.len()];
            Median::default().filter(&source, 8, &mut target);
            for row in 1..5 {
                for col in 1..7 {
                    let mut seen: Vec<f32> = (0..9)
                        .map(|i| source[(row + i / 3 - 1) * 8 + col + i % 3 - 1])
                        .filter(|v| !v.is_nan())
                        .collect();
                    seen.sort_by(f32::total_cmp);
                    let found = target[row * 8 + col];
                    if seen.len() < 5 || source[row * 8 + col].is_nan() {
                        prop_assert!(found.is_nan());
                    } else {
                        prop_assert_eq!(found, f32::midpoint(seen[(seen.len() - 1) / 2], seen[seen.len() / 2]));
                    }
                }
            }
        }
    }

    proptest! {
        #[test]
        fn a_slope_stays_what_it_is_up_to_the_border_of_what_is_seen(
            down in -0.5..0.5f32, across in -0.2..0.2f32, first in 0..3_usize, last in 6..9_usize,
        ) {
            let plane = |at: usize| 9.0 + down * (at / 8) as f32 + across * (at % 8) as f32;
            let seen = |at: usize| (first..=last).contains(&(at / 8));
            let source: Vec<f32> =
                (0..9 * 8).map(|at| if seen(at) { plane(at) } else { f32::NAN }).collect();
            let mut target = vec![0.0; source.len()];
            Median::default().filter(&source, 8, &mut target);
            for (at, &found) in target.iter().enumerate() {
                let inner = (1..8).contains(&(at / 8)) && (1..7).contains(&(at % 8));
                prop_assert_eq!(found.is_nan(), !(inner && seen(at)));
                prop_assert!(found.is_nan() || (found - plane(at)).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn a_lone_mismatch_vanishes_and_holes_stay_holes() {
        let mut source = vec![5.0_f32; 7 * 6];
        source[2 * 7 + 3] = 20.0;
        source[3 * 7 + 5] = f32::NAN;
        let mut target = vec![0.0; source.len()];
        Median::default().filter(&source, 7, &mut target);
        assert_eq!(target[2 * 7 + 3], 5.0);
        assert!(target[3 * 7 + 5].is_nan() && target[0].is_nan());
    }
}
