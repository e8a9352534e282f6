//! Stairs (003): extracted from horizontal planes, their edges fitted to the disparities, merged while the robot stands,
//! remembered while it steps, and where feet fit on them.

mod aspect;
mod border;
mod boundary;
mod conditions;
mod config;
mod edge_line;
mod edge_model;
mod extract;
mod fits;
mod footing;
mod fusion;
mod joints;
mod line;
mod memory;
mod merge;
mod outer_points;
mod recognizer;
mod robust_line;
mod shared_edges;
mod size;
mod stair;
mod tread;
mod view;
mod visible;

#[cfg(test)]
#[path = "../../segmentation/src/synthetic.rs"]
mod synthetic;
#[cfg(test)]
mod tests;

pub use conditions::{Ahead, Stand, Tolerance, Unready, conditions};
pub use config::{ClimbingConfig, ParameterSet, StairsConfig};
pub use edge_line::EdgeLine;
pub use edge_model::{EdgeModel, FittedEdge, Untrusted};
pub use footing::{Feet, Footing, Onward, Unfit};
pub use recognizer::{Recognizer, StairsError};
pub use stair::{Edge, EdgeFit, Sides, Stair, Staircase};
