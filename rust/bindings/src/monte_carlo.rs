//! Monte Carlo localization of a depth camera in a map of the user's own.

use std::sync::Arc;

use geometry::Camera;
use known_map::{KnownMap, KnownMapConfig};
use localization::{CameraLocalizer, MonteCarloConfig};
use numpy::{PyArray2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use sensing::PinholeCamera;

use crate::error::{bad_setting, parse, run};
use crate::octree::PyOctree;
use crate::pose::rigid;
use crate::products::matrix;

/// The tables that a user may set.
#[derive(serde::Deserialize, Default)]
#[serde(default, deny_unknown_fields)]
struct Tables {
    monte_carlo: MonteCarloConfig,
    static_map: KnownMapConfig,
}

/// (4, 4) map from camera, standard deviations, m and rad, and whether the camera is lost.
type Found<'py> = (Bound<'py, PyArray2<f64>>, f64, f64, bool);

/// Follows a depth camera through a map, or finds it there. `settings` is JSON: the tables `monte_carlo` and `static_map` of `[navigation]`.
#[pyclass(name = "MonteCarlo", module = "treadwell._core")]
pub(crate) struct PyMonteCarlo {
    localizer: CameraLocalizer,
    size: [usize; 2],
}

#[pymethods]
impl PyMonteCarlo {
    /// `size` is width and height, `focal` and `centre` are along columns and rows, pixels; `start`, (4, 4), is map from camera.
    #[new]
    #[expect(
        clippy::too_many_arguments,
        reason = "one keyword argument of Python's each"
    )]
    #[pyo3(signature = (octree, *, size, focal, centre, start=None, settings="{}"))]
    fn new(
        py: Python<'_>,
        octree: &PyOctree,
        size: [usize; 2],
        focal: [f64; 2],
        centre: [f64; 2],
        start: Option<&Bound<'_, PyArray2<f64>>>,
        settings: &str,
    ) -> PyResult<Self> {
        let tables: Tables = parse(py, settings)?;
        let camera = PinholeCamera {
            size_px: size,
            focal_px: focal,
            centre_px: centre,
        };
        let start = start.map(|pose| rigid(&pose.readonly())).transpose()?;
        let tree = Arc::clone(&octree.tree());
        let made = run(py, || {
            let map = KnownMap::new(tree, tables.static_map)?;
            CameraLocalizer::new(&map, camera, start, tables.monte_carlo)
        })?;
        Ok(Self {
            localizer: made.map_err(|error| bad_setting(py, &error))?,
            size,
        })
    }

    /// Takes in a depth picture, (h, w) float32 m, and how the camera moved since the last one, (4, 4) previous from current. None while
    /// nothing tells where it may be.
    fn update<'py>(
        &mut self,
        py: Python<'py>,
        depth: &Bound<'py, PyArray2<f32>>,
        previous_from_current: &Bound<'py, PyArray2<f64>>,
    ) -> PyResult<Option<Found<'py>>> {
        let depth = depth.readonly();
        let depth = depth.as_array();
        let [width, height] = self.size;
        if depth.dim() != (height, width) {
            return Err(PyValueError::new_err("the picture has another size"));
        }
        let moved = rigid::<Camera, Camera>(&previous_from_current.readonly())?;
        let localizer = &mut self.localizer;
        let found = run(py, || localizer.update(depth.iter().copied(), &moved.inner))?;
        Ok(found.map(|found| {
            let pose = matrix(py, &found.map_from_camera);
            (pose, found.spread_m, found.spread_rad, found.lost)
        }))
    }
}
