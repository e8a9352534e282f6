//! A behaviour of the user's.

use behaviour::{
    Behaviour, BehaviourError, Command, Decision, Footstep, Gaze, Motion, Outcome, Situation,
    Velocity,
};
use geometry::PlanarPose;
use pyo3::exceptions::PyValueError;
use pyo3::intern;
use pyo3::prelude::*;
use robot::Side;

use super::sentence;
use crate::situation::PySituation;
use crate::stairs::FlatFootstep;

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
        let [pan_rad, down_rad]: [f64; 2] = answer.getattr(intern!(py, "gaze"))?.extract()?;
        if ![pan_rad, down_rad].iter().all(|value| value.is_finite()) {
            return Err(PyValueError::new_err("gaze must be finite"));
        }
        let motion = read_motion(&answer)?;
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

/// What the feet shall do: walk with a velocity, take listed steps, or stand.
fn read_motion(answer: &Bound<'_, PyAny>) -> PyResult<Motion> {
    let py = answer.py();
    let velocity: Option<[f64; 3]> = answer.getattr(intern!(py, "velocity"))?.extract()?;
    let listed: Vec<FlatFootstep> = answer.getattr(intern!(py, "footsteps"))?.extract()?;
    if !listed.is_empty() {
        return match velocity {
            None => listed
                .into_iter()
                .map(footstep)
                .collect::<PyResult<_>>()
                .map(Motion::Footsteps),
            Some(_) => Err(PyValueError::new_err(
                "velocity must be None beside footsteps",
            )),
        };
    }
    let Some([x_mps, y_mps, yaw_radps]) = velocity else {
        return Ok(Motion::Stand);
    };
    if ![x_mps, y_mps, yaw_radps]
        .iter()
        .all(|value| value.is_finite())
    {
        return Err(PyValueError::new_err("velocity must be finite"));
    }
    Ok(Motion::Walk(Velocity {
        x_mps,
        y_mps,
        yaw_radps,
    }))
}

fn footstep((side, x_m, y_m, yaw_rad, height_m, from_m, to_m): FlatFootstep) -> PyResult<Footstep> {
    let side = match side.as_str() {
        "left" => Side::Left,
        "right" => Side::Right,
        other => {
            return Err(PyValueError::new_err(format!(
                "a footstep's side must be left or right, got {other}"
            )));
        }
    };
    if ![x_m, y_m, yaw_rad, height_m, from_m, to_m]
        .iter()
        .all(|value| value.is_finite())
    {
        return Err(PyValueError::new_err("footsteps must be finite"));
    }
    if from_m >= to_m {
        return Err(PyValueError::new_err(format!(
            "a footstep's bearing_from must be below its bearing_to, got {from_m} and {to_m}"
        )));
    }
    Ok(Footstep {
        side,
        pose: PlanarPose { x_m, y_m, yaw_rad },
        height_m,
        bearing_m: [from_m, to_m],
    })
}

impl Behaviour for PythonBehaviour {
    fn next(&mut self, situation: &Situation<'_>) -> Result<Decision, BehaviourError> {
        Python::attach(|py| self.ask(py, situation))
            .map_err(|error| BehaviourError::Failed(sentence(&error)))
    }
}
