//! The height of a cell as a Kalman filter keeps it: 004, equations 36.17 and 36.18.

/// A height and how sure it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeightEstimate {
    /// Height in the map frame, m.
    pub height_m: f32,
    /// Variance of the height, m².
    pub variance_m2: f32,
}

impl HeightEstimate {
    /// A height with its standard deviation, m.
    pub(crate) const fn with_sigma(height_m: f32, sigma_m: f32) -> Self {
        Self {
            height_m,
            variance_m2: sigma_m * sigma_m,
        }
    }

    /// The estimate after a measurement of the same surface: 004, equations 36.17 and 36.18. It is the mean of all that was fused,
    /// weighted by inverse variances, and never less sure than before.
    #[must_use]
    pub fn fused(self, measured: Self) -> Self {
        let sum = self.variance_m2 + measured.variance_m2;
        let gain = self.variance_m2 / sum;
        Self {
            height_m: self.height_m + gain * (measured.height_m - self.height_m),
            variance_m2: self.variance_m2 * (measured.variance_m2 / sum),
        }
    }

    /// The squared difference to a measurement, in units of its variance: the normalized innovation squared.
    pub fn innovation_squared(self, measured: Self) -> f32 {
        let apart = measured.height_m - self.height_m;
        apart * apart / (self.variance_m2 + measured.variance_m2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn fusing_gives_the_mean_weighted_by_inverse_variances_and_the_variances_add_inversely(
            measured in prop::collection::vec((-2.0..2.0f32, 0.001..0.3f32), 1..60),
        ) {
            let mut steps = measured.iter().map(|&(height_m, sigma)| HeightEstimate {
                height_m,
                variance_m2: sigma * sigma,
            });
            let mut estimate = steps.next().unwrap();
            for step in steps {
                let fused = estimate.fused(step);
                prop_assert!(fused.variance_m2 <= estimate.variance_m2);
                estimate = fused;
            }
            let weights = measured.iter().map(|&(_, sigma)| f64::from(sigma).powi(-2));
            let total: f64 = weights.clone().sum();
            let mean = measured.iter().zip(weights).map(|(&(h, _), w)| f64::from(h) * w).sum::<f64>() / total;
            prop_assert!((f64::from(estimate.height_m) - mean).abs() < 2e-5);
            prop_assert!((f64::from(estimate.variance_m2) * total - 1.0).abs() < 1e-4);
        }
    }
}
