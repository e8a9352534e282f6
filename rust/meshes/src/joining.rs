//! Whether two points that were seen side by side are on one surface, or range jumps between them (004, section 36.3.3).

use nalgebra::Vector3;
use sensing::RangeNoise;
use settings::{POSITIVE, settings, within};

settings! {
    /// Where surfaces end: disconnected pieces must not become linked (004, section 36.3.3).
    pub struct JoiningConfig("navigation.mesh.joining") {
        /// A difference in range up to so many standard deviations of both is noise.
        gate: f64 = 3.0, "1", POSITIVE;
        /// A surface that would be seen at a smaller angle than this between it and the line of sight is a gap, unless the points beside go on
        /// in its plane.
        grazing: f64 = 0.17, "rad", within(0.001, 1.5);
        /// In clouds: points further apart, as the sensor sees them, than so many times what is usual are not joined.
        gap: f64 = 4.0, "1", within(1.0, 1000.0);
    }
}

/// The rule with what it needs of the sensor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JoiningRule {
    /// Standard deviations of both that are noise.
    gate: f64,
    /// How much further away a surface may get for each metre across the line of sight.
    steepest: f64,
    /// Times the usual distance that is a gap.
    pub(crate) gap: f64,
    /// Of the ranges.
    noise: RangeNoise,
}

impl JoiningRule {
    /// By the settings, for a sensor.
    pub fn new(config: &JoiningConfig, noise: RangeNoise) -> Self {
        Self {
            gate: config.gate,
            steepest: 1.0 / libm::tan(config.grazing),
            gap: config.gap,
            noise,
        }
    }

    /// Variance of what was measured at a range, m².
    pub(crate) fn variance_m2(&self, range_m: f64) -> f64 {
        f64::from(self.noise.variance_m2(range_m as f32))
    }

    /// Whether a range is that of a thing so far away, m, but for noise; not where it is no number.
    pub(crate) fn as_far(&self, thing_m: f64, range_m: f64) -> bool {
        (thing_m - range_m).abs() <= self.gate * self.variance_m2(range_m).sqrt()
    }

    /// Whether two points, m from the eye, may be on one surface: that would not be seen at too small an angle, or the difference in range is
    /// noise.
    pub(crate) fn joins(&self, one: &Vector3<f64>, other: &Vector3<f64>) -> bool {
        let (near, far) = (one.norm(), other.norm());
        let apart = other - one;
        let sight = (one + other).normalize();
        let along = apart.dot(&sight);
        let across = (apart - sight * along).norm();
        let noise = self.variance_m2(near) + self.variance_m2(far);
        along.abs() <= self.steepest * across + self.gate * noise.sqrt()
    }

    /// Whether a point beyond two others, all evenly spaced along a line of a picture, goes on in a plane with them: the inverses of depths
    /// along the optical axis are linear there. Depths and standard deviations, m, the outermost first and then towards the third.
    pub(crate) fn goes_on(&self, depths_m: [f64; 3]) -> bool {
        let [before, here, beyond] = depths_m.map(f64::recip);
        let bend = before - 2.0 * here + beyond;
        // Depths along the axis are as sure as ranges, but for the angle between both.
        let [a, b, c] = depths_m.map(|depth_m| self.variance_m2(depth_m) / depth_m.powi(4));
        bend * bend <= self.gate * self.gate * (a + 2.0 * (b + b) + c)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use settings::Table;

    const EXACT: RangeNoise = RangeNoise {
        sigma_m: 0.0,
        per_metre: 0.0,
    };

    proptest! {
        #[test]
        fn planes_go_on_and_jumps_do_not(
            depth in 0.3..5.0f64, slope in -20.0..20.0f64, jump in 0.01..3.0f64,
        ) {
            let rule = JoiningRule::new(&JoiningConfig::default(), EXACT);
            let place = |col: f64| depth / (1.0 + 0.001 * slope * col);
            let off = 1e-9;
            let noisy = JoiningRule::new(&JoiningConfig::default(), RangeNoise { sigma_m: off, per_metre: 0.0 });
            prop_assert!(noisy.goes_on([place(0.0), place(1.0), place(2.0)]));
            prop_assert!(!rule.goes_on([place(0.0), place(1.0), place(2.0) + jump]));
        }
    }

    #[test]
    fn what_would_be_seen_at_too_small_an_angle_is_a_gap_unless_it_is_noise() {
        let joins = |noise, further: f64| {
            let rule = JoiningRule::new(&JoiningConfig::default(), noise);
            let far = Vector3::new(0.01, 0.0, 1.0 + further);
            rule.joins(&Vector3::new(0.0, 0.0, 1.0), &far)
        };
        assert!(joins(EXACT, 0.05));
        assert!(!joins(EXACT, 0.07));
        let noise = RangeNoise {
            sigma_m: 0.01,
            per_metre: 0.0,
        };
        assert!(joins(noise, 0.07));
        assert!(!joins(noise, 0.12));
    }

    #[test]
    fn a_bad_angle_is_refused_by_its_key() {
        let bad = JoiningConfig {
            grazing: 0.0,
            ..JoiningConfig::default()
        };
        let said = bad.check().unwrap_err().to_string();
        assert!(
            said.starts_with("navigation.mesh.joining.grazing"),
            "{said}"
        );
    }
}
