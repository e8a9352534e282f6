//! Where a sole finds support: how high and tilted it stands on a height map, and which part of it bears; and whether a foot on its way, or
//! the body over the feet, meets anything.

mod config;
mod foothold;
mod high_blocks;
mod raster;
mod resting_plane;
mod surroundings;

pub use config::FootholdConfig;
pub use foothold::{Foothold, Footholds, NoFoothold};
pub use high_blocks::HighBlocks;
pub use raster::{SoleRaster, SoleSize};
