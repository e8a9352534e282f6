//! A plane: unit normal and signed distance from the origin.

use nalgebra::{Unit, Vector3};

/// The points with `normal . p = distance_m`, in whatever frame the owner says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// Unit normal.
    pub normal: Unit<Vector3<f64>>,
    /// Signed distance of the plane from the origin along the normal, metres.
    pub distance_m: f64,
}
