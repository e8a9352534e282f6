//! Volumes: the voxel occupancy grid, its sensor model and its rays.

mod columns;
mod marks;
mod occupancy;
mod probability;
mod ray;
mod strip;
mod voxels;

pub use occupancy::{OccupancyGrid, Placement, Ray, Size};
pub use probability::{ProbabilityTable, bayes};
pub use ray::VoxelWalk;
