//! The map that a robot is told before it starts. It is read once: world model, localizer and planner share what follows from it.

mod around;
mod config;
mod floors;
mod known_map;
mod prior;
mod recut;
mod standing;

pub use around::{AroundLimits, MapAround};
pub use config::{
    AroundTuning, FloorsTuning, InnerSurfaceTuning, KnownMapConfig, KnownMapTuning, MapSurfaces,
    PriorTuning, StandingTuning,
};
pub use floors::{CostField, Floors, Target};
pub use known_map::KnownMap;
pub use prior::{Expected, Prior};
pub use standing::{Standing, StandingRoom};
