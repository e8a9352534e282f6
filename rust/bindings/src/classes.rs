//! What the points of a cloud are: ground or not; scatter, line or surface.

use classification::{GroundFilter, GroundFilterConfig, MomentsConfig, Point3, PointClasses};
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

/// (n,) uint8: what each point of a cloud (n, 3), in metres, belongs to by the shape of what is around it: 0 too few points near, 1
/// scatter (bushes, grass), 2 a line (wires, branches), 3 a surface. `settings` is JSON: `[classification.moments]`.
#[pyfunction]
#[pyo3(signature = (points, settings="{}"))]
pub(crate) fn point_classes<'py>(
    py: Python<'py>,
    points: &Bound<'_, PyArray2<f64>>,
    settings: &str,
) -> PyResult<Bound<'py, PyArray1<u8>>> {
    let config: MomentsConfig = parse(py, settings)?;
    let classes = PointClasses::new(config).map_err(|error| bad_setting(py, &error))?;
    let points = cloud(points)?;
    let found = run(py, || classes.classify(&points))?.map_err(|error| bad_setting(py, &error))?;
    let numbers: Vec<u8> = found.into_iter().map(|class| class as u8).collect();
    Ok(numbers.into_pyarray(py))
}
