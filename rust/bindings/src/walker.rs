//! The walker alone, with the senses that it needs: for walking trials without camera and map.

use behaviour::{Command, Gaze, Motion, Velocity};
use localization::{Proprioception, ProprioceptionConfig};
use numpy::{PyArray1, ToPyArray};
use pyo3::prelude::*;
use robot::{Body, Description};
use sensing::{Frame, Observation};
use walking::Walker;

use crate::error::{bad_setting, failed, unreadable};
use crate::observation;

type Targets<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
);

/// Walks as it is told: proprioception and walker of one robot.
#[pyclass(name = "Walker", module = "treadwell._core")]
pub(crate) struct PyWalker {
    proprioception: Proprioception,
    walker: Walker,
    observation: Observation,
    spare: Option<Frame>,
    command: Command,
}

#[pymethods]
impl PyWalker {
    #[new]
    fn new(py: Python<'_>, description_json: &str) -> PyResult<Self> {
        let description: Description =
            serde_json::from_str(description_json).map_err(|error| bad_setting(py, &error))?;
        let body = Body::new(description).map_err(|error| bad_setting(py, &error))?;
        Ok(Self {
            proprioception: Proprioception::new(&body, ProprioceptionConfig::default())
                .map_err(|error| bad_setting(py, &error))?,
            walker: Walker::new(&body).map_err(|error| bad_setting(py, &error))?,
            observation: observation::empty(),
            spare: None,
            command: Command::default(),
        })
    }

    /// One control tick: positions (n,) rad, velocities (n,) rad/s and torques (n,) N m by joint order. `motion` is
    /// (x m/s, y m/s, yaw rad/s) or None to stand; the head looks `pan` rad to the left and `down` rad below the horizon.
    #[pyo3(signature = (observation, motion, pan=0.0, down=0.0))]
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        observation: &Bound<'_, PyAny>,
        motion: Option<(f64, f64, f64)>,
        pan: f64,
        down: f64,
    ) -> PyResult<Targets<'py>> {
        observation::read(observation, &mut self.observation, &mut self.spare)
            .map_err(|error| unreadable(py, &error))?;
        let state = self
            .proprioception
            .update(&self.observation)
            .map_err(|error| failed(py, &error))?;
        self.command.motion = motion.map_or(Motion::Stand, |(x_mps, y_mps, yaw_radps)| {
            Motion::Walk(Velocity {
                x_mps,
                y_mps,
                yaw_radps,
            })
        });
        self.command.gaze = Gaze {
            pan_rad: pan,
            down_rad: down,
        };
        let targets = self
            .walker
            .step(&self.command, &self.observation, state)
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

    /// (x m, y m, yaw rad) of the robot by leg odometry.
    #[getter]
    fn odometry(&self) -> (f64, f64, f64) {
        let pose = self.proprioception.state().odometry_from_robot;
        let origin = pose.origin().inner;
        (origin.x, origin.y, pose.yaw_rad())
    }
}
