//! Volumes: the voxel occupancy grid, its sensor model and its rays.
//!
//! A map of your own from any range sensor: rays in, voxels and lines of sight out.
//!
//! ```
//! use volume::octree::{Cast, Octree, OctreeConfig, Sighting};
//! use volume::{Ray, Update};
//!
//! let mut tree = Octree::new(OctreeConfig::default())?;
//! let eye_m = [0.0, 0.0, 0.5];
//! let wall: Vec<Ray> = (-20..20)
//!     .map(|y| Ray { end_m: [1.0, 0.04 * f64::from(y), 0.5], hit: true })
//!     .collect();
//! for _frame in 0..3 {
//!     tree.insert(eye_m, &wall, Update::PerFrame)?;
//! }
//! assert_eq!(tree.is_occupied_at([1.0, 0.0, 0.5]), Some(true));
//! assert_eq!(tree.is_occupied_at([0.5, 0.0, 0.5]), Some(false));
//! assert_eq!(tree.is_occupied_at([1.5, 0.0, 0.5]), None); // never seen
//!
//! let sighting = Sighting { max_range_m: 4.0, through_unknown: false };
//! assert!(matches!(tree.cast_ray(eye_m, [1.0, 0.0, 0.0], sighting), Cast::Occupied(_)));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bins;
mod columns;
mod evidence;
mod fan;
mod frustum;
mod locator;
mod marks;
mod modes;
mod occupancy;
pub mod octree;
mod picture;
mod placement;
mod probability;
mod projected;
mod raster;
mod ray;
mod reaches;
mod solid;
mod sparse;
mod sweep;
mod voxels;

pub use evidence::{EvidenceConfig, EvidenceGrid, WideBeam};
pub use locator::Locator;
pub use modes::{Clearing, Update};
pub use occupancy::OccupancyGrid;
pub use picture::Picture;
pub use placement::{Placement, Ray, Size};
pub use probability::{ProbabilityTable, bayes};
pub use ray::VoxelWalk;
pub use solid::{DistanceField, LANES, Lanes, RangeField, SolidError, SolidVoxels};
pub use sparse::{GridKey, SparseGrid};
