//! What the tests of several crates need: a small biped, and the observations that it would make on a walk.
//!
//! For tests only: no crate has it among its dependencies, some among their dependencies for tests.

#![expect(
    clippy::unwrap_used,
    reason = "a test that cannot be set up has failed"
)]

mod biped;
mod standing;
mod walk;

pub use biped::biped;
pub use sensing::TICK_NS;
pub use standing::state_at;
pub use walk::Walk;
