//! Settings of proprioception.

use settings::{NOT_NEGATIVE, POSITIVE, above_to, between, settings};

use crate::tuning::ProprioceptionTuning;

settings! {
    /// The body's own senses: attitude, contacts and leg odometry.
    pub struct ProprioceptionConfig("navigation.proprioception") {
        /// Time in which roll and pitch are drawn to the accelerometer while walking.
        tilt_time: f64 = 2.0, "s", POSITIVE;
        /// Time in which roll and pitch are drawn to the accelerometer while the robot stands still.
        tilt_time_still: f64 = 1.5, "s", POSITIVE;
        /// A specific force whose strength is further from gravity's than this is left out.
        gravity_gate: f64 = 8.0, "m/s^2", POSITIVE;
        /// How fast a lasting tilt error becomes a bias of the stride in roll and pitch.
        stride_bias_gain: f64 = 0.02, "1/s^2", NOT_NEGATIVE;
        /// Standard deviation of the gyroscope's bias at the start.
        gyro_bias: f64 = 0.0015, "rad/s" of sensor, POSITIVE;
        /// Random walk of the gyroscope's bias, per square root of a second.
        gyro_bias_drift: f64 = 1e-5, "rad/s/sqrt(s)" of sensor, NOT_NEGATIVE;
        /// Standard deviation of the angular velocity of a robot that stands still: sensor noise and sway.
        still_noise: f64 = 0.005, "rad/s" of sensor, POSITIVE;
        /// The robot stands still while its smoothed angular velocity is below this in every axis.
        still_rate: f64 = 0.01, "rad/s" of sensor, POSITIVE;
        /// Time over which the angular velocity is smoothed to tell whether the robot stands still; 0 leaves it as it is.
        still_filter_time: f64 = 0.1, "s" of sensor, NOT_NEGATIVE;
        /// Time for which the robot must have been still on both feet until it counts as standing still.
        still_time: f64 = 0.2, "s", NOT_NEGATIVE;
        /// Time of standing still at the start in which the soles are taken to lie level; 0: they never are. It finds what the encoders
        /// between soles and inertial measurement unit are wrong by.
        level_time: f64 = 1.0, "s", NOT_NEGATIVE;
        /// A tilt of the soles larger than this is no encoder error but the ground's.
        level_limit: f64 = 0.06, "rad", POSITIVE;
        /// A foot begins to hold when it carries more than this share of the load.
        hold_share: f64 = 0.3, "1", between(0.0, 0.5);
        /// A foot lets go when it carries less than this share of the load.
        release_share: f64 = 0.15, "1", between(0.0, 0.5);
        /// The support foot changes when the other carries more than this share of the load.
        support_share: f64 = 0.55, "1", between(0.5, 1.0);
        /// Below this share of the robot's weight on both feet together nothing is decided.
        least_load: f64 = 0.2, "1", NOT_NEGATIVE;
        /// Share of a new load in the smoothed one, for each tick.
        load_filter: f64 = 0.5, "1", above_to(0.0, 1.0);
        /// A foot that lands nearer than this to the height of the other one, or of where it stood before, stands on that level.
        level_band: f64 = 0.008, "m", NOT_NEGATIVE;
        /// Numbers that few will want to turn.
        tuning: ProprioceptionTuning;
    }
    require (release_share) < (hold_share);
}

impl ProprioceptionConfig {
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
    use settings::Table;

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
            release_share: 0.4,
            ..ProprioceptionConfig::default()
        };
        assert!(config.check().unwrap_err().key.ends_with("release_share"));
        let config = ProprioceptionConfig {
            level_band: f64::NAN,
            ..ProprioceptionConfig::default()
        };
        assert!(config.check().is_err());
    }
}
