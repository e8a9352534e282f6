//! Volumes: the voxel occupancy grid, its sensor model and its rays.
#![doc = include_str!("../README.md")]

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
pub use solid::{
    DistanceField, InnerSurfaceRule, InnerSurfaces, LANES, Lanes, RangeField, SolidError,
    SolidVoxels,
};
pub use sparse::{GridKey, SparseGrid};
