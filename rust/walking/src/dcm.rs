//! The divergent component of motion (DCM) for a plan of the zero moment point (ZMP), backwards from its end.
//!
//! Englsberger, Ott, Albu-Schaeffer, "Three-dimensional bipedal walking control based on divergent component of motion",
//! IEEE T-RO 31 (2015). With the linear inverted pendulum c'' = w^2 (c - p) the DCM xi = c + c'/w obeys xi' = w (xi - p) (their
//! equation 8 on level ground), which is unstable forwards and hence stable backwards.

use nalgebra::Vector2;

/// A part of the plan in which the ZMP moves evenly from one point to another.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ZmpSegment {
    /// ZMP at its beginning, m.
    pub from: Vector2<f64>,
    /// ZMP at its end, m.
    pub to: Vector2<f64>,
    /// How long it takes, s.
    pub duration_s: f64,
}

impl ZmpSegment {
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
pub fn start_dcm(plan: &[ZmpSegment], omega: f64) -> Option<Vector2<f64>> {
    let last = plan.last()?;
    Some(
        plan.iter()
            .rev()
            .fold(last.to, |end, segment| segment.start_dcm(&end, omega)),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const OMEGA: f64 = 6.0;

    fn plan() -> impl Strategy<Value = Vec<ZmpSegment>> {
        let part = ((-1.0..1.0f64, -1.0..1.0f64), 0.05..0.8f64);
        prop::collection::vec(part, 1..7).prop_map(|parts| {
            let mut from = Vector2::zeros();
            parts
                .into_iter()
                .map(|((x, y), duration_s)| {
                    let to = Vector2::new(x, y);
                    let segment = ZmpSegment {
                        from,
                        to,
                        duration_s,
                    };
                    from = to;
                    segment
                })
                .collect()
        })
    }

    proptest! {
        #[test]
        fn following_a_segment_forwards_leads_to_the_beginning_of_the_next(plan in plan()) {
            for (index, segment) in plan.iter().enumerate() {
                let mut dcm = start_dcm(&plan[index..], OMEGA).unwrap();
                let steps = 4000;
                let passed_s = segment.duration_s / f64::from(steps);
                for step in 0..steps {
                    let middle = segment.rest((f64::from(step) + 0.5) * passed_s).from;
                    dcm = middle + (dcm - middle) * (OMEGA * passed_s).exp();
                }
                let next = start_dcm(&plan[index + 1..], OMEGA).unwrap_or(segment.to);
                prop_assert!((dcm - next).norm() < 1e-5, "{dcm} {next}");
            }
        }

        #[test]
        fn the_dcm_never_leaves_the_box_around_the_zero_moment_points(plan in plan()) {
            let dcm = start_dcm(&plan, OMEGA).unwrap();
            for axis in 0..2 {
                let points = plan.iter().flat_map(|segment| [segment.from[axis], segment.to[axis]]);
                let (low, high) = points.fold((f64::MAX, f64::MIN), |(low, high), point| {
                    (low.min(point), high.max(point))
                });
                prop_assert!(dcm[axis] >= low - 1e-9 && dcm[axis] <= high + 1e-9);
            }
        }

        #[test]
        fn what_is_far_ahead_does_not_count(plan in plan(), shift in -1.0..1.0f64) {
            let pause = ZmpSegment { from: Vector2::zeros(), to: Vector2::zeros(), duration_s: 3.0 };
            let before = |plan: &[ZmpSegment]| start_dcm(&[&[pause], plan].concat(), OMEGA).unwrap();
            let moved: Vec<ZmpSegment> = plan
                .iter()
                .map(|segment| ZmpSegment { to: segment.to.add_scalar(shift), ..*segment })
                .collect();
            prop_assert!((before(&plan) - before(&moved)).norm() < 1e-6);
        }
    }

    #[test]
    fn an_empty_plan_has_no_dcm() {
        assert_eq!(start_dcm(&[], OMEGA), None);
    }
}
