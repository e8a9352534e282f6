//! How sure a range sensor is, by how far away it looks.

/// How the standard deviation of a measured height grows with the range: 004, Fig. 36.10.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RangeNoise {
    /// At the sensor, m.
    pub sigma_m: f32,
    /// More for each metre of range.
    pub per_metre: f32,
}

impl RangeNoise {
    /// Standard deviation of what was measured at a range, m.
    #[inline]
    pub fn deviation_m(self, range_m: f32) -> f32 {
        self.sigma_m + self.per_metre * range_m
    }

    /// Variance of what was measured at a range, m².
    #[inline]
    pub fn variance_m2(self, range_m: f32) -> f32 {
        let sigma_m = self.deviation_m(range_m);
        sigma_m * sigma_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_standard_deviation_is_linear_in_the_range() {
        let noise = RangeNoise {
            sigma_m: 0.004,
            per_metre: 0.01,
        };
        for range_m in [0.0_f32, 0.5, 2.0, 8.0] {
            let sigma = noise.variance_m2(range_m).sqrt();
            assert!((sigma - (0.004 + 0.01 * range_m)).abs() < 1e-6);
        }
    }
}
