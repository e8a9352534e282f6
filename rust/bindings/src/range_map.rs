//! World models fed by range sensors of anyone's, whose poses are known.

use std::time::Instant;

use numpy::{PyArray2, PyArrayMethods};
use pilot::{ChosenSegmenter, PilotError, RangeMap, SightNeeds};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use sensing::{PinholeCamera, RangeSensor};
use stairs::Staircase;

use crate::components;
use crate::error::{bad_setting, failed, parse, run};
use crate::floor_view::PyFloorView;
use crate::mesh_files::{MeshArrays, surface_arrays};
use crate::octree::{Rows, rows};
use crate::pose::rigid;
use crate::products::PyPlanes;
use crate::stairs::PyStaircase;

/// Keeps a map of what range sensors of anyone's saw, as the pilot's world model of that name does. Their poses are trusted.
#[pyclass(name = "RangeMap", module = "treadwell._core")]
pub(crate) struct PyRangeMap {
    map: RangeMap,
    /// Time that the core itself took for the last frame, s.
    #[pyo3(get)]
    seconds: f64,
}

#[pymethods]
impl PyRangeMap {
    /// A world model of the list, or `model`, one of the user's. `settings` is JSON, a table a name; `headroom` is the robot's height, m,
    /// where there is a robot.
    #[new]
    #[pyo3(signature = (name, *, settings="{}", headroom=None, model=None))]
    fn new(
        py: Python<'_>,
        name: &str,
        settings: &str,
        headroom: Option<f64>,
        model: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
        let tables = parse(py, settings)?;
        let made = match model {
            Some(object) => Ok(RangeMap::of(components::world_model(object), tables)),
            None => RangeMap::new(name, tables, headroom),
        };
        Ok(Self {
            map: made.map_err(|error| bad_setting(py, &error))?,
            seconds: 0.0,
        })
    }

    /// Whether the model takes surfaces, which are found in pictures, and not points alone.
    #[getter]
    fn needs_surfaces(&self) -> bool {
        self.map.model.needs_surfaces()
    }

    /// Gives the pictures a camera: columns and rows, focal lengths and axis along them, pixels. Surfaces are found by the segmenter of
    /// that name, or by `own`, one of the user's, in blocks of `pool` x `pool` pixels, as precisely as eyes `baseline` m apart see them. With
    /// `stairs`, stairs are looked for.
    #[pyo3(signature = (size, focal, centre, *, segmenter, pool, baseline, stairs=false, own=None))]
    #[expect(clippy::too_many_arguments, reason = "one argument of Python's each")]
    fn set_camera(
        &mut self,
        py: Python<'_>,
        size: [usize; 2],
        focal: [f64; 2],
        centre: [f64; 2],
        segmenter: &str,
        pool: usize,
        baseline: f64,
        stairs: bool,
        own: Option<Py<PyAny>>,
    ) -> PyResult<()> {
        let positive = |value: &f64| value.is_finite() && *value > 0.0;
        let axis = centre.iter().all(|px| px.is_finite());
        if size.contains(&0) || !axis || !focal.iter().chain([&baseline]).all(positive) {
            let said = "a camera's size, focal and baseline must be > 0, its centre finite";
            return Err(PyValueError::new_err(said));
        }
        let camera = PinholeCamera {
            size_px: size,
            focal_px: focal,
            centre_px: centre,
        };
        let needs = SightNeeds {
            segmenter: own.map_or(ChosenSegmenter::Named(segmenter), |object| {
                ChosenSegmenter::Own(components::segmenter(object))
            }),
            pool,
            baseline_m: baseline,
            stairs,
        };
        let set = self.map.set_camera(camera, needs);
        set.map_err(|error| bad_setting(py, &error))
    }

    /// Takes in a depth image, (h, w) float32, metres along the optical axis, NaN for not seen, of the camera that was given;
    /// `map_from_sensor`, (4, 4), is where it was, `ground`, m, how high the ground below it is. Whether it was used.
    fn insert_depth(
        &mut self,
        py: Python<'_>,
        depth: &Bound<'_, PyArray2<f32>>,
        map_from_sensor: &Bound<'_, PyArray2<f64>>,
        ground: f64,
    ) -> PyResult<bool> {
        let depth = depth.readonly();
        let size = self.map.camera().map(|camera| camera.size_px);
        let [height, width] = depth.as_array().dim().into();
        if size != Some([width, height]) {
            let said = format!(
                "the camera's columns and rows are {size:?}, the image's {width} and {height}"
            );
            return Err(PyValueError::new_err(said));
        }
        let (depths_m, pose) = (depth.as_slice()?, rigid(&map_from_sensor.readonly())?);
        self.timed(py, |map| map.insert_depths(depths_m, &pose, ground))
    }

    /// Takes in points of a sensor, (n, 3) float32 m in its frame, all seen from its origin; `map_from_sensor`, (4, 4), is where it was,
    /// `ground`, m, how high the ground below it is. Whether they were used.
    fn insert_points(
        &mut self,
        py: Python<'_>,
        points: &Bound<'_, PyArray2<f32>>,
        map_from_sensor: &Bound<'_, PyArray2<f64>>,
        ground: f64,
    ) -> PyResult<bool> {
        let points = points.readonly();
        if points.as_array().ncols() != 3 {
            return Err(PyValueError::new_err("points must be (n, 3)"));
        }
        let (points, _) = points.as_slice()?.as_chunks::<3>();
        let pose = rigid(&map_from_sensor.readonly())?;
        self.timed(py, |map| {
            map.insert_points(points, RangeSensor::Cloud, &pose, ground)
        })
    }

    /// The map's view; a copy.
    fn view(&self) -> PyFloorView {
        PyFloorView(self.map.model.view().clone())
    }

    /// What was found in the last picture; None before it, and of a world model that has no use for surfaces.
    fn planes(&self) -> Option<PyPlanes> {
        self.map.planes().cloned().map(PyPlanes)
    }

    /// The stairs that were seen; None where they are not looked for.
    fn staircase(&self) -> Option<PyStaircase> {
        self.map.staircase().map(PyStaircase::from)
    }

    /// (n, 3) m and (n,) m: middles and sides of the cubes that were seen to be occupied; empty of a world model that keeps none.
    fn occupied<'py>(&self, py: Python<'py>) -> PyResult<Rows<'py>> {
        let voxels = self.map.model.occupied();
        let split = voxels.iter().map(|voxel| (voxel.centre_m, voxel.side_m));
        rows(py, split.unzip())
    }

    /// (n, 3) m and (m, 3): corners and triangles of the surface; none of a world model that keeps no surface.
    fn surface<'py>(&self, py: Python<'py>) -> PyResult<Option<MeshArrays<'py>>> {
        surface_arrays(py, self.map.model.surface())
    }
}

impl PyRangeMap {
    /// The stairs that were seen, where they are looked for.
    pub(crate) fn seen_stairs(&self) -> Option<&Staircase> {
        self.map.staircase()
    }

    fn timed(
        &mut self,
        py: Python<'_>,
        work: impl FnOnce(&mut RangeMap) -> Result<bool, PilotError> + Send,
    ) -> PyResult<bool> {
        let (map, started) = (&mut self.map, Instant::now());
        let used = run(py, || work(map))?.map_err(|error| failed(py, &error))?;
        self.seconds = started.elapsed().as_secs_f64();
        Ok(used)
    }
}
