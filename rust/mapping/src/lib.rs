//! World models: what the robot knows of the ground around it.

mod averaging;
mod model;
pub mod surface;
mod two_maps;

pub use averaging::{Averaging, AveragingConfig};
pub use model::{FloorView, Insertion, MapError, Surface, Voxel, WorldModel};
pub use surface::{Fog, FogConfig};
pub use two_maps::{TwoMaps, TwoMapsConfig};
pub use volume::{Clearing, Update};
