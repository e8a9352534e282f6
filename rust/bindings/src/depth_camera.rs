//! The simulator's depth camera: a scene of plain arrays, made once, and a picture a frame. Nothing of the core uses it.

use numpy::{PyArray1, PyArray2, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use simulated_senses::{
    CameraPose, DepthRaster, Form, Geom, GeomPoses, HeightField, Mesh, RasterConfig, TrueScene,
};

use crate::depth_errors::{PyDepthErrors, by_row, pinhole, values, viewpoint};
use crate::error::{bad_setting, run};

/// Depths and which body was met, (h, w) each.
type Cast<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<i32>>);
/// Vertices, (n, 3) m, and faces, (m, 3).
type MeshArrays<'py> = (Bound<'py, PyArray2<f32>>, Bound<'py, PyArray2<i32>>);
/// Heights, (rows, columns) shares of the greatest, and sizes: half along x and y, greatest height, base, m.
type FieldArrays<'py> = (Bound<'py, PyArray2<f32>>, [f64; 4]);

/// A camera whose every pixel is a real ray into a scene.
#[pyclass(name = "DepthCamera", module = "treadwell._core")]
pub(crate) struct PyDepthCamera {
    scene: TrueScene,
    raster: DepthRaster,
    size: [usize; 2],
}

#[pymethods]
impl PyDepthCamera {
    /// A camera of `width` by `height` pixels and a focal length in pixels, for bodies of these types (n,), half sizes (n, 3) m,
    /// whether rays meet them (n,), and data (n,): which mesh or height field it is, else -1. Types are the simulator's: 0 plane,
    /// 1 height field, 2 sphere, 3 capsule, 4 ellipsoid, 5 cylinder, 6 box, 7 mesh; others are `unknown`.
    #[new]
    #[expect(
        clippy::too_many_arguments,
        reason = "one keyword argument of Python's each"
    )]
    #[pyo3(signature = (types, sizes, seen, data, meshes, height_fields, *, width, height, focal))]
    fn new(
        py: Python<'_>,
        types: &Bound<'_, PyArray1<i32>>,
        sizes: &Bound<'_, PyArray2<f64>>,
        seen: &Bound<'_, PyArray1<bool>>,
        data: &Bound<'_, PyArray1<i32>>,
        meshes: Vec<MeshArrays<'_>>,
        height_fields: Vec<FieldArrays<'_>>,
        width: usize,
        height: usize,
        focal: f64,
    ) -> PyResult<Self> {
        let pinhole = pinhole(py, width, height, focal)?;
        let meshes: Vec<Mesh> = meshes
            .into_iter()
            .enumerate()
            .map(|(index, arrays)| mesh(py, index, &arrays))
            .collect::<PyResult<_>>()?;
        let fields: Vec<HeightField> = height_fields
            .into_iter()
            .enumerate()
            .map(|(index, (heights, size))| {
                let columns = heights.shape()[1];
                HeightField::new(index, &values("heights", &heights)?, columns, size)
                    .map_err(|error| bad_setting(py, &error))
            })
            .collect::<PyResult<_>>()?;
        let count = types.len();
        let (sizes, seen, data) = (sizes.readonly(), seen.readonly(), data.readonly());
        let types = types.readonly();
        if sizes.as_array().dim() != (count, 3) || seen.len() != count || data.len() != count {
            return Err(PyValueError::new_err(
                "types, sizes, seen and data must be one a body",
            ));
        }
        let (types, sizes) = (types.as_array(), sizes.as_array());
        let bodies = (0..count).map(|i| Geom {
            form: form(
                types[i],
                [sizes[[i, 0]], sizes[[i, 1]], sizes[[i, 2]]],
                usize::try_from(data.as_array()[i]).unwrap_or(usize::MAX),
            ),
            seen: seen.as_array()[i],
        });
        let scene = TrueScene::new(bodies.collect(), meshes, fields);
        Ok(Self {
            scene: scene.map_err(|error| bad_setting(py, &error))?,
            raster: DepthRaster::new(RasterConfig::default(), &pinhole),
            size: [height, width],
        })
    }

    /// The bodies that rays would meet, but whose type is not known here.
    #[getter]
    fn unknown(&self) -> Vec<usize> {
        self.scene.unknown()
    }

    /// (h, w) depth along the axis, m, NaN where nothing is met, and (h, w) the body that is, -1 for none. Bodies are at `positions`
    /// (n, 3) m and `rotations` (n, 9), world from body; the camera is at `position` (3,), its `rotation` (3, 3) is world from
    /// optical frame. `others` are depths and bodies that were cast elsewhere.
    #[expect(clippy::too_many_arguments, reason = "one argument of Python's each")]
    #[pyo3(signature = (positions, rotations, position, rotation, *, others=None))]
    fn cast<'py>(
        &mut self,
        py: Python<'py>,
        positions: &Bound<'py, PyArray2<f64>>,
        rotations: &Bound<'py, PyArray2<f64>>,
        position: [f64; 3],
        rotation: &Bound<'py, PyArray2<f64>>,
        others: Option<Cast<'py>>,
    ) -> PyResult<Cast<'py>> {
        let view = viewpoint(position, rotation)?;
        self.draw(py, positions, rotations, &view, others)?;
        let depth = PyArray2::<f64>::zeros(py, self.size, false);
        self.raster.write_depth(
            depth
                .readwrite()
                .as_slice_mut()
                .map_err(|_| by_row("depth"))?,
        );
        let bodies = PyArray1::from_slice(py, self.raster.picture().body());
        Ok((depth, bodies.reshape(self.size)?))
    }

    /// (h, w) float32: the depth that a camera with these errors measures, m along the axis, NaN for none; arguments as for `cast`.
    #[expect(clippy::too_many_arguments, reason = "one argument of Python's each")]
    #[pyo3(signature = (positions, rotations, position, rotation, errors, *, others=None))]
    fn see<'py>(
        &mut self,
        py: Python<'py>,
        positions: &Bound<'py, PyArray2<f64>>,
        rotations: &Bound<'py, PyArray2<f64>>,
        position: [f64; 3],
        rotation: &Bound<'py, PyArray2<f64>>,
        errors: &mut PyDepthErrors,
        others: Option<Cast<'py>>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let view = viewpoint(position, rotation)?;
        self.draw(py, positions, rotations, &view, others)?;
        errors.measured(py, self.raster.picture(), &view, self.size)
    }
}

