//! What a metre of ground costs a robot (handbook, section 36.3.4): by its shape, by speed and curvature, and as it was learned.

mod limits;
mod motion;
mod paths;
mod shape;
mod traversability;

pub use limits::{LimitsConfig, LimitsError, RobotLimits};
pub use motion::{Demand, MotionConfig, MotionCost, SpeedOnCurve};
pub use paths::CheapestPaths;
pub use shape::{GroundShape, Shapes};
pub use traversability::{Traversability, TraversabilityConfig};

use settings::TableDescription;

/// The tables of settings of this crate.
pub const TABLES: &[TableDescription] = &[
    TableDescription::of::<LimitsConfig>(),
    TableDescription::of::<MotionConfig>(),
    TableDescription::of::<TraversabilityConfig>(),
];
