//! Stairs (003): extracted from horizontal planes, their edges fitted to the disparities, merged while the robot stands,
//! remembered while it steps, and where feet fit on them.
//!
//! Where a sole goes on a stair, or why none goes there:
//!
//! ```
//! use stairs::{ClimbingConfig, Feet, Footing, Onward, Unfit};
//!
//! let feet = Feet { length_m: 0.105, pair_width_m: 0.16, stance_m: 0.085 };
//! let config = ClimbingConfig::default();
//! let next = Onward::Edge { depth_m: 0.12, rise_m: 0.03 };
//! let on = Footing::on_stair(&config, &feet, 0.03, 0.33, next);
//! assert!(on.is_ok());
//! let too_high = Footing::on_stair(&config, &feet, 0.08, 0.33, next);
//! assert!(matches!(too_high, Err(Unfit::TooHigh(_))));
//! ```

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
pub use climbing::footing::{Feet, Footing, Onward, Unfit};
pub use config::{
    BevelMemoryTuning, BevelTuning, BorderTuning, CoarseTuning, EdgeModelTuning, EdgesTuning,
    ExcerptTuning, FitsTuning, FrameTuning, FusionTuning, JointsTuning, LinesTuning, MemoryTuning,
    MergingTuning, PlacesTuning, RefineTuning, SharedEdgesTuning, SidesTuning, StairsConfig,
    StairsTuning, TreadsTuning, ViewTuning, VisibilityTuning, WindowTuning,
};
pub use edge_line::EdgeLine;
pub use edges::edge_model::{EdgeModel, FittedEdge, Untrusted};
pub use recognizer::{Recognizer, StairsError};
pub use stair::{Edge, EdgeFit, Sides, Stair, Staircase, SureEdge};
