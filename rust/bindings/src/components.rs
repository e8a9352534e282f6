//! Components of the user's, written in Python: one adapter a trait.

mod behaviour;
mod localizer;
mod planner;
mod segmenter;
mod walker;
mod world_model;

use pyo3::conversion::FromPyObjectOwned;
use pyo3::exceptions::PyValueError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple, PyType};

pub(crate) use behaviour::behaviour;
pub(crate) use localizer::localizer;
pub(crate) use planner::planner;
pub(crate) use segmenter::segmenter;
pub(crate) use walker::walker;
pub(crate) use world_model::{read_view, world_model};

/// The sentence of a Python exception, with its type.
fn sentence(error: &PyErr) -> String {
    Python::attach(|py| {
        error
            .value(py)
            .repr()
            .map_or_else(|_| error.to_string(), |text| text.to_string())
    })
}

/// Calls the method `forget` of a part that has one, if the robot found itself elsewhere since the last call of another. It is done
/// late, as an exception of its has to end the episode as any other does.
fn forget_if(elsewhere: &mut bool, object: &Bound<'_, PyAny>) -> PyResult<()> {
    if std::mem::take(elsewhere)
        && let Some(forget) = object.getattr_opt(intern!(object.py(), "forget"))?
    {
        let _answer = forget.call0()?;
    }
    Ok(())
}

/// Metres from the map's origin within which everything lies. Farther away the core's grids and queues have no room.
const FARTHEST_M: f64 = 10_000.0;

/// Refuses a number of Python's that is none, or beyond `most` of either sign.
fn check_within(what: &str, values: impl IntoIterator<Item = f64>, most: f64) -> PyResult<()> {
    match values
        .into_iter()
        .find(|value| value.is_nan() || value.abs() > most)
    {
        None => Ok(()),
        Some(value) => Err(PyValueError::new_err(format!(
            "{what} must be finite and within {most}, got {value:?}"
        ))),
    }
}

/// Refuses nothing, an array, or a plain value where a method of a part of the user's has to return `wanted`.
fn something(answer: &Bound<'_, PyAny>, of: &str, wanted: &str) -> PyResult<()> {
    let home: Option<String> = answer.get_type().module()?.extract().ok();
    let plain = matches!(home.as_deref(), Some("builtins" | "numpy"));
    // A class may have the attributes itself.
    if plain && !answer.is_instance_of::<PyType>() {
        return Err(unlike_of(&format!("{of} must return {wanted}"), answer));
    }
    Ok(())
}

/// Footsteps that a part of the user's may list at once.
const MOST_FOOTSTEPS: usize = 1000;

/// Reads the footsteps that a part of the user's lists; their number is looked at first.
fn listed_footsteps<'py, T>(answer: &Bound<'py, PyAny>, of: &str, wanted: &str) -> PyResult<Vec<T>>
where
    Vec<T>: FromPyObjectOwned<'py>,
{
    let at = (of, "footsteps");
    let listed: Bound<'_, PyAny> = attribute(answer, at, wanted)?;
    match listed.len() {
        Ok(count) if count > MOST_FOOTSTEPS => Err(PyValueError::new_err(format!(
            "there may be {MOST_FOOTSTEPS} footsteps at most, got {count}"
        ))),
        _ => attribute(answer, at, wanted),
    }
}

/// Reads an attribute of what a part of the user's returned. What is missing or of another type is told by its name, with what is
/// `wanted` there.
fn attribute<'py, T: FromPyObjectOwned<'py>>(
    answer: &Bound<'py, PyAny>,
    (of, name): (&str, &str),
    wanted: &str,
) -> PyResult<T> {
    let Some(found) = answer.getattr_opt(name)? else {
        let kind = answer.get_type().name()?;
        return Err(PyValueError::new_err(format!(
            "{of}.{name} is missing: found {kind}; wanted {wanted}"
        )));
    };
    found
        .extract()
        .map_err(|_| unlike(&format!("{of}.{name}"), &found, wanted))
}

/// The most entries of a tuple or list whose types an error names.
const MOST_NAMED: usize = 8;

/// Name of a value's type.
fn kind(found: &Bound<'_, PyAny>) -> String {
    if found.is_none() {
        return "None".to_owned();
    }
    found.get_type().name().map_or_else(
        |_| "something without a type".to_owned(),
        |kind| kind.to_string(),
    )
}

/// What a value is that is no array: its type, and those of a tuple's or list's entries.
fn kinds(found: &Bound<'_, PyAny>) -> String {
    let sequence = found.is_instance_of::<PyTuple>() || found.is_instance_of::<PyList>();
    let entries: Vec<String> = match found.try_iter() {
        Ok(entries) if sequence => entries
            .map_while(Result::ok)
            .map(|one| kind(&one))
            .collect(),
        _ => return kind(found),
    };
    match entries.len() {
        0..=MOST_NAMED => format!("{} ({})", kind(found), entries.join(", ")),
        many => format!("{} of {many}", kind(found)),
    }
}

/// The error for a value of another type than is wanted: with its type, and that of its elements and its shape if it is an array.
pub(crate) fn unlike(name: &str, found: &Bound<'_, PyAny>, wanted: &str) -> PyErr {
    unlike_of(&format!("{name} must be {wanted}"), found)
}

fn unlike_of(must: &str, found: &Bound<'_, PyAny>) -> PyErr {
    let text = |key| {
        found
            .getattr(key)
            .and_then(|value| value.str())
            .map(|text| text.to_string())
    };
    let is = match (text("dtype"), text("shape")) {
        (Ok(dtype), Ok(shape)) => format!("{dtype} {shape}"),
        _ => kinds(found),
    };
    PyValueError::new_err(format!("{must}, got {is}"))
}
