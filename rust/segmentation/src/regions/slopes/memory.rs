//! What the last frames told of a slope: one frame alone may be wrong.

use nalgebra::{Vector2, Vector3};

use super::tuning::SlopeMemoryTuning;

/// The slope that the last frames told of.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SlopeMemory {
    /// Gradient of the slope.
    pub(super) tilt: Vector2<f64>,
    /// What the frames told of it: by how much it was better than treads, in squared noise.
    pub(super) sure: f64,
}

impl SlopeMemory {
    /// Whether there is a slope for sure.
    pub(super) fn is_sure(&self, tuning: &SlopeMemoryTuning) -> bool {
        self.sure > tuning.sure
    }

    /// After a frame that does not show it.
    pub(super) fn faded(&self, tuning: &SlopeMemoryTuning) -> Self {
        Self {
            sure: (self.sure - tuning.fades).max(0.0),
            ..*self
        }
    }

    /// Whether a plane has the gradient of the slope.
    pub(super) fn is_of(&self, plane: &Vector3<f64>, tuning: &SlopeMemoryTuning) -> bool {
        (plane.xy() / plane.z - self.tilt).norm() < tuning.same_gradient
    }

    /// After a frame that shows a plane, so much better than treads; none: from too far away to tell.
    pub(super) fn told(
        &self,
        plane: &Vector3<f64>,
        better: Option<f64>,
        tuning: &SlopeMemoryTuning,
    ) -> Self {
        let tilt = plane.xy() / plane.z;
        let before = if self.is_of(plane, tuning) {
            self.sure
        } else {
            0.0
        };
        let Some(better) = better else {
            return Self { tilt, sure: before };
        };
        let is_steep = tilt.norm() > tuning.steep;
        let doubtful = if is_steep {
            tuning.doubtful_steep
        } else {
            tuning.doubtful
        };
        // What treads explain as well as a plane tells of stairs as surely as a frame can.
        let more = better.max(0.0) - doubtful;
        Self {
            tilt,
            sure: (before + more).clamp(0.0, tuning.most_sure),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a plane of this gradient is sure to be a slope after six frames that explain it so much better than treads.
    fn is_slope(gradient: f64, better: f64) -> bool {
        let plane = Vector3::new(gradient, 0.0, 1.0);
        let (mut memory, tuning) = (SlopeMemory::default(), SlopeMemoryTuning::default());
        for _ in 0..6 {
            memory = memory.told(&plane, Some(better), &tuning);
        }
        memory.is_sure(&tuning)
    }

    /// Figures of frames of 40 mm steps and of slopes of 15 degrees.
    #[test]
    fn what_is_steep_must_be_told_from_stairs_more_clearly() {
        assert!(is_slope(0.12, 7.0));
        assert!(!is_slope(0.25, 7.0));
        assert!(is_slope(0.25, 15.0));
    }

    #[test]
    fn treads_in_its_place_take_a_slope_back_within_four_frames_and_what_is_too_far_away_does_not()
    {
        let tuning = SlopeMemoryTuning::default();
        for gradient in [0.1, 0.3] {
            let plane = Vector3::new(gradient, 0.0, 1.0);
            let mut memory = SlopeMemory::default().told(&plane, Some(100.0), &tuning);
            for _ in 0..50 {
                memory = memory.told(&plane, None, &tuning);
            }
            assert!(memory.is_sure(&tuning));
            for _ in 0..4 {
                memory = memory.told(&plane, Some(-15.0), &tuning);
            }
            assert!(!memory.is_sure(&tuning));
        }
    }

    #[test]
    fn a_slope_is_forgotten_that_is_not_seen() {
        let plane = Vector3::new(0.12, 0.0, 1.0);
        let tuning = SlopeMemoryTuning::default();
        let mut memory = SlopeMemory::default().told(&plane, Some(100.0), &tuning);
        for _ in 0..59 {
            memory = memory.faded(&tuning);
        }
        assert!(memory.is_sure(&tuning));
        assert!(!memory.faded(&tuning).faded(&tuning).is_sure(&tuning));
    }
}
