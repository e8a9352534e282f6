//! A 3x3 median over the pixels that were seen: takes single mismatches out before anything is fitted.

/// Fewest pixels of the nine that must be seen for the middle one to count.
const MIN_SEEN: usize = 5;

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

fn median_of_seen(values: &[f32; 9]) -> f32 {
    let mut seen = [0.0_f32; 9];
    let mut count = 0;
    for &value in values {
        if value.is_nan() {
            continue;
        }
        let mut at = count;
        while at > 0 && seen[at - 1] > value {
            seen[at] = seen[at - 1];
            at -= 1;
        }
        seen[at] = value;
        count += 1;
    }
    if count < MIN_SEEN {
        f32::NAN
    } else {
        f32::midpoint(seen[(count - 1) / 2], seen[count / 2])
    }
}

/// Takes medians. Keeps its buffers: the sorted columns of three pixels.
#[derive(Debug, Clone, Default)]
pub(super) struct Median {
    low: Vec<f32>,
    middle: Vec<f32>,
    high: Vec<f32>,
}

impl Median {
    /// Fills `target` with the 3x3 median of `source` (row by row, NaN where nothing was seen). A pixel that was not
    /// seen stays so; the outermost pixels are not seen.
    pub(super) fn filter(&mut self, source: &[f32], width: usize, target: &mut [f32]) {
        target.fill(f32::NAN);
        let height = source.len() / width;
        if width < 3 {
            return;
        }
        for row in 1..height.saturating_sub(1) {
            let above = &source[(row - 1) * width..row * width];
            let here = &source[row * width..(row + 1) * width];
            let below = &source[(row + 1) * width..(row + 2) * width];
            self.sort_columns(above, here, below);
            let out = &mut target[row * width + 1..(row + 1) * width - 1];
            self.medians_of_sorted(out);
            for (col, value) in out.iter_mut().enumerate() {
                // The middle one of nine seen pixels, or NaN where one of the nine is NaN.
                if !value.is_nan() || here[col + 1].is_nan() {
                    continue;
                }
                let [a, b, c] =
                    [above, here, below].map(|line| [line[col], line[col + 1], line[col + 2]]);
                *value = median_of_seen(&[a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2]]);
            }
        }
    }

    /// Sorts each column of three; all three are NaN where one of them is.
    fn sort_columns(&mut self, above: &[f32], here: &[f32], below: &[f32]) {
        self.low.resize(here.len(), 0.0);
        self.middle.resize(here.len(), 0.0);
        self.high.resize(here.len(), 0.0);
        let sorted = self
            .low
            .iter_mut()
            .zip(&mut self.middle)
            .zip(&mut self.high);
        for (((low, mid), high), ((&a, &b), &c)) in sorted.zip(above.iter().zip(here).zip(below)) {
            // Zero, or NaN where one of the three is.
            let unseen = (a + b + c) * 0.0;
            *low = lower(lower(a, b), c) + unseen;
            *mid = middle(a, b, c) + unseen;
            *high = upper(upper(a, b), c) + unseen;
        }
    }

    /// The median of nine is the middle one of the largest low, the middle middle and the smallest high.
    fn medians_of_sorted(&self, out: &mut [f32]) {
        let windows = self
            .low
            .windows(3)
            .zip(self.middle.windows(3))
            .zip(self.high.windows(3));
        for (value, ((low, mid), high)) in out.iter_mut().zip(windows) {
            let unseen = (low[0] + low[1] + low[2]) * 0.0;
            *value = middle(
                upper(upper(low[0], low[1]), low[2]),
                middle(mid[0], mid[1], mid[2]),
                lower(lower(high[0], high[1]), high[2]),
            ) + unseen;
        }
    }
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
            prop_assert_eq!(median_of_seen(&values), sorted[4]);
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
                    if seen.len() < MIN_SEEN || source[row * 8 + col].is_nan() {
                        prop_assert!(found.is_nan());
                    } else {
                        prop_assert_eq!(found, f32::midpoint(seen[(seen.len() - 1) / 2], seen[seen.len() / 2]));
                    }
                }
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
