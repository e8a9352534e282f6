//! Room along a way, for judging: the sweep of a disc past an outline.

use geometry::Outline;
use nalgebra::Point2;
use numpy::{PyArray2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

fn rows(array: &Bound<'_, PyArray2<f64>>, name: &str) -> PyResult<Vec<[f64; 2]>> {
    let array = array.readonly();
    let array = array.as_array();
    if array.ncols() != 2 || array.iter().any(|value| !value.is_finite()) {
        return Err(PyValueError::new_err(format!(
            "{name} must be (n, 2) and finite, got {:?}",
            array.dim()
        )));
    }
    Ok(array
        .rows()
        .into_iter()
        .map(|row| [row[0], row[1]])
        .collect())
}

/// Room (m) that a disc has to a convex outline on its way along `path` (n, 2); negative where it touches.
#[pyfunction]
pub(crate) fn swept_clearance(
    path: &Bound<'_, PyArray2<f64>>,
    outline: &Bound<'_, PyArray2<f64>>,
    radius: f64,
) -> PyResult<f64> {
    let corners: Vec<_> = rows(outline, "outline")?
        .into_iter()
        .map(Point2::from)
        .collect();
    let outline =
        Outline::hull(&corners).map_err(|error| PyValueError::new_err(error.to_string()))?;
    Ok(outline.swept_clearance_m(&rows(path, "path")?, radius))
}
