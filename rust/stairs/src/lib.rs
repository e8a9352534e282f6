//! Stairs (003): extracted, merged while the robot stands, remembered while it steps, and where feet fit on them.
#![doc = include_str!("../README.md")]

mod climbing;
mod config;
mod edge_line;
mod edges;
mod frame;
mod lines;
mod recognizer;
mod stair;
mod treads;

#[cfg(test)]
mod tests;

pub use climbing::conditions::{Ahead, Stand, Tolerance, Unready, conditions};
pub use climbing::config::{ClimbingConfig, ClimbingTuning, LevelsConfig, ParameterSet};
pub use climbing::footing::{Feet, Footing, Onward};
pub use climbing::unfit::Unfit;
pub use config::{
    BevelMemoryTuning, BevelTuning, BorderTuning, CoarseTuning, EdgeModelTuning, EdgesTuning,
    ExcerptTuning, FitsTuning, FrameTuning, FusionTuning, JointsTuning, LinesTuning, MemoryTuning,
    MergingTuning, PlacesTuning, RefineTuning, SharedEdgesTuning, SidesTuning, StairsConfig,
    StairsTuning, TreadsTuning, ViewTuning, VisibilityTuning, WindowTuning,
};
pub use edge_line::EdgeLine;
pub use edges::edge_model::{EdgeModel, FittedEdge, Untrusted};
pub use edges::felt::CarryingSole;
pub use recognizer::{Recognizer, StairsError};
pub use stair::{Edge, EdgeFit, Sides, Stair, Staircase, SureEdge};
