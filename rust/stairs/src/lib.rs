//! Stairs (003): extracted from horizontal planes, their edges fitted to the disparities, merged while the robot stands,
//! remembered while it steps, and where feet fit on them.

mod config;
mod edge_model;
mod footing;
mod recognizer;
mod stair;

pub use config::{ClimbingConfig, ParameterSet, StairsConfig};
pub use edge_model::{EdgeModel, FittedEdge, Untrusted};
pub use footing::{Feet, Footing, Onward, Unfit};
pub use recognizer::{Recognizer, StairsError};
pub use stair::{Edge, EdgeFit, Stair, Staircase};
