//! Levels: floor of different height joins only by a climb, square to an edge and within the limits.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

mod border;
mod climbs;
mod course;
mod goals;
mod ground;
mod landings;
mod slopes;
