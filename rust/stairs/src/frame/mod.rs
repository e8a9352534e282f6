//! What one frame shows: its level surfaces and their edges, as stairs in the robot's frame (003, section IV.B).

pub(crate) mod extract;
pub(crate) mod outer_points;
pub(crate) mod shared_edges;
pub(crate) mod size;
pub(crate) mod view;
pub(crate) mod visible;
