//! A walker of the user's.

use std::sync::Arc;

use behaviour::{Command, Gaze, Stepping};
use numpy::PyReadonlyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyString;
use robot::{Body, Description};
use sensing::TICK_S;
use walking::{FeltGait, GaitConfig, HeadControl, JointTargets, WalkError, Walker, WalkerSenses};

use super::{check_within, sentence, something};
use crate::error::bad_setting;
use crate::observation::{VECTOR, field};
use crate::stairs::PyStepping;
use crate::walker_senses::{Joints, PyCommand, PyProprioception};

/// What no target is beyond, rad, rad/s and N m.
const LARGEST: f64 = 1000.0;

struct PythonWalker {
    object: Py<PyAny>,
    joints: Arc<Joints>,
    /// Where the head is to be turned; the walker is told, and does it or not.
    head: HeadControl,
    headed: JointTargets,
    /// What is felt where the object does not tell it.
    felt: FeltGait,
    targets: JointTargets,
    before_ns: Option<u64>,
    takes_footsteps: bool,
    standing: bool,
    steps_taken: u64,
    stepping: Stepping,
}

/// Wraps an object with the methods of `treadwell.protocols.Walker`, for this robot.
pub(crate) fn walker(
    py: Python<'_>,
    object: Py<PyAny>,
    robot: &Description,
) -> PyResult<Box<dyn Walker>> {
    let bad_robot = |error: &dyn std::fmt::Display| bad_setting(py, &format!("robot: {error}"));
    let bad_gait = |error: WalkError| bad_setting(py, &format!("walker: {error}"));
    let body = Body::new(robot.clone()).map_err(|error| bad_robot(&error))?;
    let (gait, _) = GaitConfig::read(&body).map_err(bad_gait)?;
    let still = vec![0.0; body.joint_count()];
    let targets = JointTargets {
        positions_rad: body.description().stand.clone(),
        velocities_radps: still.clone(),
        torques_nm: still,
    };
    let takes_footsteps = object.bind(py).hasattr(intern!(py, "stepping"))?;
    Ok(Box::new(PythonWalker {
        object,
        joints: Arc::new(Joints::of(&body)),
        head: HeadControl::new(&body, gait.gaze_speed).map_err(bad_gait)?,
        headed: targets.clone(),
        felt: FeltGait::new(&body).map_err(bad_gait)?,
        targets,
        before_ns: None,
        takes_footsteps,
        standing: true,
        steps_taken: 0,
        stepping: Stepping::default(),
    }))
}

impl PythonWalker {
    fn ask(
        &mut self,
        py: Python<'_>,
        command: &Command,
        senses: &WalkerSenses<'_>,
    ) -> PyResult<()> {
        let now_ns = senses.observation.time_ns;
        let passed_s = self
            .before_ns
            .replace(now_ns)
            .map_or(TICK_S, |before_ns| (now_ns - before_ns) as f64 * 1e-9);
        self.head.turn(&command.gaze, passed_s, &mut self.headed);
        let turned = self.head.joints().into_iter().flatten();
        let head = turned
            .map(|joint| (joint, self.headed.positions_rad[joint]))
            .collect();
        let loads_n = senses.state.foot_loads_n;
        let contacts = self.felt.contacts(loads_n);
        let arguments = (
            PyCommand::new(command, head),
            PyProprioception::new(senses, contacts, &self.joints),
        );
        let object = self.object.bind(py);
        let answer = object.call_method1(intern!(py, "step"), arguments)?;
        read(&answer, &mut self.targets)?;
        self.felt.feel(loads_n, &command.motion, passed_s);
        self.standing = match told(object, intern!(py, "standing"))? {
            Some(answer) => answer
                .extract()
                .map_err(|_| odd("standing", "a bool", &answer))?,
            None => self.felt.standing(),
        };
        self.steps_taken = match told(object, intern!(py, "steps_taken"))? {
            Some(answer) => answer
                .extract()
                .map_err(|_| odd("steps_taken", "a count", &answer))?,
            None => self.felt.steps_taken(),
        };
        if let Some(answer) = told(object, intern!(py, "stepping"))? {
            let stepping = answer.cast::<PyStepping>();
            let stepping = stepping.map_err(|_| odd("stepping", "a Stepping", &answer))?;
            self.stepping = (*stepping.get()).into();
        }
        Ok(())
    }
}

/// What a method says that an object may have.
fn told<'py>(
    object: &Bound<'py, PyAny>,
    method: &Bound<'py, PyString>,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    let method = object.getattr_opt(method)?;
    method.map(|method| method.call0()).transpose()
}

fn odd(method: &str, what: &str, answer: &Bound<'_, PyAny>) -> PyErr {
    let shown = (answer.repr()).map_or_else(|_| answer.to_string(), |text| text.to_string());
    PyValueError::new_err(format!("{method}() must return {what}, got {shown}"))
}

/// Reads a `treadwell.protocols.JointTargets`.
fn read(answer: &Bound<'_, PyAny>, into: &mut JointTargets) -> PyResult<()> {
    something(answer, "step()", "JointTargets")?;
    let py = answer.py();
    for (name, values) in [
        (intern!(py, "position"), &mut into.positions_rad),
        (intern!(py, "velocity"), &mut into.velocities_radps),
        (intern!(py, "torque"), &mut into.torques_nm),
    ] {
        let array: PyReadonlyArray1<'_, f64> = field(answer, name, VECTOR)?;
        let array = array.as_array();
        if array.len() != values.len() {
            return Err(PyValueError::new_err(format!(
                "{name} must have {} values, one a joint, got {}",
                values.len(),
                array.len()
            )));
        }
        check_within(&name.to_string(), array.iter().copied(), LARGEST)?;
        values.clear();
        values.extend(array.iter());
    }
    Ok(())
}

impl Walker for PythonWalker {
    fn step(
        &mut self,
        command: &Command,
        senses: &WalkerSenses<'_>,
    ) -> Result<&JointTargets, WalkError> {
        Python::attach(|py| self.ask(py, command, senses))
            .map_err(|error| WalkError::Failed(sentence(&error)))?;
        Ok(&self.targets)
    }

    fn standing(&self) -> bool {
        self.standing
    }

    fn steps_taken(&self) -> u64 {
        self.steps_taken
    }

    fn gaze(&self) -> Gaze {
        self.head.gaze()
    }

    fn takes_footsteps(&self) -> bool {
        self.takes_footsteps
    }

    fn stepping(&self) -> Stepping {
        self.stepping
    }
}
