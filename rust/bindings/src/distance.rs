//! The planner's distance transform, alone.

use geometry::distance::CellDistances;
use numpy::{Element, IntoPyArray, PyArray2, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// (rows, columns) uint32: squared distance in cells from each to the nearest that is blocked, 2^29 where none is.
#[pyfunction]
#[pyo3(signature = (blocked, /))]
pub(crate) fn squared_distances<'py>(
    py: Python<'py>,
    blocked: &Bound<'_, PyArray2<bool>>,
) -> PyResult<Bound<'py, PyArray2<u32>>> {
    transformed(py, blocked, |cells, cols| {
        let mut field = CellDistances::default();
        field.compute(cells, cols);
        field.squared
    })
}

/// (rows, columns) float32: the roots of `squared_distances`, in cells.
#[pyfunction]
#[pyo3(signature = (blocked, /))]
pub(crate) fn distances<'py>(
    py: Python<'py>,
    blocked: &Bound<'_, PyArray2<bool>>,
) -> PyResult<Bound<'py, PyArray2<f32>>> {
    transformed(py, blocked, |cells, cols| {
        let mut roots = Vec::new();
        CellDistances::default().compute_roots(cells, cols, &mut roots);
        roots
    })
}

fn transformed<'py, T: Element + Send>(
    py: Python<'py>,
    blocked: &Bound<'_, PyArray2<bool>>,
    transform: impl FnOnce(&[bool], usize) -> Vec<T> + Send,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    let [rows, cols] = [blocked.shape()[0], blocked.shape()[1]];
    let blocked = blocked.readonly();
    let cells = blocked
        .as_slice()
        .map_err(|_| PyValueError::new_err("blocked must lie row by row in memory"))?;
    let field = py.detach(|| transform(cells, cols));
    field.into_pyarray(py).reshape([rows, cols])
}
