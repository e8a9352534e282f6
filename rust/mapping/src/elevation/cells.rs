//! What is kept of a cell, and how a frame changes it.

use super::{CellMeasurement, HeightEstimate};

/// What is known of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct HeightCell {
    /// Height of its surface; NaN where nothing was seen.
    pub estimate: HeightEstimate,
    /// Frames that saw it, saturating.
    pub frames: u16,
    /// Frames in a row that saw something else, lower than it.
    lower: u8,
    /// Frames in a row of which sight lines passed below it.
    passed: u8,
}

/// When a height is given up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Revision {
    /// Heights further apart than so many standard deviations of both are of two surfaces.
    pub gate: f32,
    /// Frames in a row that must contradict a height before it is given up.
    pub patience: u8,
    /// Room above a surface, m, with which what is above it is another thing that does not count; infinite: all counts.
    pub gap_m: f32,
}

impl HeightCell {
    /// Nothing was seen.
    pub(crate) const UNKNOWN: Self = Self {
        estimate: HeightEstimate {
            height_m: f32::NAN,
            variance_m2: f32::INFINITY,
        },
        frames: 0,
        lower: 0,
        passed: 0,
    };

    /// The cell where something was seen.
    #[inline]
    pub(crate) fn known(&self) -> Option<&Self> {
        (self.frames > 0).then_some(self)
    }

    /// Takes in what a frame measured. Of the same surface it is fused; a higher one takes its place at once, since a cell at an edge
    /// has the height of what is above; a lower one once nothing else has been seen for a while. With a gap between them the lower one counts
    /// at once.
    pub(crate) fn measure(&mut self, measured: &CellMeasurement, revision: Revision) {
        let surface = measured.surface;
        if self.frames > 0 && measured.low_m - self.estimate.height_m > revision.gap_m {
            return;
        }
        self.passed = 0;
        if self.frames == 0 || self.estimate.height_m - surface.height_m > revision.gap_m {
            (self.estimate, self.frames, self.lower) = (surface, 1, 0);
            return;
        }
        let same = self.estimate.innovation_squared(surface) <= revision.gate * revision.gate;
        if same {
            self.estimate = self.estimate.fused(surface);
            self.frames = self.frames.saturating_add(1);
            self.lower = 0;
        } else if surface.height_m > self.estimate.height_m {
            (self.estimate, self.frames, self.lower) = (surface, 1, 0);
        } else {
            self.lower += 1;
            if self.lower >= revision.patience {
                (self.estimate, self.frames, self.lower) = (surface, 1, 0);
            }
        }
    }

    /// Takes in that it reaches this high at least: of what is seen from below the surface is not known.
    pub(crate) fn raise(&mut self, least: HeightEstimate) {
        (self.estimate, self.frames, self.lower, self.passed) = (least, 0, 0, 0);
    }

    /// Takes in that a frame's sight lines passed over the cell, the lowest of them at this height, m, as sure as a variance, m², says;
    /// whether the height that was known is given up.
    pub(crate) fn pass(&mut self, bound_m: f32, variance_m2: f32, revision: Revision) -> bool {
        let least_m = revision.gate * (self.estimate.variance_m2 + variance_m2).sqrt();
        self.estimate.height_m - bound_m > least_m && self.contradict(revision)
    }

    /// Takes in that a frame contradicts the height; whether it is given up.
    pub(crate) fn contradict(&mut self, revision: Revision) -> bool {
        self.passed += 1;
        let given_up = self.passed >= revision.patience;
        if given_up {
            *self = Self::UNKNOWN;
        }
        given_up
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const REVISION: Revision = Revision {
        gate: 3.0,
        patience: 3,
        gap_m: f32::INFINITY,
    };

    fn seen(height_m: f32) -> CellMeasurement {
        CellMeasurement {
            cell: 0,
            surface: HeightEstimate {
                height_m,
                variance_m2: 1e-4,
            },
            low_m: height_m,
            points: 1,
        }
    }

    fn height_after(heights_m: &[f32]) -> f32 {
        height_with(heights_m, REVISION)
    }

    fn height_with(heights_m: &[f32], revision: Revision) -> f32 {
        let mut cell = HeightCell::UNKNOWN;
        for &height_m in heights_m {
            cell.measure(&seen(height_m), revision);
        }
        cell.estimate.height_m
    }

    #[test]
    fn with_a_gap_what_is_lower_counts_whichever_was_seen_first() {
        let revision = Revision {
            gap_m: 0.6,
            ..REVISION
        };
        assert_eq!(height_with(&[0.0, 0.7, 0.7], revision), 0.0);
        assert_eq!(height_with(&[0.7, 0.0], revision), 0.0);
        assert_eq!(height_with(&[0.0, 0.5], revision), 0.5);
    }

    #[test]
    fn a_cell_at_an_edge_jumps_up_at_once_and_down_when_nothing_else_is_seen() {
        assert!((height_after(&[0.0, 0.01]) - 0.005).abs() < 1e-6);
        assert_eq!(height_after(&[0.0, 0.2]), 0.2);
        assert_eq!(height_after(&[0.2, 0.0, 0.0]), 0.2);
        assert_eq!(height_after(&[0.2, 0.0, 0.0, 0.0]), 0.0);
        assert!((height_after(&[0.2, 0.0, 0.0, 0.2, 0.0, 0.0]) - 0.2).abs() < 1e-6);
    }

    #[test]
    fn what_sight_lines_pass_below_is_given_up_and_what_they_pass_above_is_not() {
        let mut cell = HeightCell::UNKNOWN;
        cell.measure(&seen(0.3), REVISION);
        for _ in 0..10 {
            assert!(!cell.pass(0.29, 1e-6, REVISION));
        }
        assert!(!cell.pass(0.1, 1e-6, REVISION));
        assert!(!cell.pass(0.1, 1e-6, REVISION));
        assert!(cell.pass(0.1, 1e-6, REVISION));
        assert_eq!(cell.known(), None);
    }
}
