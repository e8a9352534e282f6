//! What the points of a cloud are: ground or not.

use classification::{GroundFilter, GroundFilterConfig, Point3};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::error::{bad_setting, parse, run};

fn cloud(points: &Bound<'_, PyArray2<f64>>) -> PyResult<Vec<Point3>> {
    let points = points.readonly();
    let points = points.as_array();
    if points.ncols() != 3 {
        return Err(PyValueError::new_err(format!(
            "points must be (n, 3), got {:?}",
            points.dim()
        )));
    }
    Ok((points.rows().into_iter())
        .map(|row| [row[0], row[1], row[2]])
        .collect())
}

/// (n,) bool: which points of a cloud (n, 3), in metres and seen from above, are ground. `settings` is JSON:
/// `[classification.ground_filter]`.
#[pyfunction]
#[pyo3(signature = (points, settings="{}"))]
pub(crate) fn ground_points<'py>(
    py: Python<'py>,
    points: &Bound<'_, PyArray2<f64>>,
    settings: &str,
) -> PyResult<Bound<'py, PyArray1<bool>>> {
    let config: GroundFilterConfig = parse(py, settings)?;
    let filter = GroundFilter::new(config).map_err(|error| bad_setting(py, &error))?;
    let points = cloud(points)?;
    let ground = run(py, || filter.filter(&points))?.map_err(|error| bad_setting(py, &error))?;
    Ok(ground.is_ground.into_pyarray(py))
}
