//! MuJoCo stepped by its own C functions, the servos between two steps: a control tick is one call, not ten from Python.
//!
//! This is the only crate of the workspace with `unsafe`. What it trusts is what Python's MuJoCo package itself hands out: a model, a data
//! object, their addresses, and the functions of the library that the package has loaded. Nothing of the core may use it.
//!
//! A fatal error of MuJoCo's would end the process, where the package raises an exception. A step has none: where a model's memory is too
//! small for its contacts MuJoCo warns, which [`Physics::step`] tells, and where it is too small for anything, no model is made of it.

mod library;
mod memory;
mod physics;

pub use physics::{Physics, Wiring};
