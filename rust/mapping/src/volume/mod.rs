//! Volumes: the voxel occupancy grid, its sensor model and its rays.

mod columns;
mod occupancy;
mod probability;
mod ray;

pub use occupancy::{OccupancyGrid, Placement, Ray, Size};
pub use probability::{ProbabilityTable, bayes};
pub use ray::VoxelWalk;
