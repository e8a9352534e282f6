//! What the last frames told of a slope: one frame alone may be wrong.

use nalgebra::{Vector2, Vector3};

/// By how much a slope explains its pixels better than treads do, in squared noise: what is more than this tells of a slope, what is less of
/// stairs. The frames' sum must reach so much, and is kept up to so much.
const DOUBTFUL: f64 = 4.0;
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
        Self {
            tilt,
            sure: (before + better - DOUBTFUL).min(MOST_SURE),
        }
    }
}
