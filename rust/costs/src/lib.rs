//! What a metre of ground costs a robot (handbook, section 36.3.4): by its shape, by speed and curvature, and as it was learned.

mod basis;
mod limits;
mod local_regression;
mod motion;
mod path_weights;
mod paths;
mod shape;
mod slip_sense;
mod traversability;

pub use basis::{Appearance, BASIS, Basis};
pub use limits::{LimitsConfig, LimitsError, RobotLimits};
pub use local_regression::{LocalRegression, LocalRegressionConfig, Prediction, RegressionError};
pub use motion::{Demand, MotionConfig, MotionCost, SpeedOnCurve};
pub use path_weights::{Features, PathWeights, PathWeightsConfig, WeightsError};
pub use paths::CheapestPaths;
pub use shape::{GroundShape, Shapes};
pub use slip_sense::{
    GAIT_STATISTICS, GaitSample, SlipSense, SlipSenseConfig, SlipSenseError, gait_statistics,
};
pub use traversability::{Traversability, TraversabilityConfig};

use settings::TableDescription;

/// The tables of settings of this crate.
pub const TABLES: &[TableDescription] = &[
    TableDescription::of::<LimitsConfig>(),
    TableDescription::of::<LocalRegressionConfig>(),
    TableDescription::of::<MotionConfig>(),
    TableDescription::of::<PathWeightsConfig>(),
    TableDescription::of::<SlipSenseConfig>(),
    TableDescription::of::<TraversabilityConfig>(),
];
