//! What a robot's folder says of its body, as plain data.

mod legs;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::size::own_size;
pub use legs::{ForceSensors, LEAST_LEG_JOINTS, Leg, Legs, MOST_LEG_JOINTS, Sole};

/// The left or the right leg.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// The robot's left, +y.
    Left,
    /// The robot's right, -y.
    Right,
}

impl Side {
    /// Both, left first: the order of every array over the feet.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// 0 for left, 1 for right: the index into arrays over the feet.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The other one.
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }

    /// Sign of y: +1 for left, -1 for right.
    pub const fn sign(self) -> f64 {
        match self {
            Self::Left => 1.0,
            Self::Right => -1.0,
        }
    }
}

/// A whole robot. Lengths in metres, angles in radians, masses in kilograms, torques in newton metres.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Description {
    /// The folder's name.
    pub name: String,
    /// Length of the leg over that of the robot whose numbers the defaults are; descriptions from before are of robots of its size.
    #[serde(default = "own_size")]
    pub scale: f64,
    /// Links, each behind its parent; the first is the root.
    pub links: Vec<LinkDescription>,
    /// Names of the joints in joint order: that of every array over joints.
    pub joints: Vec<String>,
    /// Joint angles of the upright stance, rad, in joint order.
    pub stand: Vec<f64>,
    /// Link that counts as the trunk's root.
    pub torso: String,
    /// The two legs.
    pub legs: Legs,
    /// The joints that turn the head.
    pub head: Head,
    /// Where the arms are held: joint name to angle, rad.
    pub arms_rest: BTreeMap<String, f64>,
    /// Where raised arms are held: joint name to angle, rad.
    #[serde(default)]
    pub arms_raised: BTreeMap<String, f64>,
    /// The inertial measurement unit.
    pub imu: ImuMount,
    /// The depth camera.
    pub camera: CameraMount,
    /// Size of the whole body for clearances.
    pub body: Extent,
    /// Lost motion of a gear between the two directions of torque, rad; encoders sit on the motors' side of it.
    #[serde(default)]
    pub play: f64,
    /// `[gait]` of robot.toml as it stands there; read by the walker.
    #[serde(default)]
    pub gait: serde_json::Value,
}

/// One rigid link and the joint, if any, that turns it against its parent.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LinkDescription {
    /// The link's name.
    pub name: String,
    /// Index of the parent in the list of links; `None` for the root.
    pub parent: Option<usize>,
    /// Origin in the parent's frame, m.
    pub position: [f64; 3],
    /// Orientation in the parent's frame at joint angle zero, quaternion w, x, y, z.
    pub orientation: [f64; 4],
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass in the link's frame, m.
    pub center_of_mass: [f64; 3],
    /// Ixx, Iyy, Izz, Ixy, Ixz, Iyz about the centre of mass along the link's axes, kg m^2.
    pub inertia: [f64; 6],
    /// The hinge that turns this link, if any.
    pub joint: Option<JointDescription>,
}

/// A hinge with its motor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointDescription {
    /// The joint's name.
    pub name: String,
    /// Unit axis in the link's frame.
    pub axis: [f64; 3],
    /// A point of the axis in the link's frame, m.
    pub anchor: [f64; 3],
    /// Smallest and largest angle, rad.
    pub range: [f64; 2],
    /// Largest torque, N m.
    pub peak_torque: f64,
    /// Speed at which no torque is left, rad/s.
    pub no_load_speed: f64,
    /// Stiffness of the servo, N m/rad.
    pub kp: f64,
    /// Damping of the servo, N m s/rad.
    pub kv: f64,
    /// The joint whose motor turns this one too, by gears or rods; `None` for a joint with a motor of its own.
    #[serde(default)]
    pub follows: Option<String>,
    /// How far it turns for each radian of the joint that it follows.
    #[serde(default = "same")]
    pub ratio: f64,
    /// Its angle where that of the joint that it follows is zero, rad.
    #[serde(default)]
    pub offset: f64,
}

/// A joint that follows turns as the other one, where nothing else is said.
const fn same() -> f64 {
    1.0
}

/// The joints that turn the head.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Head {
    /// Turns about the vertical; `None` where no joint does.
    #[serde(default)]
    pub pan: Option<String>,
    /// Nods; `None` where no joint does.
    #[serde(default)]
    pub tilt: Option<String>,
    /// Height of the eyes above the ground while the robot stands, as far as turning the head to a place needs it, m.
    #[serde(default = "eye_height")]
    pub eye_height: f64,
    /// How far the eyes are ahead of the robot's middle, as far as turning the head to a place needs it, m.
    #[serde(default = "eye_ahead")]
    pub eye_ahead: f64,
}

/// What robots have that were described before a description said it.
const fn eye_height() -> f64 {
    0.45
}

/// What robots have that were described before a description said it.
const fn eye_ahead() -> f64 {
    0.04
}

/// Where the inertial measurement unit sits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ImuMount {
    /// Link that carries it.
    pub link: String,
    /// Position in the link's frame, m.
    pub position: [f64; 3],
    /// Orientation in the link's frame, quaternion w, x, y, z.
    pub orientation: [f64; 4],
}

/// Where the depth camera sits and what it is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraMount {
    /// Link that carries it.
    pub link: String,
    /// Optical centre in the link's frame, m.
    pub position: [f64; 3],
    /// Optical frame (x right, y down, z forward) in the link's frame, quaternion w, x, y, z.
    pub orientation: [f64; 4],
    /// Image width, pixels.
    pub width: usize,
    /// Image height, pixels.
    pub height: usize,
    /// Focal length, pixels (square pixels).
    pub focal: f64,
    /// Time between exposures, s.
    pub period: f64,
    /// Pixels a side that are looked at as one.
    #[serde(default = "one")]
    pub pool: usize,
    /// What is known of the stereo matching.
    pub stereo: StereoDescription,
}

const fn one() -> usize {
    1
}

/// What the core knows of its stereo camera.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StereoDescription {
    /// Distance between the eyes, m.
    pub baseline: f64,
    /// Side of the matching window, pixels.
    pub window: usize,
}

/// Size of the whole body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Extent {
    /// Radius of the upright cylinder that holds the robot while it walks, m.
    pub radius: f64,
    /// Height of the top of the head while it stands, m.
    pub height: f64,
    /// Extent from front to back of the upright box that holds the robot while it walks sideways, m; default: the cylinder's.
    #[serde(default)]
    pub depth: Option<f64>,
    /// Extent across of the upright box that holds the robot while it walks sideways, m; default: the cylinder's.
    #[serde(default)]
    pub width: Option<f64>,
    /// How far to each side of the middle the ground matters to the feet, m: a little less than the outer edges of the soles.
    #[serde(default = "foot_side")]
    pub foot_side: f64,
}

/// What robots have that were described before a description said it.
const fn foot_side() -> f64 {
    0.06
}

#[cfg(test)]
mod tests;
