//! What the last frames told of a slope: one frame alone may be wrong.

use nalgebra::{Vector2, Vector3};

use super::tuning::SlopeMemoryTuning;

/// The slope that the last frames told of.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Memory {
    /// Its gradient.
    pub(super) tilt: Vector2<f64>,
    /// By how much it was better than treads, in squared noise.
    pub(super) sure: f64,
}

impl Memory {
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

    /// After a frame that shows a plane, so much better than treads.
    pub(super) fn told(
        &self,
        plane: &Vector3<f64>,
        better: f64,
        tuning: &SlopeMemoryTuning,
    ) -> Self {
        let tilt = plane.xy() / plane.z;
        let is_same = (tilt - self.tilt).norm() < tuning.same_gradient;
        let before = if is_same { self.sure } else { 0.0 };
        let is_steep = tilt.norm() > tuning.steep;
        let doubtful = if is_steep {
            tuning.doubtful_steep
        } else {
            tuning.doubtful
        };
        Self {
            tilt,
            sure: (before + better - doubtful).min(tuning.most_sure),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a plane of this gradient is sure to be a slope after six frames that explain it so much better than treads.
    fn is_slope(gradient: f64, better: f64) -> bool {
        let plane = Vector3::new(gradient, 0.0, 1.0);
        let (mut memory, tuning) = (Memory::default(), SlopeMemoryTuning::default());
        for _ in 0..6 {
            memory = memory.told(&plane, better, &tuning);
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
    fn a_slope_is_forgotten_that_is_not_seen() {
        let plane = Vector3::new(0.12, 0.0, 1.0);
        let tuning = SlopeMemoryTuning::default();
        let mut memory = Memory::default().told(&plane, 100.0, &tuning);
        for _ in 0..59 {
            memory = memory.faded(&tuning);
        }
        assert!(memory.is_sure(&tuning));
        assert!(!memory.faded(&tuning).faded(&tuning).is_sure(&tuning));
    }
}
