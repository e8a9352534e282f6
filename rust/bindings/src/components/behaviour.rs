//! A behaviour of the user's.

use behaviour::{
    Behaviour, BehaviourError, Command, Decision, Footstep, Gaze, Motion, Outcome, Situation,
    Velocity,
};
use pyo3::exceptions::PyValueError;
use pyo3::intern;
use pyo3::prelude::*;

use super::{attribute, check_within, listed_footsteps, sentence, something};
use crate::situation::PySituation;
use crate::stairs::{FlatFootstep, footstep};

struct PythonBehaviour {
    object: Py<PyAny>,
    /// Names of states met so far; kept for the program's life, so capped.
    states: Vec<&'static str>,
}

const OF: &str = "next()";
const MOST_STATES: usize = 256;
/// Characters of a state's name.
const LONGEST_NAME: usize = 100;
/// What no velocity, angle or length of a decision is beyond, m, rad and s.
const LARGEST: f64 = 100.0;

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
        if name.len() > LONGEST_NAME {
            return Err(PyValueError::new_err(format!(
                "a state's name may have {LONGEST_NAME} characters at most"
            )));
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
        something(&answer, OF, "a Decision")?;
        let gaze = attribute(&answer, (OF, "gaze"), "(pan, down), rad")?;
        let [pan_rad, down_rad]: [f64; 2] = gaze;
        check_within("gaze", [pan_rad, down_rad], LARGEST)?;
        let motion = read_motion(&answer)?;
        let outcome: Option<String> = attribute(&answer, (OF, "outcome"), "str or None")?;
        let outcome = outcome.map(read_outcome).transpose()?;
        Ok(Decision {
            command: Command {
                motion,
                gaze: Gaze { pan_rad, down_rad },
                ..Command::default()
            },
            state: self.state(attribute(&answer, (OF, "state"), "str")?)?,
            goal_passed: attribute(&answer, (OF, "goal_passed"), "bool")?,
            outcome,
        })
    }
}

/// How a decision ends the episode: at the goal, or by a refusal in its form.
fn read_outcome(text: String) -> PyResult<Outcome> {
    if text == "goal_reached" {
        return Ok(Outcome::GoalReached);
    }
    let word = text.split_once(": ").map_or("", |(word, _)| word);
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    if word.is_empty() || !word.chars().all(is_word) {
        return Err(PyValueError::new_err(format!(
            "{OF}.outcome must be None, goal_reached, or why it refuses, as `word: sentence`; got {text:?}"
        )));
    }
    Ok(Outcome::Refused(text))
}

/// What the feet shall do: walk with a velocity, take listed steps, or stand.
fn read_motion(answer: &Bound<'_, PyAny>) -> PyResult<Motion> {
    let velocity: Option<[f64; 3]> =
        attribute(answer, (OF, "velocity"), "(m/s, m/s, rad/s) or None")?;
    let wanted = "a sequence of Footstep";
    let listed: Vec<FlatFootstep> = listed_footsteps(answer, OF, wanted)?;
    if !listed.is_empty() {
        return match velocity {
            None => listed
                .into_iter()
                .map(checked_footstep)
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
    check_within("velocity", [x_mps, y_mps, yaw_radps], LARGEST)?;
    Ok(Motion::Walk(Velocity {
        x_mps,
        y_mps,
        yaw_radps,
    }))
}

fn checked_footstep(flat: FlatFootstep) -> PyResult<Footstep> {
    let (_, x_m, y_m, yaw_rad, height_m, from_m, to_m, _, (ahead, left)) = flat;
    let step = footstep(flat).map_err(PyValueError::new_err)?;
    let numbers = [x_m, y_m, yaw_rad, height_m, from_m, to_m, ahead, left];
    check_within("footsteps", numbers, LARGEST)?;
    if from_m >= to_m {
        return Err(PyValueError::new_err(format!(
            "a footstep's bearing_from must be below its bearing_to, got {from_m} and {to_m}"
        )));
    }
    Ok(step)
}

impl Behaviour for PythonBehaviour {
    fn next(&mut self, situation: &Situation<'_>) -> Result<Decision, BehaviourError> {
        Python::attach(|py| self.ask(py, situation))
            .map_err(|error| BehaviourError::Failed(sentence(&error)))
    }
}
