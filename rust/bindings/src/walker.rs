//! The core's own walker alone, with the senses that it needs: for walking trials without camera and map.

use behaviour::{Arms, Command, Gaze, Motion, Velocity};
use geometry::{Odometry, Point, Pose, Robot};
use nalgebra::Vector2;
use numpy::{PyArray1, ToPyArray};
use proprioception::{Proprioception, ProprioceptionConfig};
use pyo3::prelude::*;
use robot::Body;
use sensing::{Frame, Observation};
use walking::relief::Slopes;
use walking::{DcmWalker, Walker, WalkerSenses};

use crate::error::{bad_setting, failed, parse, unreadable};
use crate::observation;
use crate::stairs::{FlatFootstep, PyStepping, footstep};

/// Ground that rises along the odometry's x from one place to another.
#[derive(Debug)]
struct Slope {
    odometry_from_robot: Pose<Odometry, Robot>,
    /// From, to, and the rise per metre.
    extent_m: (f64, f64, f64),
}

impl Slopes for Slope {
    fn gradient(&self, x_m: f64, y_m: f64) -> Vector2<f64> {
        let at = self.odometry_from_robot * Point::new(x_m, y_m, 0.0);
        let (from_m, to_m, rise) = self.extent_m;
        if !(from_m..to_m).contains(&at.inner.x) {
            return Vector2::zeros();
        }
        let (sin, cos) = libm::sincos(self.odometry_from_robot.yaw_rad());
        Vector2::new(cos, -sin) * rise
    }
}

type Targets<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
);

/// What the feet are told.
#[derive(FromPyObject)]
enum Told {
    Velocity((f64, f64, f64)),
    Steps(Vec<FlatFootstep>),
}

/// Walks as it is told: proprioception and walker of one robot.
#[pyclass(name = "Walker", module = "treadwell._core")]
pub(crate) struct PyWalker {
    body: Body,
    proprioception: Proprioception,
    walker: DcmWalker,
    observation: Observation,
    spare: Option<Frame>,
    command: Command,
    slope: Option<(f64, f64, f64)>,
}

#[pymethods]
impl PyWalker {
    #[new]
    fn new(py: Python<'_>, description_json: &str) -> PyResult<Self> {
        let body =
            Body::new(parse(py, description_json)?).map_err(|error| bad_setting(py, &error))?;
        Ok(Self {
            proprioception: Proprioception::new(&body, ProprioceptionConfig::default())
                .map_err(|error| bad_setting(py, &error))?,
            walker: DcmWalker::new(&body).map_err(|error| bad_setting(py, &error))?,
            body,
            observation: observation::empty(),
            spare: None,
            command: Command::default(),
            slope: None,
        })
    }

    /// One control tick: positions (n,) rad, velocities (n,) rad/s and torques (n,) N m by joint order. `motion` is
    /// (x m/s, y m/s, yaw rad/s), or a list of footsteps (side, x m, y m, yaw rad, height m, bearing from m, bearing to m, manner), or
    /// None to stand; the head looks `pan` rad to the left and `down` rad below the horizon.
    #[pyo3(signature = (observation, motion, pan=0.0, down=0.0))]
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        observation: &Bound<'_, PyAny>,
        motion: Option<Told>,
        pan: f64,
        down: f64,
    ) -> PyResult<Targets<'py>> {
        observation::read(observation, &mut self.observation, &mut self.spare)
            .map_err(|error| unreadable(py, &error))?;
        self.proprioception.note_slopes(self.walker.on_slope());
        let state = self
            .proprioception
            .update(&self.observation)
            .map_err(|error| failed(py, &error))?;
        self.command.motion = motion
            .map_or(Ok(Motion::Stand), told)
            .map_err(|error| bad_setting(py, &error))?;
        self.command.gaze = Gaze {
            pan_rad: pan,
            down_rad: down,
        };
        let slope = self.slope.map(|extent_m| Slope {
            odometry_from_robot: state.odometry_from_robot,
            extent_m,
        });
        let targets = self
            .walker
            .step(
                &self.command,
                &WalkerSenses {
                    body: &self.body,
                    observation: &self.observation,
                    state,
                    slopes: slope.as_ref().map(|slope| slope as &dyn Slopes),
                },
            )
            .map_err(|error| failed(py, &error))?;
        self.proprioception.note_command(
            &targets.positions_rad,
            &targets.velocities_radps,
            &targets.torques_nm,
        );
        Ok((
            targets.positions_rad.to_pyarray(py),
            targets.velocities_radps.to_pyarray(py),
            targets.torques_nm.to_pyarray(py),
        ))
    }

    /// (from m, to m, rise per metre): between these places along x of the odometry the ground is known to rise so; None: it is level.
    #[getter]
    const fn slope(&self) -> Option<(f64, f64, f64)> {
        self.slope
    }

    #[setter]
    const fn set_slope(&mut self, slope: Option<(f64, f64, f64)>) {
        self.slope = slope;
    }

    /// Whether the arms are to be raised; at rest otherwise.
    #[getter]
    fn arms_raised(&self) -> bool {
        self.command.arms == Arms::Raised
    }

    #[setter]
    fn set_arms_raised(&mut self, raised: bool) {
        self.command.arms = if raised { Arms::Raised } else { Arms::AtRest };
    }

    /// Whether it stands still on both soles.
    #[getter]
    fn standing(&self) -> bool {
        self.walker.standing()
    }

    /// Landings so far.
    #[getter]
    fn steps_taken(&self) -> u64 {
        self.walker.steps_taken()
    }

    /// How the listed footsteps go: steps landed, how much higher than told the last landing was (m), and why the list was given
    /// up, if it was: "no_ground" or "obstructed".
    #[getter]
    fn stepping(&self) -> (usize, f64, Option<&'static str>) {
        let stepping = PyStepping::from(self.walker.stepping());
        (stepping.landed, stepping.height_error, stepping.misstep)
    }

    /// Height of the ground that carries by leg odometry, above that of the start, m.
    #[getter]
    fn ground(&self) -> f64 {
        let pose = self.proprioception.state().odometry_from_robot;
        pose.origin().inner.z
    }

    /// (x m, y m, yaw rad) of the robot by leg odometry.
    #[getter]
    fn odometry(&self) -> (f64, f64, f64) {
        let pose = self.proprioception.state().odometry_from_robot;
        let origin = pose.origin().inner;
        (origin.x, origin.y, pose.yaw_rad())
    }
}

fn told(motion: Told) -> Result<Motion, String> {
    Ok(match motion {
        Told::Velocity((x_mps, y_mps, yaw_radps)) => Motion::Walk(Velocity {
            x_mps,
            y_mps,
            yaw_radps,
        }),
        Told::Steps(steps) => {
            Motion::Footsteps(steps.into_iter().map(footstep).collect::<Result<_, _>>()?)
        }
    })
}
