//! Pixels beside the edges of steps: they belong to neither of the two surfaces.

use std::ops::Range;

use settings::{POSITIVE, settings, within};

use crate::planes::Planes;

settings! {
    /// Which pixels lie so near to the edge of a step that they belong to neither surface.
    pub struct StepTuning("navigation.ground.tuning.steps") {
        /// Columns and rows to each side of an edge that the matching window spoils.
        spoiled: [usize; 2] = [2, 3], "1", within(0.0, 100.0);
        /// Most pixels of a riser, which belongs to no region, between two treads.
        riser: usize = 6, "1", within(0.0, 1000.0);
        /// Surfaces that are not further apart than this are one.
        least: f32 = 0.008, "m", POSITIVE;
        /// Surfaces that are further apart than this are no step.
        most: f32 = 0.15, "m", POSITIVE;
    }
    require (most) > (least);
}

/// Where a line of pixels last had a level surface, and how high, m.
#[derive(Debug, Clone, Copy)]
struct LastLevel {
    at: usize,
    height_m: f32,
}

impl LastLevel {
    /// Nothing yet: from no height is it a step to another.
    const NONE: Self = Self {
        at: 0,
        height_m: f32::NAN,
    };

    /// Whether a step lies between here and a place further along the line.
    fn is_step(self, to: Self, tuning: &StepTuning) -> bool {
        let apart_m = (to.height_m - self.height_m).abs();
        apart_m > tuning.least && apart_m < tuning.most && to.at - self.at <= tuning.riser + 1
    }

    /// The pixels of a line of `count` that a step from here to there spoils.
    fn spoiled(self, to: Self, reach: usize, count: usize) -> Range<usize> {
        (self.at + 1).saturating_sub(reach)..(to.at + reach).min(count)
    }
}

/// Pixels that are passed over together where no edge is near.
const CHUNK: usize = 16;

/// Marks pixels beside edges. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(crate) struct StepMarks {
    tuning: StepTuning,
    // The last level pixel of each column: its row, and its height, m.
    above: Vec<u32>,
    above_m: Vec<f32>,
}

impl StepMarks {
    /// Nothing seen yet.
    pub(crate) fn new(tuning: StepTuning) -> Self {
        Self {
            tuning,
            ..Self::default()
        }
    }

    /// Marks in `planes.at_step` the pixels beside edges, down the columns and along the rows.
    pub(crate) fn mark(&mut self, width: usize, planes: &mut Planes) {
        planes.at_step.fill(false);
        self.above.clear();
        self.above.resize(width, 0);
        // Nothing yet: from no height is it a step to another.
        self.above_m.clear();
        self.above_m.resize(width, f32::NAN);
        let Planes {
            floor_height_m,
            at_step,
            ..
        } = planes;
        for (row, heights_m) in floor_height_m.chunks_exact(width).enumerate() {
            let mut left = LastLevel::NONE;
            for (chunk, heights_m) in heights_m.chunks(CHUNK).enumerate() {
                let first = chunk * CHUNK;
                let cols = first..first + heights_m.len();
                let above_m = &self.above_m[cols.clone()];
                // All bits where the height is not the one to the left and above: no branch, so that many are looked at at once.
                let differs = heights_m.iter().zip(above_m).fold(0, |all, (here, above)| {
                    let [here, above, left] = [here, above, &left.height_m].map(|m| m.to_bits());
                    all | (here ^ above) | (here ^ left)
                });
                if differs == 0 && !left.height_m.is_nan() {
                    left.at = cols.end - 1;
                    self.above[cols].fill(row as u32);
                    continue;
                }
                if !heights_m.iter().fold(false, |any, m| any | !m.is_nan()) {
                    continue;
                }
                for (col, &height_m) in cols.zip(heights_m) {
                    if !height_m.is_nan() {
                        self.mark_beside([col, row], height_m, &mut left, width, at_step);
                    }
                }
            }
        }
    }

    /// Marks what the edges to the left of a level pixel and above it spoil.
    fn mark_beside(
        &mut self,
        [col, row]: [usize; 2],
        height_m: f32,
        left: &mut LastLevel,
        width: usize,
        at_step: &mut [bool],
    ) {
        let tuning = &self.tuning;
        let [spoiled_cols, spoiled_rows] = tuning.spoiled;
        let height = at_step.len() / width;
        let from_left = LastLevel { at: col, height_m };
        let from_above = LastLevel { at: row, height_m };
        let above = LastLevel {
            at: self.above[col] as usize,
            height_m: self.above_m[col],
        };
        if left.is_step(from_left, tuning) {
            let cols = left.spoiled(from_left, spoiled_cols, width);
            at_step[row * width..][cols].fill(true);
        }
        *left = from_left;
        if above.is_step(from_above, tuning) {
            for row in above.spoiled(from_above, spoiled_rows, height) {
                at_step[row * width + col] = true;
            }
        }
        (self.above[col], self.above_m[col]) = (row as u32, height_m);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One column of pixels with these heights, m.
    fn marked(heights_m: &[f32]) -> Vec<bool> {
        let mut planes = Planes::new(heights_m.len());
        planes.floor_height_m = heights_m.to_vec();
        planes.labels = vec![1; heights_m.len()];
        StepMarks::default().mark(1, &mut planes);
        planes.at_step
    }

    #[test]
    fn three_pixels_on_both_sides_of_an_edge_and_the_riser_between_are_left_out() {
        let nan = f32::NAN;
        let expected: Vec<_> = (0..18).map(|i| (5..13).contains(&i)).collect();
        for upper_m in [0.06, 0.15] {
            let mut heights = vec![upper_m; 8];
            heights.extend([nan, nan]);
            heights.extend([0.03; 8]);
            assert_eq!(marked(&heights), expected);
        }
    }

    #[test]
    fn pieces_of_one_surface_and_tall_boxes_have_no_steps() {
        for other_m in [0.004, 0.2, f32::NAN] {
            let mut heights = vec![0.0; 8];
            heights.extend([other_m; 8]);
            assert!(marked(&heights).iter().all(|&at| !at));
        }
    }
}
