//! From the core's errors to Python's: bad settings are `InputError`, everything else is `CoreError`.

use std::panic::{AssertUnwindSafe, catch_unwind};

use pyo3::prelude::*;
use pyo3::types::PyString;
use serde::de::DeserializeOwned;

fn raise(py: Python<'_>, class: &str, message: &str) -> PyErr {
    let made = py
        .import("treadwell.errors")
        .and_then(|module| module.getattr(class))
        .and_then(|class| class.call1((PyString::new(py, message),)));
    match made {
        Ok(error) => PyErr::from_value(error),
        Err(error) => error,
    }
}

/// What the user set cannot be used: `treadwell.errors.InputError`.
pub(crate) fn bad_setting(py: Python<'_>, error: &impl std::fmt::Display) -> PyErr {
    raise(py, "InputError", &error.to_string())
}

/// A stage of the core refused what it was given or failed: `treadwell.errors.CoreError`.
pub(crate) fn failed(py: Python<'_>, error: &impl std::fmt::Display) -> PyErr {
    raise(py, "CoreError", &error.to_string())
}

/// An observation that cannot be read: `treadwell.errors.CoreError`.
pub(crate) fn unreadable(py: Python<'_>, error: &PyErr) -> PyErr {
    failed(py, &format_args!("observation: {}", error.value(py)))
}

/// Reads settings or a description from the JSON text that Python writes.
pub(crate) fn parse<T: DeserializeOwned>(py: Python<'_>, json: &str) -> PyResult<T> {
    serde_json::from_str(json).map_err(|error| bad_setting(py, &error))
}

/// Runs `work` while Python goes on; a panic, which is a bug, comes back as its sentence and ends the episode, not the program.
pub(crate) fn run<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    py.detach(|| catch_unwind(AssertUnwindSafe(work)))
        .map_err(|panic| {
            let text = panic
                .downcast_ref::<String>()
                .map(String::as_str)
                .or_else(|| panic.downcast_ref::<&str>().copied())
                .unwrap_or("no reason given");
            failed(py, &format_args!("a bug in the core: {text}"))
        })
}
