//! How the torso turns over the foot that carries it.

use nalgebra::{UnitQuaternion, Vector3};

/// Turn of the torso against the sole that carries it since a tick before, in the torso's frame, as a rotation vector, rad.
pub(super) fn turn_rad(
    torso_from_sole_before: &UnitQuaternion<f64>,
    torso_from_sole: &UnitQuaternion<f64>,
) -> Vector3<f64> {
    (torso_from_sole_before * torso_from_sole.inverse()).scaled_axis()
}
