//! MuJoCo stepped with the servos between two steps: a control tick is two calls from Python, not ten.
//!
//! This is the only crate of the workspace with `unsafe`: it reads and writes MuJoCo's arrays where they are. What it trusts is that the
//! views that Python's MuJoCo package hands out stay where they are as long as the data object lives. Nothing of the core may use it.
//!
//! The steps themselves are the package's functions, called through Python at some 0.3 us each. A fatal error of MuJoCo's, as where a model's
//! memory is too small for what it has to solve, ends a process that has called the C functions: the package alone comes out of them
//! (by `longjmp` in C++, which Rust may not do over its own frames and has no sound counterpart to), and raises an exception.

mod memory;
mod physics;

pub use physics::{Physics, Wiring};
