//! What the inverse kinematics of a leg finds.

use robot::MOST_LEG_JOINTS;

/// Of the joints of a leg in their order, rad; what is beyond the last joint is 0.
pub(crate) type JointAngles = [f64; MOST_LEG_JOINTS];

/// Joint angles of a leg, from the hip down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegAngles {
    /// Of its joints in their order, rad, within their ranges; what is beyond the last joint is 0.
    pub angles_rad: [f64; MOST_LEG_JOINTS],
    /// Whether the sole gets where it should; else it comes as near as length and ranges let it. What five joints leave open, as a
    /// rule the sole's heading, does not count.
    pub reached: bool,
    /// How much further away from the hip the ankle should be than the leg is long, m.
    pub short_m: f64,
}
