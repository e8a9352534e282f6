//! Takes the border off regions: there the matching window saw two surfaces at once.

use crate::picture::labels::MAX_REGIONS;

/// Lowest and highest label that a pixel stands for. Of one that says nothing (not seen, or a hole inside one region): none.
/// A byte holds every label, and processors compare many bytes at once.
const NEUTRAL: (u8, u8) = (u8::MAX, 0);
/// And of a seen pixel without a region: all.
const MIXED: (u8, u8) = (0, u8::MAX);
const _: () = assert!(MAX_REGIONS < u8::MAX as usize, "labels are bytes here");
/// Pixels that are searched for holes together.
const CHUNK: usize = 32;

/// Erodes label images. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(crate) struct Erosion {
    lowest: WindowExtreme,
    highest: WindowExtreme,
}

/// How images are kept so that no window of `COLS` columns and `ROWS` rows reaches beyond them: with a margin that says nothing.
#[derive(Debug, Clone, Copy)]
struct Margin<const COLS: usize, const ROWS: usize> {
    width: usize,
    height: usize,
}

impl<const COLS: usize, const ROWS: usize> Margin<COLS, ROWS> {
    /// From row to row. The margin behind a row is that before the next one.
    const fn stride(self) -> usize {
        self.width + COLS / 2
    }

    /// Pixels with the margin.
    const fn len(self) -> usize {
        (self.height + 2 * (ROWS / 2)) * self.stride() + COLS - 1
    }

    /// Where a row begins.
    const fn row(self, row: usize) -> usize {
        (row + ROWS / 2) * self.stride() + COLS / 2
    }
}

impl Erosion {
    /// Fills `eroded` with the labels of those pixels whose window of `COLS` columns and `ROWS` rows, both odd, holds no other
    /// region and no seen pixel without one; 0 elsewhere. Pixels that were not seen do not count.
    pub(crate) fn erode<const COLS: usize, const ROWS: usize>(
        &mut self,
        labels: &[u16],
        disparity_px: &[f32],
        width: usize,
        eroded: &mut [u16],
    ) {
        let height = labels.len() / width;
        let margin = Margin::<COLS, ROWS> { width, height };
        self.mark(labels, disparity_px, margin);
        self.lowest.spread(margin, u8::min);
        self.highest.spread(margin, u8::max);
        let [lowest, highest] =
            [&self.lowest, &self.highest].map(|extreme| extreme.over_both.chunks(margin.stride()));
        let windows = lowest.zip(highest);
        let lines = eroded
            .chunks_exact_mut(width)
            .zip(labels.chunks_exact(width));
        for ((out, labels), (lowest, highest)) in lines.zip(windows) {
            let windows = lowest.iter().zip(highest);
            for ((out, &label), (&low, &high)) in out.iter_mut().zip(labels).zip(windows) {
                let own = label as u8;
                *out = if low == own && high == own { label } else { 0 };
            }
        }
    }

    /// Marks what each pixel stands for.
    fn mark<const COLS: usize, const ROWS: usize>(
        &mut self,
        labels: &[u16],
        disparity_px: &[f32],
        margin: Margin<COLS, ROWS>,
    ) {
        self.lowest.clear(margin.len(), NEUTRAL.0);
        self.highest.clear(margin.len(), NEUTRAL.1);
        let width = margin.width;
        let lines = labels
            .chunks_exact(width)
            .zip(disparity_px.chunks_exact(width));
        for (row, (line, disparity_px)) in lines.enumerate() {
            let at = margin.row(row);
            let lowest = &mut self.lowest.marks[at..at + width];
            let highest = &mut self.highest.marks[at..at + width];
            let marks = lowest.iter_mut().zip(highest.iter_mut());
            for ((low, high), (&label, &d)) in marks.zip(line.iter().zip(disparity_px)) {
                let none = if d.is_nan() { NEUTRAL } else { MIXED };
                let own = label as u8;
                *low = if label > 0 { own } else { none.0 };
                *high = if label > 0 { own } else { none.1 };
            }
            let chunks = lowest.chunks_mut(CHUNK).zip(highest.chunks_mut(CHUNK));
            for (index, (lowest, highest)) in chunks.enumerate() {
                // No mark is lower, so that most chunks are seen to have none.
                if lowest.iter().copied().min() != Some(MIXED.0) {
                    continue;
                }
                for (i, (low, high)) in lowest.iter_mut().zip(highest).enumerate() {
                    if *low == MIXED.0 && is_hole(labels, width, row * width + index * CHUNK + i) {
                        (*low, *high) = NEUTRAL;
                    }
                }
            }
        }
    }
}

/// The lowest or the highest mark in a window around each pixel: first along the rows, then along the columns.
#[derive(Debug, Clone, Default)]
struct WindowExtreme {
    marks: Vec<u8>,
    over_cols: Vec<u8>,
    over_both: Vec<u8>,
}

impl WindowExtreme {
    fn clear(&mut self, count: usize, mark: u8) {
        self.marks.clear();
        self.marks.resize(count, mark);
    }

    fn spread<const COLS: usize, const ROWS: usize>(
        &mut self,
        margin: Margin<COLS, ROWS>,
        pick: impl Fn(u8, u8) -> u8,
    ) {
        self.over_cols.resize(margin.len() + 1 - COLS, 0);
        pick_of::<COLS>(&self.marks, 1, &mut self.over_cols, &pick);
        self.over_both.resize(margin.height * margin.stride(), 0);
        pick_of::<ROWS>(&self.over_cols, margin.stride(), &mut self.over_both, &pick);
    }
}

/// Picks among `N` values, `step` from each other, from each place on.
fn pick_of<const N: usize>(
    values: &[u8],
    step: usize,
    out: &mut [u8],
    pick: &impl Fn(u8, u8) -> u8,
) {
    let count = out.len();
    let lines: [&[u8]; N] = std::array::from_fn(|k| &values[k * step..k * step + count]);
    for (i, out) in out.iter_mut().enumerate() {
        *out = lines[1..]
            .iter()
            .fold(lines[0][i], |picked, line| pick(picked, line[i]));
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

/// Gives back to `eroded` the whole of those regions whose labels are wanted.
pub(crate) fn keep_where(labels: &[u16], eroded: &mut [u16], wanted: &[bool; MAX_REGIONS + 1]) {
    for (eroded, &label) in eroded.iter_mut().zip(labels) {
        if wanted[usize::from(label)] {
            *eroded = label;
        }
    }
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
            Erosion::default().erode::<5, 7>(&labels, &disparity, 20, &mut eroded);
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
        Erosion::default().erode::<5, 7>(&labels, &disparity, 20, &mut eroded);
        assert_eq!(eroded, labels);
    }
}
