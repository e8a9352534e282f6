//! What the motors are told at a control tick.

/// One target a joint, in joint order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct JointTargets {
    /// Angle, rad.
    pub positions_rad: Vec<f64>,
    /// Speed, rad/s.
    pub velocities_radps: Vec<f64>,
    /// Torque added to the servo's own, N m.
    pub torques_nm: Vec<f64>,
}
