//! A frame's camera: where it was predicted, and how it is tilted against that.

use geometry::{Camera, Pose, Robot};
use nalgebra::{Rotation3, Vector2, Vector3};
use sensing::Intrinsics;

use crate::picture::{View, levelling};

/// A frame's camera: where it was predicted, and the tilt found on top.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Levelled {
    /// Whether what is near the feet told it, or bears it out.
    pub(crate) near: bool,
    pub(crate) predicted: Pose<Robot, Camera>,
    pub(crate) tilt: Vector2<f64>,
    pub(crate) view: View,
}

impl Levelled {
    pub(crate) fn new(
        camera: &Intrinsics,
        predicted: Pose<Robot, Camera>,
        tilt: Vector2<f64>,
    ) -> Self {
        let rotation = levelling(tilt.x, tilt.y) * predicted.inner.rotation.to_rotation_matrix();
        Self {
            near: false,
            predicted,
            tilt,
            view: View::new(camera, &rotation),
        }
    }

    /// The turn from the predicted camera to the levelled one, robot's axes.
    pub(crate) fn turn(&self) -> Rotation3<f64> {
        levelling(self.tilt.x, self.tilt.y)
    }

    /// The tilt on top of the prediction after a further one was found in the levelled axes.
    pub(crate) fn further(&self, tilt: &Vector2<f64>) -> Vector2<f64> {
        let up = self.turn().inverse() * Vector3::new(tilt.x, tilt.y, 1.0);
        Vector2::new(up.x / up.z, up.y / up.z)
    }
}
