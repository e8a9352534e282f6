//! One tick through all floors. Wires the stages together and contains no algorithm.

mod error;
mod feeling;
mod goals;
mod moving;
mod parts;
mod perception;
mod range_map;
mod registry;
mod settings;
mod step_limits;
mod tables;
mod tick;
mod timing;
mod watch;
mod ways;

pub use error::PilotError;
pub use parts::{
    BEHAVIOURS, LOCALIZERS, ListedPart, PLANNERS, SEGMENTERS, Slot, WALKERS, WORLD_MODELS,
    components,
};
pub use perception::{Perception, PerceptionConfig, PerceptionTuning};
pub use range_map::{ChosenSegmenter, RangeMap, SightNeeds};
pub use registry::Components;
pub use settings::{GoalSettings, Navigation, Settings, StartSettings};
pub use step_limits::step_limits;
pub use tables::{sized, tables};
pub use tick::{Pilot, Tick};
pub use timing::{STAGES, Timing};
pub use ways::Ways;
