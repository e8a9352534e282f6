//! Takes the border off regions: there the matching window saw two surfaces at once.

use crate::{picture::labels::MAX_REGIONS, picture::pixels::Picture};

/// Lowest and highest label of a pixel that stands for none: it was not seen, or is a hole inside one region.
/// A byte holds every label, and processors compare many bytes at once.
const NEUTRAL: (u8, u8) = (u8::MAX, 0);
/// Lowest and highest label of a seen pixel without a region: it stands for all.
const MIXED: (u8, u8) = (0, u8::MAX);
const _: () = assert!(MAX_REGIONS < u8::MAX as usize, "labels are bytes here");
/// Pixels that are searched for holes together.
const CHUNK: usize = 32;

/// Erodes label images. Keeps its buffers.
#[derive(Debug, Clone)]
pub(crate) struct Erosion {
    // So many neighbours of one region make a hole of a pixel without one.
    hole: usize,
    lowest: WindowExtreme,
    highest: WindowExtreme,
}

/// How images are kept so that no window around a pixel reaches beyond them: with a margin that says nothing.
#[derive(Debug, Clone, Copy)]
struct Margin {
    width: usize,
    height: usize,
    /// Columns and rows of a window to each side of its middle.
    reach: [usize; 2],
}

impl Margin {
    /// From row to row. The margin behind a row is that before the next one.
    const fn stride(self) -> usize {
        self.width + self.reach[0]
    }

    /// Pixels with the margin.
    const fn len(self) -> usize {
        (self.height + 2 * self.reach[1]) * self.stride() + 2 * self.reach[0]
    }

    /// Where a row begins.
    const fn row(self, row: usize) -> usize {
        (row + self.reach[1]) * self.stride() + self.reach[0]
    }
}

impl Erosion {
    /// Empty buffers; a pixel without a region is a hole in the one that `hole` of its eight neighbours or more belong to.
    pub(crate) fn new(hole: usize) -> Self {
        Self {
            hole,
            lowest: WindowExtreme::default(),
            highest: WindowExtreme::default(),
        }
    }

    /// Fills `eroded` with the labels of those pixels that have no other region and no seen pixel without one as many columns and
    /// rows to each side as `reach` says; 0 elsewhere. Pixels that were not seen do not count.
    pub(crate) fn erode(
        &mut self,
        labels: &[u16],
        picture: Picture<'_>,
        reach: [usize; 2],
        eroded: &mut [u16],
    ) {
        let width = picture.width;
        let height = labels.len() / width;
        let margin = Margin {
            width,
            height,
            reach,
        };
        self.mark(labels, picture.disparity_px, margin);
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
    fn mark(&mut self, labels: &[u16], disparity_px: &[f32], margin: Margin) {
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
            if row == 0 || row + 1 == margin.height {
                continue; // no hole lies at the image's border
            }
            let around = &labels[(row - 1) * width..(row + 2) * width];
            let chunks = lowest.chunks_mut(CHUNK).zip(highest.chunks_mut(CHUNK));
            for (index, (lowest, highest)) in chunks.enumerate() {
                // No mark is lower, so that most chunks are seen to have none.
                if lowest.iter().copied().min() != Some(MIXED.0) {
                    continue;
                }
                for (i, (low, high)) in lowest.iter_mut().zip(highest).enumerate() {
                    if *low == MIXED.0 && is_hole(around, width, index * CHUNK + i, self.hole) {
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

    fn spread(&mut self, margin: Margin, pick: impl Fn(u8, u8) -> u8) {
        let [cols, rows] = margin.reach.map(|reach| 2 * reach + 1);
        self.over_cols.resize(margin.len() + 1 - cols, 0);
        pick_among(cols, &self.marks, 1, &mut self.over_cols, &pick);
        self.over_both.resize(margin.height * margin.stride(), 0);
        let stride = margin.stride();
        pick_among(rows, &self.over_cols, stride, &mut self.over_both, &pick);
    }
}

/// Picks among `count` values, `step` from each other, from each place on.
fn pick_among(
    count: usize,
    values: &[u8],
    step: usize,
    out: &mut [u8],
    pick: &impl Fn(u8, u8) -> u8,
) {
    let len = out.len();
    out.copy_from_slice(&values[..len]);
    for k in 1..count {
        for (out, &value) in out.iter_mut().zip(&values[k * step..k * step + len]) {
            *out = pick(*out, value);
        }
    }
}

/// Whether the pixel without a region in this column of the middle one of three rows is a lone miss: `most` of its eight neighbours
/// or more have one and the same region.
fn is_hole(rows: &[u16], width: usize, col: usize, most: usize) -> bool {
    if col == 0 || col + 1 >= width {
        return false;
    }
    let [above, here, below] = [0, width, 2 * width].map(|row| &rows[row + col - 1..row + col + 2]);
    let label = here[0].max(here[2]);
    let neighbours = [
        above[0], above[1], above[2], here[0], here[2], below[0], below[1], below[2],
    ];
    label > 0 && neighbours.iter().filter(|&&n| n == label).count() >= most
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

    fn picture(disparity_px: &[f32]) -> Picture<'_> {
        Picture {
            width: 20,
            disparity_px,
            g: disparity_px,
            sigma_px: disparity_px,
            finer: 1,
        }
    }

    proptest! {
        #[test]
        fn what_is_left_has_only_its_own_label_around_it(labels in prop::collection::vec(1..3u16, 20 * 14)) {
            let disparity = vec![5.0; labels.len()];
            let mut eroded = vec![0; labels.len()];
            Erosion::new(5).erode(&labels, picture(&disparity), [2, 3], &mut eroded);
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
        Erosion::new(5).erode(&labels, picture(&disparity), [2, 3], &mut eroded);
        assert_eq!(eroded, labels);
    }
}
