//! The planner's distance transform, alone.

use geometry::distance::CellDistances;
use numpy::{IntoPyArray, PyArray2, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// (rows, columns) uint32: squared distance in cells from each to the nearest that is blocked, 2^29 where none is.
#[pyfunction]
#[pyo3(signature = (blocked, /))]
pub(crate) fn squared_distances<'py>(
    py: Python<'py>,
    blocked: &Bound<'_, PyArray2<bool>>,
) -> PyResult<Bound<'py, PyArray2<u32>>> {
    let [rows, cols] = [blocked.shape()[0], blocked.shape()[1]];
    let blocked = blocked.readonly();
    let cells = blocked
        .as_slice()
        .map_err(|_| PyValueError::new_err("blocked must lie row by row in memory"))?;
    let field = py.detach(|| {
        let mut field = CellDistances::default();
        field.compute(cells, cols);
        field
    });
    field.squared.into_pyarray(py).reshape([rows, cols])
}
