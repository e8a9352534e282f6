//! Settings of FastSLAM.

use settings::{NOT_NEGATIVE, SHARE, at_least, settings, within};

/// Most particles that memory has room for.
const MOST_PARTICLES: f64 = 1e5;

settings! {
    /// Localization while landmarks are mapped: particles of the robot's way, each with a map of its own. Noise that grows is given per square root of a
    /// metre of way, of a radian of turn, and of a second.
    pub struct FastSlamConfig("landmarks.fast_slam") {
        /// How many particles there are.
        particles: usize = 50, "1", within(1.0, MOST_PARTICLES), "36.8";
        /// Seed of all that is drawn.
        seed: u64 = 0, "1", within(0.0, 9_007_199_254_740_992.0);
        /// Growth of the odometry's error along x and y: per way, turn and time.
        place_noise: [f64; 3] = [0.03, 0.01, 0.002], "m/sqrt(m), m/sqrt(rad), m/sqrt(s)", NOT_NEGATIVE;
        /// Growth of the error of the odometry's heading: per way, turn and time.
        heading_noise: [f64; 3] = [0.02, 0.04, 0.002], "rad/sqrt(m), rad/sqrt(rad), rad/sqrt(s)", NOT_NEGATIVE;
        /// What the odometry's ways and turns are to be multiplied by is not known: standard deviations about 1. It is found on the way.
        scale_noise: [f64; 2] = [0.05, 0.3], "1, 1", NOT_NEGATIVE;
        /// All bearings may be off by the same, as where the sensor is turned a little on the robot: standard deviation. It is found on the way.
        bearing_bias: f64 = 0.0, "rad", NOT_NEGATIVE;
        /// They are drawn anew where their effective number falls below this share of them.
        resample_below: f64 = 0.5, "1", SHARE;
        /// Standard deviation below which a place is known: what is drawn has at least this.
        least_noise: f64 = 1e-6, "m or rad", at_least(1e-9);
    }
}
