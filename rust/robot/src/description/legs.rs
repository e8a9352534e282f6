//! What a robot's folder says of its legs, as plain data.

use serde::{Deserialize, Serialize};

use super::Side;

/// A sole can be put somewhere, level, by no fewer joints.
pub const LEAST_LEG_JOINTS: usize = 5;
/// Room for the joints of a leg in arrays.
pub const MOST_LEG_JOINTS: usize = 7;

/// Both legs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Legs {
    /// The left leg.
    pub left: Leg,
    /// The right leg.
    pub right: Leg,
}

impl Legs {
    /// The leg of that side.
    pub const fn get(&self, side: Side) -> &Leg {
        match side {
            Side::Left => &self.left,
            Side::Right => &self.right,
        }
    }
}

/// A leg, from the hip down.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Leg {
    /// Its joints, [`LEAST_LEG_JOINTS`] to [`MOST_LEG_JOINTS`], in whatever order its axes have.
    pub joints: Vec<String>,
    /// The sole at its end.
    pub sole: Sole,
    /// Where the force sensors are; `None`: at the sole's corners.
    #[serde(default)]
    pub sensors: Option<ForceSensors>,
}

impl Leg {
    /// Middle of the force sensors from the sole's centre, and their distances, forward and to the left, m.
    pub fn sensors_on_sole_m(&self) -> ([f64; 2], [f64; 2]) {
        let sole = &self.sole;
        self.sensors
            .as_ref()
            .map_or(([0.0; 2], [sole.length, sole.width]), |sensors| {
                let middle = [0, 1].map(|axis| sensors.position[axis] - sole.position[axis]);
                (middle, [sensors.length, sensors.width])
            })
    }
}

/// The rectangle that a foot stands on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sole {
    /// Link that carries it.
    pub link: String,
    /// Centre of the rectangle in the link's frame, in the plane that touches the ground, m.
    pub position: [f64; 3],
    /// Extent along x, m.
    pub length: f64,
    /// Extent along y, m.
    pub width: f64,
}

/// The rectangle at whose corners the force sensors of a foot are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ForceSensors {
    /// Its centre in the link's frame, m.
    pub position: [f64; 3],
    /// Extent along x, m.
    pub length: f64,
    /// Extent along y, m.
    pub width: f64,
}
