//! What lies too far above what is beside it to be climbed.

use super::HeightEstimate;

/// When one height is an obstacle beside another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RiseRule {
    /// What can be climbed, m.
    pub most_m: f32,
    /// Heights no further apart than so many standard deviations of both may be those of one surface.
    pub gate: f32,
}

impl RiseRule {
    /// Whether a height lies further above another than can be climbed, and further than the two may be wrong by. What is no number does not.
    #[inline]
    pub(crate) fn is_above(self, high: HeightEstimate, low: HeightEstimate) -> bool {
        let apart_m = high.height_m - low.height_m;
        apart_m > self.most_m && high.innovation_squared(low) > self.gate * self.gate
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const RULE: RiseRule = RiseRule {
        most_m: 0.05,
        gate: 3.0,
    };

    proptest! {
        #[test]
        fn what_is_known_well_is_told_by_its_height_alone(
            rise_m in -0.2..0.2f32, sigma_m in 0.0..0.01f32,
        ) {
            let is_above = RULE.is_above(HeightEstimate::with_sigma(1.0 + rise_m, sigma_m), HeightEstimate::with_sigma(1.0, sigma_m));
            prop_assert_eq!(is_above, (1.0 + rise_m) - 1.0 > RULE.most_m);
        }

        #[test]
        fn less_sure_heights_never_make_an_obstacle(
            rise_m in 0.0..0.3f32, sigma_m in 0.0..0.05f32, more in 1.0..5.0f32,
        ) {
            let is_above = |sigma_m: f32| RULE.is_above(HeightEstimate::with_sigma(rise_m, sigma_m), HeightEstimate::with_sigma(0.0, sigma_m));
            prop_assert!(is_above(sigma_m) || !is_above(more * sigma_m));
        }
    }

    #[test]
    fn nothing_is_told_beside_what_is_unknown() {
        assert!(!RULE.is_above(
            HeightEstimate::with_sigma(1.0, 0.01),
            HeightEstimate::with_sigma(f32::NAN, 0.0)
        ));
    }
}
