//! What a user's planner and behaviour are told: the goal, the scan, the situation.

use behaviour::Situation;
use mapping::FloorView;
use numpy::{IntoPyArray, PyArray2, PyArray3, PyArrayMethods, ToPyArray};
use planning::Goal;
use pyo3::prelude::*;

use crate::floor_view::PyFloorView;
use crate::products::{FlatPose, flat, matrix};
use crate::stairs::{PyClimb, PyStaircase, PyStepping};

/// Where to go: any place inside the disc on which the robot can stand.
#[pyclass(frozen, get_all, name = "Goal", module = "treadwell._core")]
pub(crate) struct PyGoal {
    /// (x, y) m: the disc's centre in the map frame.
    position: (f64, f64),
    /// The disc's radius, m.
    radius: f64,
    /// Height of the level, m, or None.
    height: Option<f64>,
}

#[pymethods]
impl PyGoal {
    #[new]
    #[pyo3(signature = (position, radius, height=None))]
    const fn new(position: (f64, f64), radius: f64, height: Option<f64>) -> Self {
        Self {
            position,
            radius,
            height,
        }
    }

    fn __repr__(&self) -> String {
        let ((x, y), radius) = (self.position, self.radius);
        let height = (self.height).map_or_else(String::new, |m| format!(", height {m:.3} m"));
        format!("<Goal at ({x:.2}, {y:.2}) m, radius {radius} m{height}>")
    }
}

impl From<&Goal> for PyGoal {
    fn from(goal: &Goal) -> Self {
        Self {
            position: (goal.x_m, goal.y_m),
            radius: goal.radius_m,
            height: goal.height_m,
        }
    }
}

/// A depth image with where the joints say that the camera was.
#[pyclass(frozen, name = "Scan", module = "treadwell._core")]
pub(crate) struct PyScan(pub(crate) sensing::Scan);

#[pymethods]
impl PyScan {
    fn __repr__(&self) -> String {
        let (camera, at_s) = (self.0.camera, 1e-9 * self.0.exposure_ns as f64);
        format!(
            "<Scan of {} x {} pixels at {at_s:.2} s>",
            camera.height, camera.width
        )
    }

    /// When the picture was taken, nanoseconds since the start.
    #[getter]
    fn exposure_ns(&self) -> u64 {
        self.0.exposure_ns
    }

    /// (h, w) float32: disparities, pixels; NaN where nothing was seen.
    #[getter]
    fn disparity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let camera = self.0.camera;
        self.0
            .disparity_px
            .to_pyarray(py)
            .reshape([camera.height, camera.width])
    }

    /// (h, w) float32: depths along the optical axis, m; NaN where nothing was seen.
    #[getter]
    fn depth<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let camera = self.0.camera;
        self.0
            .depths_m()
            .collect::<Vec<_>>()
            .into_pyarray(py)
            .reshape([camera.height, camera.width])
    }

    /// (h, w, 3) float32: the points of the pixels in the camera's frame, m: x right, y down, z forward; NaN where nothing was seen.
    #[getter]
    fn points_in_camera<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f32>>> {
        let camera = self.0.camera;
        let points: Vec<[f32; 3]> = (self.0.depths_m().enumerate())
            .map(|(at, depth_m)| {
                camera
                    .ray(at % camera.width, at / camera.width)
                    .map(|along| (along * f64::from(depth_m)) as f32)
            })
            .collect();
        points
            .into_flattened()
            .into_pyarray(py)
            .reshape([camera.height, camera.width, 3])
    }

    /// Columns of the picture.
    #[getter]
    fn width(&self) -> usize {
        self.0.camera.width
    }

    /// Rows of the picture.
    #[getter]
    fn height(&self) -> usize {
        self.0.camera.height
    }

    /// Focal length along the columns, pixels.
    #[getter]
    fn fx(&self) -> f64 {
        self.0.camera.focal_px
    }

    /// Focal length along the rows, pixels.
    #[getter]
    fn fy(&self) -> f64 {
        self.0.camera.focal_px
    }

    /// Column at which the optical axis meets the picture, pixels; pixel centres are at whole numbers.
    #[getter]
    fn cx(&self) -> f64 {
        self.0.camera.principal_point_px().0
    }

    /// Row at which the optical axis meets the picture, pixels.
    #[getter]
    fn cy(&self) -> f64 {
        self.0.camera.principal_point_px().1
    }

    /// Focal length of both, pixels.
    #[getter]
    fn focal(&self) -> f64 {
        self.0.camera.focal_px
    }

    /// Distance between the eyes, m.
    #[getter]
    fn baseline(&self) -> f64 {
        self.0.camera.baseline_m
    }

    /// (4, 4): the camera in the robot's frame by the measured joints.
    #[getter]
    fn robot_from_camera<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        matrix(py, &self.0.robot_from_camera)
    }
}

