//! Maps of the plane that a laser or a sonar sweeps, seen from above (004, section 36.2): what is occupied, cell by cell, walls as
//! lines, and places with the ways between them.
//!
//! ```
//! use geometry::PlanarPose;
//! use plan_view::{PlanarBeam, OccupancyConfig, OccupancyMap, PlanarScan};
//!
//! let mut map = OccupancyMap::new(OccupancyConfig::default())?;
//! let beams = (-20..=20).map(|step| {
//!     let bearing_rad = 0.02 * f64::from(step);
//!     PlanarBeam::new(bearing_rad, Some(2.0 / bearing_rad.cos()))
//! });
//! let scan = PlanarScan { map_from_sensor: PlanarPose::new(0.0, 0.0, 0.0), beams: beams.collect() };
//! for _ in 0..3 {
//!     let _counts = map.insert(&scan)?;
//! }
//! assert!(map.probability_at(2.01, 0.01).is_some_and(|p| p > 0.7));
//! assert!(map.probability_at(1.0, 0.0).is_some_and(|p| p < 0.3));
//! assert_eq!(map.probability_at(3.0, 0.0), None); // never seen
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use settings::TableDescription;

mod lines;
mod occupancy;
mod pose_step;
mod scan;
mod topology;

pub use lines::{
    AlignmentConfig, Assigned, FoundLines, LineAlignment, LineError, LineFinder, LineFinderConfig,
    LineMixture, LineStretch, PlanarLine, ScanPiece, SplitAndMergeConfig, WeightedPoint,
    split_and_merge,
};
pub use occupancy::{
    BeamLikelihood, BeamLikelihoodConfig, CellBelief, LaserModel, OccupancyConfig, OccupancyError,
    OccupancyMap, ScanCounts, SonarConfig, SonarModel, log_odds, odds, probability_of_log_odds,
    probability_of_odds, updated_odds,
};
pub use pose_step::PoseStep;
pub use scan::{PlanarBeam, PlanarScan, SweptBeam};
pub use topology::{
    Doorway, GraphPlace, GraphPlan, GraphWay, Rooms, VoronoiCells, VoronoiGraph, VoronoiGraphConfig,
};

/// The tables of settings of what is no world model of a robot's.
pub const TABLES: &[TableDescription] = &[
    TableDescription::of::<SonarConfig>(),
    TableDescription::of::<BeamLikelihoodConfig>(),
    TableDescription::of::<SplitAndMergeConfig>(),
    TableDescription::of::<LineFinderConfig>(),
    TableDescription::of::<AlignmentConfig>(),
    TableDescription::of::<VoronoiGraphConfig>(),
];
