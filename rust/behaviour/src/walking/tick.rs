//! What the states of `walking` read at a tick.

use std::ops::Deref;

use planning::Path;

use super::track::Track;
use crate::machine::Tick;

/// A tick with the way that is followed.
#[derive(Clone, Copy)]
pub(crate) struct WayTick<'a> {
    /// What every behaviour reads.
    pub(super) tick: Tick<'a>,
    /// The planned way and the robot's place on it.
    pub(super) track: Option<(&'a Path, Track)>,
}

impl<'a> Deref for WayTick<'a> {
    type Target = Tick<'a>;

    fn deref(&self) -> &Tick<'a> {
        &self.tick
    }
}
