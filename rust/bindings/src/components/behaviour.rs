//! A behaviour of the user's.

use behaviour::{
    Behaviour, BehaviourError, Command, Decision, Gaze, Motion, Outcome, Situation, Velocity,
};
use pyo3::exceptions::PyValueError;
use pyo3::intern;
use pyo3::prelude::*;

use super::sentence;
use crate::situation::PySituation;

struct PythonBehaviour {
    object: Py<PyAny>,
    /// Names of states met so far; kept for the program's life, so capped.
    states: Vec<&'static str>,
}

const MOST_STATES: usize = 256;

/// Wraps an object with the method of `treadwell.protocols.Behaviour`.
pub(crate) fn behaviour(object: Py<PyAny>) -> Box<dyn Behaviour> {
    Box::new(PythonBehaviour {
        object,
        states: Vec::new(),
    })
}

impl PythonBehaviour {
    fn state(&mut self, name: String) -> PyResult<&'static str> {
        if let Some(known) = self.states.iter().find(|known| **known == name) {
            return Ok(known);
        }
        if self.states.len() == MOST_STATES {
            return Err(PyValueError::new_err(format!(
                "a behaviour may have {MOST_STATES} states at most"
            )));
        }
        let kept: &'static str = name.leak();
        self.states.push(kept);
        Ok(kept)
    }

    fn ask(&mut self, py: Python<'_>, situation: &Situation<'_>) -> PyResult<Decision> {
        let argument = (PySituation::new(situation),);
        let answer = self
            .object
            .bind(py)
            .call_method1(intern!(py, "next"), argument)?;
        let velocity: Option<[f64; 3]> = answer.getattr(intern!(py, "velocity"))?.extract()?;
        let [pan_rad, down_rad]: [f64; 2] = answer.getattr(intern!(py, "gaze"))?.extract()?;
        let numbers = velocity
            .unwrap_or_default()
            .into_iter()
            .chain([pan_rad, down_rad]);
        if numbers.into_iter().any(|value| !value.is_finite()) {
            return Err(PyValueError::new_err("velocity and gaze must be finite"));
        }
        let motion = velocity.map_or(Motion::Stand, |[x_mps, y_mps, yaw_radps]| {
            Motion::Walk(Velocity {
                x_mps,
                y_mps,
                yaw_radps,
            })
        });
        let outcome: Option<String> = answer.getattr(intern!(py, "outcome"))?.extract()?;
        let outcome = outcome.map(|text| match text.as_str() {
            "goal_reached" => Outcome::GoalReached,
            _ => Outcome::Refused(text),
        });
        Ok(Decision {
            command: Command {
                motion,
                gaze: Gaze { pan_rad, down_rad },
                ..Command::default()
            },
            state: self.state(answer.getattr(intern!(py, "state"))?.extract()?)?,
            goal_passed: answer.getattr(intern!(py, "goal_passed"))?.extract()?,
            outcome,
        })
    }
}

impl Behaviour for PythonBehaviour {
    fn next(&mut self, situation: &Situation<'_>) -> Result<Decision, BehaviourError> {
        Python::attach(|py| self.ask(py, situation))
            .map_err(|error| BehaviourError::Failed(sentence(&error)))
    }
}
