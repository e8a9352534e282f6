//! The pilot: an observation in, joint targets out, every product to look at.

use behaviour::Outcome;
use localization::Guess;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, ToPyArray};
use pilot::{Components, Pilot, STAGES, Settings};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sensing::{Frame, Observation};

use crate::components;
use crate::error::{bad_setting, failed, parse, run, unreadable};
use crate::floor_view::{Floor, PyFloorView, floor};
use crate::footsteps::{Ground, ground, planned_as_dict};
use crate::mesh_files::{MeshArrays, surface_arrays};
use crate::observation;
use crate::octree::{PyOctree, Rows, rows};
use crate::products::{FlatPose, PyPlanes, flat, matrix};
use crate::stairs::{FlatFootstep, PyClimb, PyStaircase, PyStepping, flat_footsteps};

/// Places, headings and weights.
type Guesses<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
);

/// Number, place m, velocity m/s, half of the width m, and whether it surely moves.
type FollowedThing = (u32, [f64; 2], [f64; 2], f64, bool);

/// The whole core: an observation in, joint targets out.
#[pyclass(name = "Pilot", module = "treadwell._core")]
pub(crate) struct PyPilot {
    pilot: Pilot,
    observation: Observation,
    spare: Option<Frame>,
}

/// What the core made of one observation.
#[pyclass(frozen, name = "Tick", module = "treadwell._core")]
pub(crate) struct PyTick {
    /// (n,) rad, joint order.
    #[pyo3(get)]
    positions: Py<PyArray1<f64>>,
    /// (n,) rad/s, joint order.
    #[pyo3(get)]
    velocities: Py<PyArray1<f64>>,
    /// (n,) N m, joint order, on top of the servo's own.
    #[pyo3(get)]
    torques: Py<PyArray1<f64>>,
    /// Name of the behaviour's state.
    #[pyo3(get)]
    state: &'static str,
    /// "goal_reached", "refused" or None.
    #[pyo3(get)]
    outcome: Option<&'static str>,
    /// `word: sentence` of a refusal, else None.
    #[pyo3(get)]
    reason: Option<String>,
    /// The steps that the feet are told to take: rows of `treadwell.protocols.Footstep`; empty where they walk or stand.
    #[pyo3(get)]
    footsteps: Vec<FlatFootstep>,
    /// (x m, y m, z m, yaw rad) of the robot in the map, as believed.
    #[pyo3(get)]
    estimate: FlatPose,
    /// Pose of the robot in the map by leg odometry alone, from the same start.
    #[pyo3(get)]
    odometry: FlatPose,
    /// Whether the localizer knows that it does not know where the robot is.
    #[pyo3(get)]
    lost: bool,
}

