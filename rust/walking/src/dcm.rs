//! The divergent component of motion (DCM) for a plan of the zero moment point (ZMP), backwards from its end.
//!
//! Englsberger, Ott, Albu-Schaeffer, "Three-dimensional bipedal walking control based on divergent component of motion",
//! IEEE T-RO 31 (2015). With the linear inverted pendulum c'' = w^2 (c - p) the DCM xi = c + c'/w obeys xi' = w (xi - p) (their
//! equation 8 on level ground), which is unstable forwards and hence stable backwards.

use nalgebra::Vector2;

/// A part of the plan in which the ZMP moves evenly from one point to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// ZMP at its beginning, m.
    pub from: Vector2<f64>,
    /// ZMP at its end, m.
    pub to: Vector2<f64>,
    /// How long it takes, s.
    pub duration_s: f64,
}

impl Segment {
    /// The DCM at its beginning if the one at its end is `end_dcm`: xi(0) = p(0) + p'/w + e^(-wT) (xi(T) - p(T) - p'/w).
    pub fn start_dcm(&self, end_dcm: &Vector2<f64>, omega: f64) -> Vector2<f64> {
        if self.duration_s <= 0.0 {
            return *end_dcm;
        }
        let lag = (self.to - self.from) / (self.duration_s * omega);
        self.from + lag + (end_dcm - self.to - lag) * (-omega * self.duration_s).exp()
    }

    /// What is left of it after `elapsed_s`.
    #[must_use]
    pub fn rest(&self, elapsed_s: f64) -> Self {
        if self.duration_s <= 0.0 {
            return *self;
        }
        let share = (elapsed_s / self.duration_s).clamp(0.0, 1.0);
        Self {
            from: self.from + (self.to - self.from) * share,
            to: self.to,
            duration_s: self.duration_s * (1.0 - share),
        }
    }
}

/// The DCM at the beginning of a plan that ends at rest on its last ZMP; `None` for an empty plan.
pub fn start_dcm(plan: &[Segment], omega: f64) -> Option<Vector2<f64>> {
    let last = plan.last()?;
    Some(
        plan.iter()
            .rev()
            .fold(last.to, |end, segment| segment.start_dcm(&end, omega)),
    )
}
