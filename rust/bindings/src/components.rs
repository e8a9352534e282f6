//! Components of the user's, written in Python: one adapter a trait.

mod behaviour;
mod localizer;
mod planner;
mod segmenter;
mod world_model;

use pyo3::prelude::*;

pub(crate) use behaviour::behaviour;
pub(crate) use localizer::localizer;
pub(crate) use planner::planner;
pub(crate) use segmenter::segmenter;
pub(crate) use world_model::world_model;

/// The sentence of a Python exception, with its type.
fn sentence(error: &PyErr) -> String {
    Python::attach(|py| {
        error
            .value(py)
            .repr()
            .map_or_else(|_| error.to_string(), |text| text.to_string())
    })
}