#[pymethods]
impl PyPilot {
    #[new]
    #[expect(
        clippy::too_many_arguments,
        reason = "one keyword argument of Python's each"
    )]
    #[pyo3(signature = (settings, *, static_map=None, segmenter=None, world_model=None, localizer=None, planner=None, behaviour=None, walker=None))]
    fn new(
        py: Python<'_>,
        settings: &str,
        static_map: Option<PyRef<'_, PyOctree>>,
        segmenter: Option<Py<PyAny>>,
        world_model: Option<Py<PyAny>>,
        localizer: Option<Py<PyAny>>,
        planner: Option<Py<PyAny>>,
        behaviour: Option<Py<PyAny>>,
        walker: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
        let settings: Settings = parse(py, settings)?;
        let walker = walker.map(|object| components::walker(py, object, &settings.robot));
        let given = Components {
            segmenter: segmenter.map(components::segmenter),
            world_model: world_model.map(components::world_model),
            localizer: localizer.map(components::localizer),
            planner: planner.map(components::planner),
            behaviour: behaviour.map(components::behaviour),
            walker: walker.transpose()?,
        };
        let static_map = static_map.map(|octree| octree.tree());
        // Before the first tick whatever is refused is what the user gave: a setting, the robot, the map.
        let pilot = run(py, || Pilot::new(&settings, static_map.as_ref(), given))?
            .map_err(|error| bad_setting(py, &error))?;
        Ok(Self {
            pilot,
            observation: observation::empty(),
            spare: None,
        })
    }

    /// Takes in an observation and says what the motors shall do.
    fn tick(&mut self, py: Python<'_>, observation: &Bound<'_, PyAny>) -> PyResult<PyTick> {
        observation::read(observation, &mut self.observation, &mut self.spare)
            .map_err(|error| unreadable(py, &error))?;
        let (pilot, observation) = (&mut self.pilot, &self.observation);
        let tick = run(py, || pilot.tick(observation))?.map_err(|error| failed(py, &error))?;
        let (outcome, reason) = match &tick.decision.outcome {
            None => (None, None),
            Some(Outcome::GoalReached) => (Some("goal_reached"), None),
            Some(Outcome::Refused(reason)) => (Some("refused"), Some(reason.clone())),
        };
        Ok(PyTick {
            positions: tick.targets.positions_rad.to_pyarray(py).unbind(),
            velocities: tick.targets.velocities_radps.to_pyarray(py).unbind(),
            torques: tick.targets.torques_nm.to_pyarray(py).unbind(),
            state: tick.decision.state,
            outcome,
            reason,
            footsteps: flat_footsteps(&tick.decision.command.motion),
            estimate: flat(&tick.estimate.map_from_robot),
            odometry: flat(&tick.dead_reckoning),
            lost: tick.estimate.lost,
        })
    }

    /// The planes of the last frame; a copy.
    fn planes(&self) -> PyPlanes {
        PyPlanes(self.pilot.perception.planes.clone())
    }

    /// The map's view; a copy.
    fn view(&self) -> PyFloorView {
        PyFloorView(self.pilot.perception.world_model.view().clone())
    }

    /// What the map's view says: corner (2,) m, side of a cell m, and (rows, cols) kinds, heights and sightings, as those of
    /// `FloorView`; without a copy of the rest.
    fn floor<'py>(&self, py: Python<'py>) -> PyResult<Floor<'py>> {
        floor(py, self.pilot.perception.world_model.view())
    }

    /// The stairs that are seen or remembered; a copy.
    fn staircase(&self) -> PyStaircase {
        (&self.pilot.perception.recognizer.staircase).into()
    }

    /// The path's legs that are climbed, in their order; None where there is no path.
    fn climbs(&self) -> Option<Vec<PyClimb>> {
        let path = self.pilot.plan.as_ref()?.way.as_ref().ok()?;
        Some(path.climbs.iter().map(PyClimb::from).collect())
    }

    /// (n, 2) m: the path in the map frame; None where there is none.
    fn path<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray2<f64>>> {
        let path = self.pilot.plan.as_ref()?.way.as_ref().ok()?;
        let rows: Vec<Vec<f64>> = path.points_m.iter().map(|point| point.to_vec()).collect();
        PyArray2::from_vec2(py, &rows).ok()
    }

    /// (4, 4): the camera in the robot's frame at the last frame, corrected by the ground plane.
    fn robot_from_camera<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        matrix(py, &self.pilot.perception.planes.robot_from_camera)
    }

    /// (rows, cols) float32 m: distance of each cell of the view to the nearest obstacle; None where it is not known.
    fn clearance<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray2<f32>>> {
        let cells = &self.pilot.perception.world_model.view().cells;
        let field = self.pilot.planner.distance_field_m()?;
        field
            .into_pyarray(py)
            .reshape([cells.rows(), cells.cols()])
            .ok()
    }

    /// (rows, cols) float32 m: where what hangs above each cell's floor begins; NaN where nothing does, None without a ceiling map.
    fn ceilings<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray2<f32>>> {
        let ceilings = self.pilot.perception.world_model.ceilings()?;
        let flat = ceilings.values().to_pyarray(py);
        flat.reshape([ceilings.rows(), ceilings.cols()]).ok()
    }

    /// (n, 3) m, (n,) rad and (n,): the torso, its heading and the weight of each place where the robot may be; empty of a localizer
    /// that keeps no guesses.
    fn guesses<'py>(&self, py: Python<'py>) -> PyResult<Guesses<'py>> {
        let guesses = self.pilot.localizer.guesses();
        let places: Vec<f64> = guesses.iter().flat_map(|guess| guess.place_m).collect();
        let of = |value: fn(&Guess) -> f64| -> Vec<f64> { guesses.iter().map(value).collect() };
        Ok((
            places.into_pyarray(py).reshape([guesses.len(), 3])?,
            of(|guess| guess.yaw_rad).into_pyarray(py),
            of(|guess| guess.weight).into_pyarray(py),
        ))
    }

    /// (n, 3) m and (n,) m: middles and sides of the cubes that were seen to be occupied; empty of a world model that keeps none.
    fn occupied<'py>(&self, py: Python<'py>) -> PyResult<Rows<'py>> {
        let voxels = self.pilot.perception.world_model.occupied();
        let split = voxels.iter().map(|voxel| (voxel.centre_m, voxel.side_m));
        rows(py, split.unzip())
    }

    /// (n, 3) m and (m, 3): corners and triangles of the surface; none of a world model that keeps no surface.
    fn surface<'py>(&self, py: Python<'py>) -> PyResult<Option<MeshArrays<'py>>> {
        surface_arrays(py, self.pilot.perception.world_model.surface())
    }

    /// The footsteps that the behaviour planned last, as `FootstepLayer.plan` gives them, with `exit`, `count` and `times`; None where it planned none.
    fn planned_footsteps(&self, py: Python<'_>) -> PyResult<Option<Py<PyDict>>> {
        let planned = self.pilot.planned_footsteps();
        planned
            .map(|planned| planned_as_dict(py, &planned))
            .transpose()
    }

    /// How many plans of footsteps the behaviour has made, and how long the last one took, s, until a first and until the best plan was found;
    /// None where it made none.
    #[getter]
    fn footstep_times(&self) -> Option<(u64, f64, f64)> {
        let planned = self.pilot.planned_footsteps()?;
        Some((planned.count, planned.times.first_s, planned.times.best_s))
    }

    /// The ground over which footsteps were planned last: corner (2,) m, side of a cell m, and (rows, cols) heights, m; None where none were.
    fn stepping_ground<'py>(&self, py: Python<'py>) -> PyResult<Option<Ground<'py>>> {
        let planned = self.pilot.planned_footsteps();
        planned
            .map(|planned| ground(py, planned.ground))
            .transpose()
    }

    /// Via points passed so far.
    #[getter]
    fn goals_passed(&self) -> usize {
        self.pilot.goals_passed()
    }

    /// What moves and is followed: number, x, y m and their rates m/s in the map, half of its width m, and whether it surely moves.
    #[getter]
    fn moving_things(&self) -> Vec<FollowedThing> {
        let things = self.pilot.perception.moving_things().iter();
        things
            .map(|track| {
                let at_m = track.predicted(0.0).at_m;
                (
                    track.id,
                    at_m,
                    track.velocity_mps(),
                    track.radius_m,
                    track.moves,
                )
            })
            .collect()
    }

    /// How often a way was planned anew after the first.
    #[getter]
    fn replans(&self) -> u64 {
        self.pilot.replans
    }

    /// Steps taken so far.
    #[getter]
    fn steps_taken(&self) -> u64 {
        self.pilot.walker.steps_taken()
    }

    /// How the listed footsteps go.
    #[getter]
    fn stepping(&self) -> PyStepping {
        self.pilot.walker.stepping().into()
    }

    /// Frames taken into the map so far.
    #[getter]
    fn frames_used(&self) -> u64 {
        self.pilot.perception.frames_used
    }

    /// How often the robot found itself elsewhere than it had believed, and forgot map and stairs.
    #[getter]
    fn maps_forgotten(&self) -> u64 {
        self.pilot.perception.forgotten
    }

    /// (pan to the left, down from the horizon) rad: where the head is told to look.
    #[getter]
    fn gaze(&self) -> (f64, f64) {
        let gaze = self.pilot.walker.gaze();
        (gaze.pan_rad, gaze.down_rad)
    }

    /// Seconds that each stage took at the last tick, in the order of `stages`; NaN where it did not run.
    #[getter]
    fn timing(&self) -> [f64; STAGES.len()] {
        self.pilot.timing.seconds
    }

    /// Names of the stages that `timing` counts.
    #[classattr]
    const fn stages() -> [&'static str; STAGES.len()] {
        STAGES
    }
}
