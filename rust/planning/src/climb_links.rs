//! Where levels join: ways over the edges of stairs, square to each, from the cell where the robot lines up to the cell where it walks on.

pub(crate) mod climbs;
pub(crate) mod directed_stairs;
pub(crate) mod entries;
pub(crate) mod room_at_edges;
mod ways;

pub(crate) use ways::{ClimbLinks, Fit, Scene, Stride, Way};
