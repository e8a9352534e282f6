//! What the body itself tells at every control tick: attitude, contacts, odometry.

use geometry::{Odometry, Pose, Robot, Torso};
use nalgebra::{UnitQuaternion, Vector3};
use robot::{LinkPoses, Side};

/// Why an observation gave no body state. The state is unchanged.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ProprioceptionError {
    /// The joints do not fit the body.
    #[error(transparent)]
    Body(#[from] robot::BodyError),
    /// A reading that is no number, or a time that does not advance.
    #[error(transparent)]
    Observation(#[from] sensing::ObservationError),
}

/// The product of proprioception, made anew at every control tick.
#[derive(Debug, Clone)]
pub struct BodyState {
    /// Nanoseconds since the start.
    pub time_ns: u64,
    /// Orientation of the torso: roll and pitch against gravity, yaw integrated from the gyroscope.
    pub odometry_from_torso_rotation: UnitQuaternion<f64>,
    /// Angular velocity of the torso in its own frame, bias removed, rad/s.
    pub angular_velocity_radps: Vector3<f64>,
    /// Pose of every link in the torso, by the measured joints.
    pub links: LinkPoses,
    /// Load on each sole, N, left and right.
    pub foot_loads_n: [f64; 2],
    /// Foot that carries the robot and that odometry is anchored to.
    pub support: Side,
    /// Whether both soles hold, on one level: on different ones, the robot's frame is somewhere between the two.
    pub stands_level: bool,
    /// Whether a sole that holds stands on a slope: then nothing that is level carries the robot.
    pub on_slope: bool,
    /// The robot's frame (between the soles, on the supporting surface) by leg odometry.
    pub odometry_from_robot: Pose<Odometry, Robot>,
    /// The torso in the robot's frame.
    pub robot_from_torso: Pose<Robot, Torso>,
}

impl BodyState {
    /// How far the torso is tilted against gravity, rad.
    pub fn tilt_rad(&self) -> f64 {
        let up = self.odometry_from_torso_rotation * Vector3::z();
        libm::acos(up.z.clamp(-1.0, 1.0))
    }
}
