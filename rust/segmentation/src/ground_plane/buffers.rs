//! What is kept while the regions of a frame are described.

use std::ops::Range;

use nalgebra::Point2;

use crate::regions::{StepMarks, StepTuning};

/// Pixels of one region that lie side by side.
#[derive(Debug, Clone)]
pub(super) struct LabelRun {
    pub(super) label: u16,
    pub(super) row: usize,
    pub(super) cols: Range<usize>,
}

/// What is kept while regions are described.
#[derive(Debug, Clone, Default)]
pub(super) struct ProductBuffers {
    pub(super) runs: Vec<LabelRun>,
    pub(super) corners: Vec<Point2<f64>>,
    // By label: the number of the region in the product plus one, 0 for none; and its height, m, NaN for none.
    pub(super) floors: Vec<(u16, f32)>,
    pub(super) step_marks: StepMarks,
}

impl ProductBuffers {
    /// Buffers that are still empty.
    pub(super) fn new(steps: StepTuning) -> Self {
        Self {
            step_marks: StepMarks::new(steps),
            ..Self::default()
        }
    }
}
