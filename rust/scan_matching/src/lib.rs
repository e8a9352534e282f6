//! Where a laser was when it took each of its scans: scans are matched to local maps, loops are closed between those, and what is dense moves
//! with its local map (the hybrid metric map of 004, section 36.3.6).
//!
//! ```
//! use geometry::PlanarPose;
//! use plan_view::{PlanarBeam, PlanarScan};
//! use scan_matching::{ScanSlam, ScanSlamConfig};
//!
//! let mut slam = ScanSlam::new(ScanSlamConfig::default())?;
//! // A wall 2 m ahead, seen from its distance at the start and 5 cm nearer; odometry says 9 cm.
//! for (odometry_m, wall_m) in [(0.0, 2.0), (0.09, 1.95)] {
//!     let beams = (-60..=60).map(|step| {
//!         let bearing_rad = 0.01 * f64::from(step);
//!         PlanarBeam::new(bearing_rad, Some(wall_m / bearing_rad.cos()))
//!     });
//!     let map_from_sensor = PlanarPose::new(odometry_m, 0.0, 0.0);
//!     slam.insert(&PlanarScan { map_from_sensor, beams: beams.collect() })?;
//! }
//! assert!((slam.pose(1).unwrap().x_m - 0.05).abs() < 0.01);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use settings::TableDescription;

mod beams;
mod config;
mod field;
mod local_map;
mod loops;
mod matcher;
mod maxima;
mod pose_graph;
mod search;
mod slam;
mod spread;

pub use config::{LocalMapsConfig, LoopsConfig, PoseGraphConfig, ScanMatchConfig};
pub use field::LikelihoodField;
pub use local_map::LocalMap;
pub use matcher::{ScanMatch, ScanMatcher};
pub use maxima::FieldMaxima;
pub use pose_graph::{PoseGraph, PoseLink};
pub use slam::{ScanSlam, ScanSlamConfig, ScanSlamError};

/// The tables of settings.
pub const TABLES: &[TableDescription] = &[
    TableDescription::of::<ScanMatchConfig>(),
    TableDescription::of::<LocalMapsConfig>(),
    TableDescription::of::<LoopsConfig>(),
    TableDescription::of::<PoseGraphConfig>(),
];
