//! Takes the border off regions: there the matching window saw two surfaces at once.

/// Value of pixels that say nothing: not seen, or a hole inside one region.
const NEUTRAL: u16 = 0;
/// Value of windows that hold more than one region, or a seen pixel of none.
const MIXED: u16 = u16::MAX;

const fn both(a: u16, b: u16) -> u16 {
    if a == b || b == NEUTRAL {
        a
    } else if a == NEUTRAL {
        b
    } else {
        MIXED
    }
}

/// Erodes label images. Keeps its buffer.
#[derive(Debug, Clone, Default)]
pub(super) struct Erosion {
    marks: Vec<u16>,
    over_cols: Vec<u16>,
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
        let height = labels.len() / width;
        self.marks.clear();
        self.marks.extend((0..labels.len()).map(|at| {
            if labels[at] > 0 {
                labels[at]
            } else if disparity_px[at].is_nan() || is_hole(labels, width, at) {
                NEUTRAL
            } else {
                MIXED
            }
        }));
        self.over_cols.clear();
        self.over_cols.extend_from_slice(&self.marks);
        for step in 1..=reach.0 {
            for row in 0..height {
                let line = row * width..(row + 1) * width;
                let (out, marks) = (&mut self.over_cols[line.clone()], &self.marks[line]);
                for (out, &mark) in out.iter_mut().zip(&marks[step.min(width)..]) {
                    *out = both(*out, mark);
                }
                for (out, &mark) in out.iter_mut().skip(step).zip(marks) {
                    *out = both(*out, mark);
                }
            }
        }
        eroded.copy_from_slice(&self.over_cols);
        for step in 1..=reach.1 {
            let shift = (step * width).min(labels.len());
            for (out, &mark) in eroded.iter_mut().zip(&self.over_cols[shift..]) {
                *out = both(*out, mark);
            }
            for (out, &mark) in eroded.iter_mut().skip(shift).zip(&self.over_cols) {
                *out = both(*out, mark);
            }
        }
        for (out, &label) in eroded.iter_mut().zip(labels) {
            if *out != label {
                *out = 0;
            }
        }
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
