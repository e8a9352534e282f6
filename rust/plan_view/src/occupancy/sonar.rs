//! What one measurement of a sonar says of a cell: a cone, the less the further it reaches (004, section 36.2.1 and Fig. 36.1).

use settings::{ConfigError, POSITIVE, Table, between, settings, within};

settings! {
    /// How a sonar sees.
    pub struct SonarConfig("plan_view.sonar") {
        /// Probability that a cell is occupied of which nothing is known; that of the map.
        prior: f64 = 0.5, "1", between(0.0, 1.0);
        /// What an echo from right before the sensor would say of a cell on the axis at its distance.
        occupied: f64 = 0.8, "1", within(0.0, 1.0), "004, Fig. 36.1";
        /// What it would say of cells before that.
        free: f64 = 0.35, "1", within(0.0, 1.0), "004, Fig. 36.1";
        /// Half of the opening of the cone, outside of which nothing is said.
        half_opening: f64 = 0.2, "rad", within(0.001, 1.5);
        /// Standard deviation of the angle off the axis by which what is said falls.
        angle_sigma: f64 = 0.08, "rad", within(0.001, 1.5), "004, section 36.2.1: Gaussian with zero mean";
        /// What is said falls linearly with the range, to nothing here.
        max_range: f64 = 6.0, "m", POSITIVE;
        /// Before and behind the range, how far what is said changes linearly from free to occupied and on to nothing.
        transition: f64 = 0.1, "m", POSITIVE, "004, section 36.2.1: piecewise linear";
    }
    require (free) < (prior);
    require (prior) < (occupied);
}

/// The inverse model of a sonar: probability that a cell is occupied, given one range alone.
#[derive(Debug, Clone)]
pub struct SonarModel {
    config: SonarConfig,
}

impl SonarModel {
    /// With settings.
    pub fn new(config: SonarConfig) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self { config })
    }

    /// The settings.
    pub const fn config(&self) -> &SonarConfig {
        &self.config
    }

    /// How far from the sensor, m, a measurement says anything; none where it says nothing.
    pub fn reach_m(&self, range_m: Option<f64>) -> Option<f64> {
        let range_m = range_m.filter(|range_m| *range_m < self.config.max_range)?;
        Some(range_m + self.config.transition)
    }

    /// Probability that a cell is occupied whose middle lies so far from the sensor, m, and so far off the axis, rad; the range, m, is none of a
    /// maximum range reading.
    pub fn probability(&self, range_m: Option<f64>, distance_m: f64, off_axis_rad: f64) -> f64 {
        let config = &self.config;
        let Some(range_m) = range_m.filter(|range_m| *range_m < config.max_range) else {
            return config.prior;
        };
        if off_axis_rad.abs() > config.half_opening {
            return config.prior;
        }
        let spread = off_axis_rad / config.angle_sigma;
        let influence = (1.0 - range_m / config.max_range) * libm::exp(-0.5 * spread * spread);
        config.prior + influence * self.profile(distance_m - range_m)
    }

    /// What is said on the axis beside the prior: free, rising to occupied at the range, and back to nothing behind it.
    fn profile(&self, behind_m: f64) -> f64 {
        let config = &self.config;
        let (free, occupied) = (config.free - config.prior, config.occupied - config.prior);
        let away = behind_m / config.transition;
        if away <= -1.0 {
            free
        } else if away <= 0.0 {
            occupied + away * (occupied - free)
        } else {
            occupied * (1.0 - away).max(0.0)
        }
    }
}
