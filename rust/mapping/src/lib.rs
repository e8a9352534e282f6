//! World models: what the robot knows of the ground around it.

mod averaging;
mod model;
pub mod surface;
mod two_maps;

pub use averaging::{Averaging, AveragingConfig, AveragingTuning};
pub use model::{FloorView, Insertion, MapError, Surface, Voxel, WorldModel};
pub use surface::{Fog, FogConfig, FogTuning};
pub use two_maps::{
    BeamsTuning, EmptySightTuning, KnownSurfacesTuning, TwoMaps, TwoMapsConfig, TwoMapsTuning,
};
pub use volume::{Clearing, Update};
