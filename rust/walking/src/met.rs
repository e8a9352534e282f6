//! What a foot of a walk came upon.

use geometry::PlanarPose;

/// What a foot of a walk met.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Met {
    /// A point of it, and its direction from where the foot had stood.
    pub at: PlanarPose,
    /// It is at least so much higher than the ground that the foot left, m.
    pub height_m: f64,
    /// Half of the sole, across the way that it came, m.
    pub half_width_m: f64,
}

impl Met {
    /// What was met, in this frame of the plan.
    pub(crate) fn seen_from(self, frame: &PlanarPose) -> Self {
        Self {
            at: frame.relative(&self.at),
            ..self
        }
    }
}
