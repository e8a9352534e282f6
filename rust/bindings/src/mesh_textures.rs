//! Pictures on meshes.

use mapping::{ElevationConfig, MeshConfig};
use meshes::{JoiningRule, TextureView, textured};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use sensing::PinholeCamera;

use crate::error::{parse, run};
use crate::mesh_files::{MeshArrays, mesh_of, surface_arrays};
use crate::pose::rigid;

/// The tables that matter.
#[derive(serde::Deserialize, Default)]
#[serde(default)]
struct MeshTables {
    mesh: MeshConfig,
    elevation: ElevationConfig,
}

/// Focal length along columns and rows, column and row of the optical axis, pixels; where the camera was, (4, 4); depths, (h, w) m along the
/// optical axis, NaN for not seen.
type View<'py> = (
    [f64; 2],
    [f64; 2],
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f32>>,
);
/// Corners and triangles; of each corner the number of its picture, (n,), -1 where none saw it, and column and row in that, (n, 2).
type Textured<'py> = (
    MeshArrays<'py>,
    Bound<'py, PyArray1<i32>>,
    Bound<'py, PyArray2<f32>>,
);

/// The mesh, each triangle with the picture that saw it best: where triangles beside each other show different ones, each has corners of its
/// own. `settings` is JSON, the tables `mesh` and `elevation` of `[navigation]`.
#[pyfunction]
#[pyo3(signature = (corners, triangles, views, *, settings="{}"))]
pub(crate) fn textured_mesh<'py>(
    py: Python<'py>,
    corners: &Bound<'py, PyArray2<f32>>,
    triangles: &Bound<'py, PyArray2<u32>>,
    views: Vec<View<'py>>,
    settings: &str,
) -> PyResult<Textured<'py>> {
    let tables: MeshTables = parse(py, settings)?;
    let rule = JoiningRule::new(&tables.mesh.joining, tables.elevation.noise());
    let mesh = mesh_of(&corners.readonly(), &triangles.readonly())?;
    let views: Vec<TextureView> = views.into_iter().map(view).collect::<PyResult<_>>()?;
    let found = run(py, || textured(&mesh, &views, &rule))?;
    let numbers = found.views.iter();
    let numbers: Vec<i32> = numbers
        .map(|view| view.map_or(-1, |number| number as i32))
        .collect();
    let count = numbers.len();
    let at_px = found.at_px.into_flattened().into_pyarray(py);
    let Some(arrays) = surface_arrays(py, Some(found.mesh))? else {
        return Err(PyValueError::new_err("no mesh"));
    };
    Ok((arrays, numbers.into_pyarray(py), at_px.reshape([count, 2])?))
}

fn view((focal_px, centre_px, pose, depths): View<'_>) -> PyResult<TextureView> {
    let depths = depths.readonly();
    let [height, width] = depths.as_array().dim().into();
    let camera = PinholeCamera {
        size_px: [width, height],
        focal_px,
        centre_px,
    };
    let points = camera.points(depths.as_slice()?.iter().copied());
    let range_m = |[x, y, z]: [f32; 3]| (x * x + y * y + z * z).sqrt();
    let ranges_m = points.map(range_m).collect();
    let pose = rigid::<(), ()>(&pose.readonly())?;
    Ok(TextureView {
        ranges_m,
        map_from_camera: pose.inner,
        camera,
    })
}
