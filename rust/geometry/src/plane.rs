//! A plane: unit normal and signed distance from the origin.

use nalgebra::{Point3, Unit, Vector3};

/// The points with `normal . p = distance_m`, in whatever frame the owner says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// Unit normal.
    pub normal: Unit<Vector3<f64>>,
    /// Signed distance of the plane from the origin along the normal, metres.
    pub distance_m: f64,
}

impl Plane {
    /// The horizontal plane at height `z_m`.
    pub fn horizontal(z_m: f64) -> Self {
        Self {
            normal: Vector3::z_axis(),
            distance_m: z_m,
        }
    }

    /// Signed distance of a point from the plane, metres.
    pub fn signed_distance_m(&self, point: &Point3<f64>) -> f64 {
        self.normal.dot(&point.coords) - self.distance_m
    }

    /// Angle between the normal and the z axis, radians, in [0, pi].
    pub fn tilt_rad(&self) -> f64 {
        libm::acos(self.normal.z.clamp(-1.0, 1.0))
    }
}
