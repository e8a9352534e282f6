//! Settings of proprioception.

use serde::{Deserialize, Serialize};
use settings::{ConfigError, require};

/// Settings of [`crate::Proprioception`]: `[navigation.proprioception]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ProprioceptionConfig {
    /// Time in which roll and pitch are drawn to the accelerometer while walking, s.
    pub tilt_time: f64,
    /// The same while the robot stands still, s.
    pub tilt_time_still: f64,
    /// A specific force whose strength is further from gravity's than this is left out, m/s^2.
    pub gravity_gate: f64,
    /// How fast a lasting tilt error becomes a bias of the stride in roll and pitch, 1/s^2.
    pub stride_bias_gain: f64,
    /// Standard deviation of the gyroscope's bias at the start, rad/s.
    pub gyro_bias: f64,
    /// Its random walk, rad/s per square root of a second.
    pub gyro_bias_drift: f64,
    /// Standard deviation of the angular velocity of a robot that stands still, sensor noise and sway, rad/s.
    pub still_noise: f64,
    /// The robot stands still when its smoothed angular velocity is below this in every axis, rad/s,
    pub still_rate: f64,
    /// smoothed over this time, s (0: as it is),
    pub still_filter_time: f64,
    /// and has been for this time on both feet, s.
    pub still_time: f64,
    /// Time of standing still at the start in which the soles are taken to lie level, s; 0: they never are. It finds
    /// what the encoders between soles and inertial measurement unit are wrong by.
    pub level_time: f64,
    /// A tilt of the soles larger than this is no encoder error but the ground's, rad.
    pub level_limit: f64,
    /// A foot begins to hold when it carries more than this share of the load,
    pub hold_share: f64,
    /// and lets go below this share.
    pub release_share: f64,
    /// The support foot changes when the other carries more than this share.
    pub support_share: f64,
    /// Below this share of the robot's weight on both feet together nothing is decided.
    pub least_load: f64,
    /// Share of a new load in the smoothed one, for each tick.
    pub load_filter: f64,
    /// A foot that lands nearer than this to the height of the other one stands on the same level, m.
    pub level_band: f64,
}

impl Default for ProprioceptionConfig {
    fn default() -> Self {
        Self {
            tilt_time: 2.0,
            tilt_time_still: 1.5,
            gravity_gate: 8.0,
            stride_bias_gain: 0.02,
            gyro_bias: 0.0015,
            gyro_bias_drift: 1e-5,
            still_noise: 0.005,
            still_rate: 0.01,
            still_filter_time: 0.1,
            still_time: 0.2,
            level_time: 1.0,
            level_limit: 0.06,
            hold_share: 0.3,
            release_share: 0.15,
            support_share: 0.55,
            least_load: 0.2,
            load_filter: 0.5,
            level_band: 0.008,
        }
    }
}

impl ProprioceptionConfig {
    /// Refuses what cannot be used.
    pub fn check(&self) -> Result<(), ConfigError> {
        let positive = [
            ("tilt_time", self.tilt_time),
            ("tilt_time_still", self.tilt_time_still),
            ("gravity_gate", self.gravity_gate),
            ("gyro_bias", self.gyro_bias),
            ("still_noise", self.still_noise),
            ("still_rate", self.still_rate),
            ("level_limit", self.level_limit),
        ];
        for (name, value) in positive {
            let key = format!("navigation.proprioception.{name}");
            require(value.is_finite() && value > 0.0, &key, "> 0", value)?;
        }
        let not_negative = [
            ("stride_bias_gain", self.stride_bias_gain),
            ("gyro_bias_drift", self.gyro_bias_drift),
            ("still_filter_time", self.still_filter_time),
            ("still_time", self.still_time),
            ("level_time", self.level_time),
            ("least_load", self.least_load),
            ("level_band", self.level_band),
        ];
        for (name, value) in not_negative {
            let key = format!("navigation.proprioception.{name}");
            require(value.is_finite() && value >= 0.0, &key, ">= 0", value)?;
        }
        let shares = [
            ("hold_share", self.hold_share, self.release_share, 0.5),
            ("release_share", self.release_share, 0.0, self.hold_share),
            ("support_share", self.support_share, 0.5, 1.0),
            ("load_filter", self.load_filter, 0.0, 1.0 + f64::EPSILON),
        ];
        for (name, value, low, high) in shares {
            let key = format!("navigation.proprioception.{name}");
            let allowed = format!("between {low} and {high:.3}");
            require(value > low && value < high, &key, &allowed, value)?;
        }
        Ok(())
    }

    /// Share of an angular velocity in the smoothed one, `passed_s` after the one before. At the first tick no time has passed.
    pub(crate) fn still_share(&self, passed_s: f64) -> f64 {
        if self.still_filter_time > 0.0 {
            passed_s / (passed_s + self.still_filter_time)
        } else {
            1.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shipped_settings_are_allowed() {
        assert_eq!(ProprioceptionConfig::default().check(), Ok(()));
    }

    #[test]
    fn a_bad_setting_is_refused_by_name() {
        let config = ProprioceptionConfig {
            tilt_time: 0.0,
            ..ProprioceptionConfig::default()
        };
        let message = config.check().unwrap_err().to_string();
        assert_eq!(
            message,
            "navigation.proprioception.tilt_time must be > 0, got 0"
        );
        let config = ProprioceptionConfig {
            hold_share: 0.6,
            ..ProprioceptionConfig::default()
        };
        assert!(config.check().unwrap_err().key.ends_with("hold_share"));
        let config = ProprioceptionConfig {
            level_band: f64::NAN,
            ..ProprioceptionConfig::default()
        };
        assert!(config.check().is_err());
    }
}
