//! Worlds that change (004, section 36.4): what moves is found, followed, predicted and kept out of maps; maps on several time scales; parts with
//! states, such as doors; what is static alone; and how long a plain occupancy grid takes to unlearn.
//!
//! ```
//! use dynamic_scenes::{MovingConfig, MovingThings, RangeView};
//! use geometry::PlanarPose;
//! use plan_view::{PlanarBeam, PlanarScan};
//!
//! let config = MovingConfig::default();
//! let mut things = MovingThings::new(config.clone())?;
//! for frame in 0..60 {
//!     let time_s = 0.1 * f64::from(frame);
//!     let walker_m = [1.5, -1.0 + 0.3 * time_s]; // before a wall 4 m away
//!     let beams = (-400..=400).map(|beam| {
//!         let bearing_rad = 0.002 * f64::from(beam);
//!         let to_walker = libm::atan2(walker_m[1], walker_m[0]) - bearing_rad;
//!         let range_m = if to_walker.abs() < 0.08 { 1.5 } else { 4.0 };
//!         PlanarBeam::new(bearing_rad, Some(range_m))
//!     });
//!     let scan = PlanarScan { map_from_sensor: PlanarPose::new(0.0, 0.0, 0.0), beams: beams.collect() };
//!     let points: Vec<_> = scan.ends_m().map(|[x_m, y_m]| ([x_m, y_m, 0.5], 0.5)).collect();
//!     let _of_points = things.see(RangeView::of_scan(time_s, &scan, &config.views), points);
//! }
//! let track = &things.tracks()[0];
//! assert!(track.moves && (track.predicted(1.0).at_m[1] - (-1.0 + 0.3 * 6.9)).abs() < 0.2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod config;
mod moving_things;
mod states;
mod static_map;
mod static_points;
mod timescales;
mod tracks;
mod unlearning;
mod views;

use settings::TableDescription;

pub use config::MovingConfig;
pub use moving_things::MovingThings;
pub use states::{ChangingPart, StatefulMap, StatesConfig, learn_states};
pub use static_map::{StaticCells, StaticMapConfig, static_map};
pub use static_points::{GoneConfig, StaticPoints};
pub use timescales::{TimescaleMaps, TimescalesConfig};
pub use tracks::{
    ClustersConfig, MovingCluster, MovingTrack, MovingTracks, PointOfView, PredictedPlace,
    TrackFilter, TrackPoint, TracksConfig, moving_clusters,
};
pub use unlearning::free_looks_to_unlearn;
pub use views::{PictureShape, PointLooks, RangeView, ViewMemory, ViewsConfig};

/// The tables of settings of what no robot has on its way; [`MovingConfig`] is the pilot's.
pub const TABLES: &[TableDescription] = &[
    TableDescription::of::<TimescalesConfig>(),
    TableDescription::of::<StatesConfig>(),
    TableDescription::of::<StaticMapConfig>(),
];
