//! What a behaviour made of states does, whatever its states are: the reading of a tick.

mod clock;
mod tick;

pub(crate) use clock::{Clock, Stopwatch};
pub(crate) use tick::Tick;
