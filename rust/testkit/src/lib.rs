//! What the tests of several crates need: a small biped, the observations that it would make on a walk, and pictures of blocks on the ground.
//!
//! For tests only: no crate has it among its dependencies, some among their dependencies for tests.

#![expect(
    clippy::unwrap_used,
    reason = "a test that cannot be set up has failed"
)]

mod biped;
mod standing;
pub mod synthetic;
mod walk;

pub use biped::biped;
pub use sensing::TICK_NS;
pub use standing::state_at;
pub use walk::Walk;
