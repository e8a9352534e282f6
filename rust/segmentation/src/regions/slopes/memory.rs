//! What the last frames told of a slope: one frame alone may be wrong.

use nalgebra::{Vector2, Vector3};

/// By how much a slope explains its pixels better than treads do, in squared noise: what is more than this tells of a slope, what is less of
/// stairs. The frames' sum must reach so much, and is kept up to so much.
const DOUBTFUL: f64 = 4.0;
/// The same above this gradient: there the treads of stairs are narrow, and from afar a plane explains them by up to 8 better (slopes
/// are told by 9 to 30).
const DOUBTFUL_STEEP: f64 = 9.0;
const STEEP: f64 = 0.2;
const SURE: f64 = 4.0;
const MOST_SURE: f64 = 16.0;
/// What a frame without it takes from that.
const FADES: f64 = 0.2;
/// Slopes of two frames whose tilts differ by less than this are one.
const SAME_TILT: f64 = 0.06;

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
    pub(super) fn is_sure(&self) -> bool {
        self.sure > SURE
    }

    /// After a frame that does not show it.
    pub(super) fn faded(&self) -> Self {
        Self {
            sure: (self.sure - FADES).max(0.0),
            ..*self
        }
    }

    /// After a frame that shows a plane, so much better than treads.
    pub(super) fn told(&self, plane: &Vector3<f64>, better: f64) -> Self {
        let tilt = plane.xy() / plane.z;
        let is_same = (tilt - self.tilt).norm() < SAME_TILT;
        let before = if is_same { self.sure } else { 0.0 };
        let is_steep = tilt.norm() > STEEP;
        let doubtful = if is_steep { DOUBTFUL_STEEP } else { DOUBTFUL };
        Self {
            tilt,
            sure: (before + better - doubtful).min(MOST_SURE),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a plane of this gradient is sure to be a slope after six frames that explain it so much better than treads.
    fn is_slope(gradient: f64, better: f64) -> bool {
        let plane = Vector3::new(gradient, 0.0, 1.0);
        let mut memory = Memory::default();
        for _ in 0..6 {
            memory = memory.told(&plane, better);
        }
        memory.is_sure()
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
        let mut memory = Memory::default().told(&plane, 100.0);
        for _ in 0..59 {
            memory = memory.faded();
        }
        assert!(memory.is_sure());
        assert!(!memory.faded().faded().is_sure());
    }
}