/// Everything a decision may rest on.
#[pyclass(frozen, name = "Situation", module = "treadwell._core")]
pub(crate) struct PySituation {
    /// Nanoseconds since the start.
    #[pyo3(get)]
    time_ns: u64,
    /// (x m, y m, z m, yaw rad) of the robot in the map, as believed.
    #[pyo3(get)]
    estimate: FlatPose,
    /// (x, y) m of the goal that is pursued now.
    #[pyo3(get)]
    goal: (f64, f64),
    /// Its radius, m.
    #[pyo3(get)]
    goal_radius: f64,
    /// Whether it is the last one.
    #[pyo3(get)]
    last_goal: bool,
    /// Points of the way, m; None where no way is known.
    #[pyo3(get)]
    path: Option<Vec<(f64, f64)>>,
    /// Why there is no way, else None.
    #[pyo3(get)]
    no_way: Option<String>,
    /// Whether the walker stands still on both soles.
    #[pyo3(get)]
    standing: bool,
    /// (pan to the left, down from the horizon) rad: where the head looks.
    #[pyo3(get)]
    gaze: (f64, f64),
    /// Depth frames taken into the map so far.
    #[pyo3(get)]
    frames_used: u64,
    /// The stairs that are seen or remembered.
    #[pyo3(get)]
    stairs: PyStaircase,
    /// The way's legs that are climbed, in their order; empty where no way is known.
    #[pyo3(get)]
    climbs: Vec<PyClimb>,
    /// Whether the walker takes listed footsteps. One that lists them for a walker that does not refuses.
    #[pyo3(get)]
    takes_footsteps: bool,
    /// How the listed footsteps go.
    #[pyo3(get)]
    stepping: PyStepping,
    view: FloorView,
}

impl PySituation {
    pub(crate) fn new(situation: &Situation<'_>) -> Self {
        let pose = &situation.estimate.map_from_robot;
        let way = situation.plan.map(|plan| plan.way.as_ref());
        let path = way.and_then(Result::ok);
        Self {
            time_ns: situation.time_ns,
            estimate: flat(pose),
            goal: (situation.goal.x_m, situation.goal.y_m),
            goal_radius: situation.goal.radius_m,
            last_goal: situation.last_goal,
            path: path.map(|path| path.points_m.iter().map(|&[x, y]| (x, y)).collect()),
            no_way: way
                .and_then(Result::err)
                .map(|no| format!("{}: {}", no.refusal.word(), no.sentence)),
            standing: situation.standing,
            gaze: (situation.gaze.pan_rad, situation.gaze.down_rad),
            frames_used: situation.frames_used,
            view: situation.view.clone(),
            stairs: situation.stairs.into(),
            climbs: path.map_or_else(Vec::new, |path| {
                path.climbs.iter().map(PyClimb::from).collect()
            }),
            takes_footsteps: situation.takes_footsteps,
            stepping: situation.stepping.into(),
        }
    }
}

#[pymethods]
impl PySituation {
    /// The map's view; a copy.
    fn view(&self) -> PyFloorView {
        PyFloorView(self.view.clone())
    }
}
