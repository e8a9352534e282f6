//! Settings of the localizer `odometry`.

use settings::{POSITIVE, SHARE, settings};

settings! {
    /// The localizer `odometry`: leg odometry whose height is drawn to the floor of the map.
    pub struct OdometryLocalizerConfig("navigation.odometry") {
        /// Share by which each depth frame draws the robot's height to that of the floor under its feet; 0 leaves the height to the legs.
        height_gain: f64 = 0.1, "1", SHARE, "000, section IV";
        /// A floor further above or below the robot than this is another level, and does not draw the height.
        height_gate: f64 = 0.012, "m", POSITIVE;
    }
}
