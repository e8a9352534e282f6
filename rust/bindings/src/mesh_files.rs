//! Meshes: arrays of corners and triangles, and files of them.

use mapping::TriangleMesh;
use meshes::{MeshLook, gltf_file, ply_file};
use numpy::{IntoPyArray, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// Corners and triangles.
pub(crate) type MeshArrays<'py> = (Bound<'py, PyArray2<f32>>, Bound<'py, PyArray2<u32>>);

/// (n, 3) m and (m, 3): corners and the numbers of each triangle's; none of a world model that keeps no surface.
pub(crate) fn surface_arrays(
    py: Python<'_>,
    surface: Option<TriangleMesh>,
) -> PyResult<Option<MeshArrays<'_>>> {
    let Some(mesh) = surface else {
        return Ok(None);
    };
    let (corners, triangles) = (mesh.corners_m.len(), mesh.triangles.len());
    let places = mesh.corners_m.into_flattened().into_pyarray(py);
    let numbers = mesh.triangles.into_flattened().into_pyarray(py);
    Ok(Some((
        places.reshape([corners, 3])?,
        numbers.reshape([triangles, 3])?,
    )))
}

/// A mesh as a file, `ply` or `gltf` (binary): corners (n, 3) m and triangles (m, 3), which hold numbers of corners.
#[pyfunction]
pub(crate) fn mesh_file<'py>(
    py: Python<'py>,
    to: &str,
    corners: &Bound<'py, PyArray2<f32>>,
    triangles: &Bound<'py, PyArray2<u32>>,
) -> PyResult<Bound<'py, PyBytes>> {
    let (corners, triangles) = (corners.readonly(), triangles.readonly());
    if corners.as_array().ncols() != 3 || triangles.as_array().ncols() != 3 {
        return Err(PyValueError::new_err(
            "corners and triangles must be (n, 3)",
        ));
    }
    let mesh = TriangleMesh {
        corners_m: corners.as_slice()?.as_chunks().0.to_vec(),
        triangles: triangles.as_slice()?.as_chunks().0.to_vec(),
    };
    let count = mesh.corners_m.len();
    let beyond = |corner: &u32| *corner as usize >= count;
    if mesh.triangles.as_flattened().iter().any(beyond) {
        return Err(PyValueError::new_err(
            "a triangle has a corner that is not there",
        ));
    }
    let file = match to {
        "ply" => ply_file(&mesh, MeshLook::Plain),
        "gltf" => gltf_file(&mesh, MeshLook::Plain)
            .map_err(|error| PyValueError::new_err(error.to_string()))?,
        _ => return Err(PyValueError::new_err("a mesh is written as ply or gltf")),
    };
    Ok(PyBytes::new(py, &file))
}
