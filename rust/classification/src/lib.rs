//! What points and cells are: ground, obstacle, vegetation, surface, line (handbook, section 36.3.5).

mod cloud;
mod ground_filter;
mod learned_ground;
mod load_bearing;
mod markov_chain;
mod markov_field;
mod moments;
mod negative_obstacles;
mod neighbours;
mod primitives;
mod robust_planes;
mod scene;
mod slope_statistics;
#[cfg(test)]
mod synthetic;
mod trained;

pub use cloud::{CloudError, Point3};
pub use ground_filter::{Ground, GroundFilter, GroundFilterConfig};
pub use learned_ground::{Canopy, LearnedGround, LearnedGroundConfig};
pub use load_bearing::{LoadBearing, LoadBearingConfig, SensorRay, Support};
pub use markov_chain::{ChainError, MarkovChain, MarkovChainConfig};
pub use markov_field::{MarkovField, MarkovFieldConfig};
pub use moments::{MomentsConfig, PointClass, PointClasses, Saliency};
pub use negative_obstacles::{
    NegativeObstacle, NegativeObstacles, NegativeObstaclesConfig, RangePicture,
};
pub use neighbours::Neighbours;
pub use primitives::{
    Ball, BallTree, BallTreeConfig, Cylinder, CylinderConfig, Cylinders, GroundMesh,
    GroundMeshConfig, TreeError,
};
pub use robust_planes::{FoundPlane, RobustPlanes, RobustPlanesConfig};
pub use scene::{
    DepthPicture, Group, GroupingConfig, Groups, Label, LabelError, LabelMap, LabelMapConfig,
    LabelledCube, PictureError, SceneClasses, SceneGrouping, ShapesConfig,
};
pub use slope_statistics::{HeightStatistics, SlopeStatistics, SlopeStatisticsConfig};
pub use trained::{TrainedClasses, TrainedConfig, TrainingError};

use settings::TableDescription;

/// The tables of settings of this crate.
pub const TABLES: &[TableDescription] = &[
    TableDescription::of::<GroundFilterConfig>(),
    TableDescription::of::<GroupingConfig>(),
    TableDescription::of::<ShapesConfig>(),
    TableDescription::of::<LabelMapConfig>(),
    TableDescription::of::<LearnedGroundConfig>(),
    TableDescription::of::<LoadBearingConfig>(),
    TableDescription::of::<MarkovChainConfig>(),
    TableDescription::of::<MarkovFieldConfig>(),
    TableDescription::of::<MomentsConfig>(),
    TableDescription::of::<NegativeObstaclesConfig>(),
    TableDescription::of::<RobustPlanesConfig>(),
    TableDescription::of::<GroundMeshConfig>(),
    TableDescription::of::<BallTreeConfig>(),
    TableDescription::of::<CylinderConfig>(),
    TableDescription::of::<SlopeStatisticsConfig>(),
    TableDescription::of::<TrainedConfig>(),
];
