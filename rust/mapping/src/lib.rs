//! World models: what the robot knows of the ground around it.

mod averaging;
mod model;
mod storage;
pub mod surface;
pub mod volume;

pub use averaging::{Averaging, AveragingConfig};
pub use model::{FloorView, Insertion, MapError, Surface, WorldModel};
pub use surface::{Clearing, Fog, FogConfig, Update};
