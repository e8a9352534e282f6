//! From the core's errors to Python's: bad settings are `InputError`, everything else is `CoreError`.

use pyo3::prelude::*;
use pyo3::types::PyString;

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

/// Runs `work`; a panic, which is a bug, comes back as its sentence and ends the episode, not the program.
pub(crate) fn unpanicked<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    std::panic::catch_unwind(std::panic::AssertUnwindSafe(work)).map_err(|panic| {
        let text = panic
            .downcast_ref::<String>()
            .map(String::as_str)
            .or_else(|| panic.downcast_ref::<&str>().copied())
            .unwrap_or("no reason given");
        format!("a bug in the core: {text}")
    })
}
