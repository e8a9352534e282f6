//! Where a ray meets each form. Plane, box, cylinder, capsule and ellipsoid speak in nearness, 1 / depth, which is linear in a pixel's
//! place for every flat face: no division a pixel. A body that the camera is in is met from within, at its far side.

mod capsule;
mod cuboid;
mod cylinder;
mod ellipsoid;
mod height_field;
mod mesh;
mod plane;
mod quadric;

pub(crate) use capsule::CapsuleAhead;
pub(crate) use cuboid::CuboidAhead;
pub(crate) use cylinder::CylinderAhead;
pub(crate) use ellipsoid::EllipsoidAhead;
pub use height_field::HeightField;
pub use mesh::Mesh;
pub(crate) use plane::PlaneAhead;

/// The larger one; the second where one of them is no number.
#[inline]
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The smaller one; the second where one of them is no number.
#[inline]
pub(crate) fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}
