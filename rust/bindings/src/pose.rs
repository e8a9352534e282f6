//! Poses that Python gives.

use geometry::Pose;
use nalgebra::{Isometry3, Matrix3, Matrix4, Rotation3, UnitQuaternion, Vector3};
use numpy::PyReadonlyArray2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// How far columns may be off having length one and being at right angles: what single precision and a product of some leave.
const NOT_SQUARE: f64 = 1e-3;

/// The pose of a (4, 4) matrix; its rotation is the nearest one.
pub(crate) fn rigid<T, S>(pose: &PyReadonlyArray2<'_, f64>) -> PyResult<Pose<T, S>> {
    let array = pose.as_array();
    if array.dim() != (4, 4) || array.iter().any(|value| !value.is_finite()) {
        return Err(PyValueError::new_err(
            "a camera's pose must be a finite (4, 4) matrix",
        ));
    }
    let matrix = Matrix4::from_fn(|row, col| array[(row, col)]);
    let turn = Matrix3::from(matrix.fixed_view::<3, 3>(0, 0));
    let off = (turn.transpose() * turn - Matrix3::identity()).abs().max();
    if off > NOT_SQUARE || turn.determinant() < 0.0 {
        return Err(PyValueError::new_err(
            "a camera's pose must have a rotation in its first three rows and columns",
        ));
    }
    let rotation = Rotation3::from_matrix(&turn);
    let translation = Vector3::from(matrix.fixed_view::<3, 1>(0, 3));
    Ok(Pose::wrap(Isometry3::from_parts(
        translation.into(),
        UnitQuaternion::from_rotation_matrix(&rotation),
    )))
}
