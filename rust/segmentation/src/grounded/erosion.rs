//! Takes the border off regions: there the matching window saw two surfaces at once.

/// Lowest and highest label that a pixel stands for. Of one that says nothing (not seen, or a hole inside one region): none.
const NEUTRAL: (i16, i16) = (i16::MAX, 0);
/// And of a seen pixel without a region: all.
const MIXED: (i16, i16) = (0, i16::MAX);
/// Pixels that are searched for holes together.
const CHUNK: usize = 32;

/// Erodes label images. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct Erosion {
    lowest: WindowExtreme,
    highest: WindowExtreme,
}

impl Erosion {
    /// Fills `eroded` with the labels of those pixels whose window of 2 `reach.1` + 1 rows and 2 `reach.0` + 1 columns
    /// holds no other region and no seen pixel without one; 0 elsewhere. Pixels that were not seen do not count.
    pub(super) fn erode(
        &mut self,
        labels: &[u16],
        disparity_px: &[f32],
        width: usize,
        reach: (usize, usize),
        eroded: &mut [u16],
    ) {
        self.mark(labels, disparity_px, width);
        self.lowest.spread(width, reach, i16::min);
        self.highest.spread(width, reach, i16::max);
        let windows = self.lowest.over_both.iter().zip(&self.highest.over_both);
        for ((out, &label), (&low, &high)) in eroded.iter_mut().zip(labels).zip(windows) {
            let own = label.cast_signed();
            *out = if low == own && high == own { label } else { 0 };
        }
    }

    /// Marks what each pixel stands for.
    fn mark(&mut self, labels: &[u16], disparity_px: &[f32], width: usize) {
        self.lowest.marks.clear();
        self.highest.marks.clear();
        let pixels = || labels.iter().zip(disparity_px);
        let mark = |label: u16, d: f32, (neutral, mixed): (i16, i16)| {
            let none = if d.is_nan() { neutral } else { mixed };
            if label > 0 { label.cast_signed() } else { none }
        };
        let low = pixels().map(|(&label, &d)| mark(label, d, (NEUTRAL.0, MIXED.0)));
        self.lowest.marks.extend(low);
        let high = pixels().map(|(&label, &d)| mark(label, d, (NEUTRAL.1, MIXED.1)));
        self.highest.marks.extend(high);
        for first in (0..labels.len()).step_by(CHUNK) {
            let chunk = first..(first + CHUNK).min(labels.len());
            // Marks are not negative, so that most chunks are seen to have none.
            let lowest = self.lowest.marks[chunk.clone()].iter().copied().min();
            if lowest != Some(MIXED.0) {
                continue;
            }
            for at in chunk {
                if self.lowest.marks[at] == MIXED.0 && is_hole(labels, width, at) {
                    (self.lowest.marks[at], self.highest.marks[at]) = NEUTRAL;
                }
            }
        }
    }
}

/// The lowest or the highest mark in a window around each pixel: first along the rows, then along the columns.
#[derive(Debug, Clone, Default)]
struct WindowExtreme {
    marks: Vec<i16>,
    over_cols: Vec<i16>,
    over_both: Vec<i16>,
}

impl WindowExtreme {
    fn spread(&mut self, width: usize, reach: (usize, usize), pick: impl Fn(i16, i16) -> i16) {
        self.over_cols.clone_from(&self.marks);
        let rows = self.over_cols.chunks_exact_mut(width);
        for (out, marks) in rows.zip(self.marks.chunks_exact(width)) {
            for step in 1..=reach.0.min(width) {
                pick_shifted(out, marks, step, &pick);
            }
        }
        self.over_both.clone_from(&self.over_cols);
        for step in 1..=reach.1 {
            let shift = (step * width).min(self.over_cols.len());
            pick_shifted(&mut self.over_both, &self.over_cols, shift, &pick);
        }
    }
}

/// Picks between each value and those of `marks` that lie `shift` before and behind it.
fn pick_shifted(out: &mut [i16], marks: &[i16], shift: usize, pick: &impl Fn(i16, i16) -> i16) {
    for (out, &mark) in out.iter_mut().zip(&marks[shift..]) {
        *out = pick(*out, mark);
    }
    for (out, &mark) in out[shift..].iter_mut().zip(marks) {
        *out = pick(*out, mark);
    }
}

/// Whether a pixel without a region is a lone miss: most of its eight neighbours have one and the same region.
fn is_hole(labels: &[u16], width: usize, at: usize) -> bool {
    let col = at % width;
    if col == 0 || col + 1 == width || at < width || at + width >= labels.len() {
        return false;
    }
    let label = labels[at - 1].max(labels[at + 1]);
    let neighbours = [
        at - width - 1,
        at - width,
        at - width + 1,
        at - 1,
        at + 1,
        at + width - 1,
        at + width,
        at + width + 1,
    ];
    label > 0 && neighbours.iter().filter(|&&n| labels[n] == label).count() >= 5
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn what_is_left_has_only_its_own_label_around_it(labels in prop::collection::vec(1..3u16, 20 * 14)) {
            let disparity = vec![5.0; labels.len()];
            let mut eroded = vec![0; labels.len()];
            Erosion::default().erode(&labels, &disparity, 20, (2, 3), &mut eroded);
            for row in 0..14_i32 {
                for col in 0..20_i32 {
                    let own = labels[(row * 20 + col) as usize];
                    let pure = (-3..=3).all(|dr| (-2..=2).all(|dc| {
                        let (r, c) = (row + dr, col + dc);
                        !(0..14).contains(&r) || !(0..20).contains(&c) || labels[(r * 20 + c) as usize] == own
                    }));
                    prop_assert_eq!(eroded[(row * 20 + col) as usize], if pure { own } else { 0 });
                }
            }
        }
    }

    #[test]
    fn unseen_pixels_take_nothing_away() {
        let labels: Vec<u16> = (0..200).map(|i| u16::from(i % 7 != 0)).collect();
        let disparity: Vec<f32> = labels
            .iter()
            .map(|&label| if label == 0 { f32::NAN } else { 4.0 })
            .collect();
        let mut eroded = vec![0; 200];
        Erosion::default().erode(&labels, &disparity, 20, (2, 3), &mut eroded);
        assert_eq!(eroded, labels);
    }
}
