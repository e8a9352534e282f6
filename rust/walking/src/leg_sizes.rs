//! How large a leg is, whatever the order of its joints.

use nalgebra::Vector3;

/// Where hip, knee and ankle of a leg are.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LegSizes {
    /// Where the hip's axes meet, or come nearest to each other, in the torso's frame, m.
    pub(crate) hip: Vector3<f64>,
    /// From hip to knee, m.
    pub(crate) thigh_m: f64,
    /// From knee to ankle, m.
    pub(crate) shank_m: f64,
    /// Where the ankle's axes meet, or come nearest to each other, in the sole's frame, m.
    pub(crate) ankle_in_sole: Vector3<f64>,
}
