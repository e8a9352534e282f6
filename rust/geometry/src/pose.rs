//! Poses, points and vectors that know their frames; `wrap` is the only way to claim one.

use std::fmt;
use std::marker::PhantomData;
use std::ops::Mul;

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};

/// A rigid transform that takes coordinates in `Source` to coordinates in `Target`; equally, the pose of `Source` in `Target`.
pub struct Pose<Target, Source> {
    /// The bare transform, for inner loops.
    pub inner: Isometry3<f64>,
    frames: PhantomData<fn(Source) -> Target>,
}

/// A position in `Frame`, in metres.
pub struct Point<Frame> {
    /// The bare coordinates, metres.
    pub inner: Point3<f64>,
    frame: PhantomData<fn() -> Frame>,
}

/// A displacement, velocity or direction in `Frame`; its unit is said where it is used.
pub struct Vector<Frame> {
    /// The bare coordinates.
    pub inner: Vector3<f64>,
    frame: PhantomData<fn() -> Frame>,
}

impl<T, S> Pose<T, S> {
    /// Claims that `inner` takes `S` coordinates to `T` coordinates. Nothing checks the claim.
    pub const fn wrap(inner: Isometry3<f64>) -> Self {
        Self {
            inner,
            frames: PhantomData,
        }
    }

    /// The two frames coincide.
    pub fn identity() -> Self {
        Self::wrap(Isometry3::identity())
    }

    /// Origin at (x, y, z) in metres, turned by `yaw_rad` about z.
    pub fn from_yaw(x_m: f64, y_m: f64, z_m: f64, yaw_rad: f64) -> Self {
        Self::wrap(Isometry3::from_parts(
            Translation3::new(x_m, y_m, z_m),
            UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw_rad),
        ))
    }

    /// Turns the pose round: `source_from_target`.
    #[must_use]
    pub fn inverse(&self) -> Pose<S, T> {
        Pose::wrap(self.inner.inverse())
    }

    /// Heading of the source's x axis in the target's x-y plane, radians.
    pub fn yaw_rad(&self) -> f64 {
        let x_axis = self.inner.rotation * Vector3::x();
        libm::atan2(x_axis.y, x_axis.x)
    }

    /// Origin of the source in the target.
    pub fn origin(&self) -> Point<T> {
        Point::wrap(Point3::from(self.inner.translation.vector))
    }
}

impl<T, S> fmt::Debug for Pose<T, S> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.inner.fmt(formatter)
    }
}
impl<T, S> Clone for Pose<T, S> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T, S> Copy for Pose<T, S> {}
impl<T, S> PartialEq for Pose<T, S> {
    fn eq(&self, other: &Self) -> bool {
        self.inner == other.inner
    }
}

impl<F> Point<F> {
    /// Claims that `inner` is a position in `F`.
    pub const fn wrap(inner: Point3<f64>) -> Self {
        Self {
            inner,
            frame: PhantomData,
        }
    }

    /// A position from its coordinates in metres.
    pub fn new(x_m: f64, y_m: f64, z_m: f64) -> Self {
        Self::wrap(Point3::new(x_m, y_m, z_m))
    }
}

impl<F> fmt::Debug for Point<F> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.inner.fmt(formatter)
    }
}
impl<F> Clone for Point<F> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<F> Copy for Point<F> {}
impl<F> PartialEq for Point<F> {
    fn eq(&self, other: &Self) -> bool {
        self.inner == other.inner
    }
}

impl<F> Vector<F> {
    /// Claims that `inner` is a vector in `F`.
    pub const fn wrap(inner: Vector3<f64>) -> Self {
        Self {
            inner,
            frame: PhantomData,
        }
    }

    /// A vector from its coordinates.
    pub fn new(x: f64, y: f64, z: f64) -> Self {
        Self::wrap(Vector3::new(x, y, z))
    }
}

impl<F> fmt::Debug for Vector<F> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.inner.fmt(formatter)
    }
}
impl<F> Clone for Vector<F> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<F> Copy for Vector<F> {}
impl<F> PartialEq for Vector<F> {
    fn eq(&self, other: &Self) -> bool {
        self.inner == other.inner
    }
}

impl<A, B, C> Mul<Pose<B, C>> for Pose<A, B> {
    type Output = Pose<A, C>;
    fn mul(self, right: Pose<B, C>) -> Pose<A, C> {
        Pose::wrap(self.inner * right.inner)
    }
}

impl<A, B> Mul<Point<B>> for Pose<A, B> {
    type Output = Point<A>;
    fn mul(self, right: Point<B>) -> Point<A> {
        Point::wrap(self.inner * right.inner)
    }
}

impl<A, B> Mul<Vector<B>> for Pose<A, B> {
    type Output = Vector<A>;
    fn mul(self, right: Vector<B>) -> Vector<A> {
        Vector::wrap(self.inner.rotation * right.inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Camera, Robot, World};
    use proptest::prelude::*;

    fn pose<T, S>() -> impl Strategy<Value = Pose<T, S>> {
        (
            prop::array::uniform3(-5.0..5.0),
            prop::array::uniform3(-3.0..3.0),
        )
            .prop_map(|(t, r)| Pose::wrap(Isometry3::new(Vector3::from(t), Vector3::from(r))))
    }

    proptest! {
        #[test]
        fn a_pose_times_its_inverse_is_the_identity(world_from_robot in pose::<World, Robot>()) {
            let product = (world_from_robot * world_from_robot.inverse()).inner;
            prop_assert!(product.translation.vector.norm() < 1e-12);
            prop_assert!(product.rotation.angle() < 1e-7);
        }

        #[test]
        fn composing_then_applying_equals_applying_twice(
            world_from_robot in pose::<World, Robot>(),
            robot_from_camera in pose::<Robot, Camera>(),
            xyz in prop::array::uniform3(-3.0..3.0),
        ) {
            let point = Point::<Camera>::new(xyz[0], xyz[1], xyz[2]);
            let once = (world_from_robot * robot_from_camera) * point;
            let twice = world_from_robot * (robot_from_camera * point);
            prop_assert!((once.inner - twice.inner).norm() < 1e-12);
        }

        #[test]
        fn yaw_is_read_back(yaw in -3.1..3.1f64) {
            prop_assert!((Pose::<World, Robot>::from_yaw(1.0, 2.0, 3.0, yaw).yaw_rad() - yaw).abs() < 1e-12);
        }
    }
}
