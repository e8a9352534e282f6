//! Meshes: arrays of corners and triangles, and files of them.

use mapping::TriangleMesh;
use meshes::{MeshLook, gltf_file, ply_file};
use numpy::{IntoPyArray, PyArray2, PyArrayMethods, PyReadonlyArray2};
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

/// The mesh of corners (n, 3) m and triangles (m, 3), which hold numbers of corners.
pub(crate) fn mesh_of(
    corners: &PyReadonlyArray2<'_, f32>,
    triangles: &PyReadonlyArray2<'_, u32>,
) -> PyResult<TriangleMesh> {
    if corners.as_array().ncols() != 3 || triangles.as_array().ncols() != 3 {
        let said = "corners and triangles must be (n, 3)";
        return Err(PyValueError::new_err(said));
    }
    let mesh = TriangleMesh {
        corners_m: corners.as_slice()?.as_chunks().0.to_vec(),
        triangles: triangles.as_slice()?.as_chunks().0.to_vec(),
    };
    let count = mesh.corners_m.len();
    let beyond = |corner: &u32| *corner as usize >= count;
    if mesh.triangles.as_flattened().iter().any(beyond) {
        let said = "a triangle has a corner that is not there";
        return Err(PyValueError::new_err(said));
    }
    Ok(mesh)
}

/// A mesh as a file, `ply` or `gltf` (binary): corners (n, 3) m and triangles (m, 3), which hold numbers of corners. With red, green and blue
/// of each corner, `colours` (n, 3), or with a picture as a PNG file and where each corner is in it, `places` (n, 2), from its left and upper
/// border, shares of its width and height.
#[pyfunction]
#[pyo3(signature = (to, corners, triangles, *, colours=None, picture=None))]
pub(crate) fn mesh_file<'py>(
    py: Python<'py>,
    to: &str,
    corners: &Bound<'py, PyArray2<f32>>,
    triangles: &Bound<'py, PyArray2<u32>>,
    colours: Option<&Bound<'py, PyArray2<u8>>>,
    picture: Option<(&[u8], Bound<'py, PyArray2<f32>>)>,
) -> PyResult<Bound<'py, PyBytes>> {
    let mesh = mesh_of(&corners.readonly(), &triangles.readonly())?;
    let wrong = |shape| Err(PyValueError::new_err(format!("{shape}, one row a corner")));
    let (count, colours) = (mesh.corners_m.len(), colours.map(PyArrayMethods::readonly));
    let (png, places) = picture.unzip();
    let places = places.map(|places| places.readonly());
    let look = match (&colours, png, &places) {
        (None, None, _) => MeshLook::Plain,
        (Some(colours), None, _) if colours.as_array().dim() == (count, 3) => {
            MeshLook::Colours(colours.as_slice()?.as_chunks().0)
        }
        (None, Some(png), Some(places)) if places.as_array().dim() == (count, 2) => {
            let places = places.as_slice()?.as_chunks().0;
            MeshLook::Picture { png, places }
        }
        _ => return wrong("either colours (n, 3) or a picture with places (n, 2)"),
    };
    let file = match to {
        "ply" => ply_file(&mesh, look),
        "gltf" => {
            gltf_file(&mesh, look).map_err(|error| PyValueError::new_err(error.to_string()))?
        }
        _ => return Err(PyValueError::new_err("a mesh is written as ply or gltf")),
    };
    Ok(PyBytes::new(py, &file))
}
