//! World models: what the robot knows of the ground around it.

mod averaging;
mod model;
mod storage;
pub mod surface;
mod two_maps;
pub mod volume;

pub use averaging::{Averaging, AveragingConfig};
pub use model::{FloorView, Insertion, MapError, Surface, Voxel, WorldModel};
pub use surface::{Clearing, Fog, FogConfig, Update};
pub use two_maps::{TwoMaps, TwoMapsConfig};
