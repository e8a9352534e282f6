//! One tick through all floors. Wires the stages together and contains no algorithm.

mod added;
mod error;
mod goals;
mod perception;
mod registry;
mod settings;
mod tick;
mod timing;

pub use added::{Added, Make, Maker, Making, add, added};
pub use error::PilotError;
pub use perception::{Perception, PerceptionConfig, PerceptionTuning};
pub use registry::{Components, segmenter, world_model};
pub use settings::{GoalSettings, Navigation, Settings, StartSettings};
pub use tick::{Pilot, Tick};
pub use timing::{STAGES, Timing};