impl PyDepthCamera {
    fn draw(
        &mut self,
        py: Python<'_>,
        positions: &Bound<'_, PyArray2<f64>>,
        rotations: &Bound<'_, PyArray2<f64>>,
        view: &CameraPose,
        others: Option<Cast<'_>>,
    ) -> PyResult<()> {
        let (positions, rotations) = (positions.readonly(), rotations.readonly());
        let poses = GeomPoses {
            positions_m: positions.as_slice().map_err(|_| by_row("positions"))?,
            rotations: rotations.as_slice().map_err(|_| by_row("rotations"))?,
        };
        let Self { scene, raster, .. } = self;
        run(py, || raster.draw(scene, &poses, view))?
            .map_err(|error| PyValueError::new_err(error.to_string()))?;
        let Some((depth, body)) = others else {
            return Ok(());
        };
        let (depth, body) = (depth.readonly(), body.readonly());
        let depth = depth.as_slice().map_err(|_| by_row("others"))?;
        let body = body.as_slice().map_err(|_| by_row("others"))?;
        raster
            .picture_mut()
            .merge(depth, body)
            .map_err(|error| PyValueError::new_err(error.to_string()))
    }
}

fn mesh(py: Python<'_>, index: usize, (vertices, faces): &MeshArrays<'_>) -> PyResult<Mesh> {
    let vertices = values("vertices", vertices)?;
    let faces = values("faces", faces)?;
    // What is below 0 is no vertex either.
    let faces: Vec<[u32; 3]> = faces
        .as_chunks::<3>()
        .0
        .iter()
        .map(|face| face.map(|vertex| u32::try_from(vertex).unwrap_or(u32::MAX)))
        .collect();
    run(py, || Mesh::new(index, vertices.as_chunks::<3>().0, &faces))?
        .map_err(|error| bad_setting(py, &error))
}

/// The form of a body by its type, half sizes and data.
const fn form(kind: i32, [x, y, z]: [f64; 3], data: usize) -> Form {
    match kind {
        0 => Form::Plane([x, y]),
        1 => Form::HeightField(data),
        2 => Form::Sphere(x),
        3 => Form::Capsule(x, y),
        4 => Form::Ellipsoid([x, y, z]),
        5 => Form::Cylinder(x, y),
        6 => Form::Cuboid([x, y, z]),
        7 => Form::Mesh(data),
        _ => Form::Unknown,
    }
}
