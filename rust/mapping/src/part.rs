//! What a world model is made of. Those that come with the crate stand in `lib.rs`, a line each.

use known_map::KnownMap;
use settings::{MakeError, Part, Tables};

use crate::WorldModel;

/// What a world model can be made of.
#[derive(Clone, Copy)]
pub struct WorldModelNeeds<'a> {
    /// The tables of `[navigation]`.
    pub tables: &'a Tables,
    /// The map that the robot was told, if any.
    pub known_map: Option<&'a KnownMap>,
    /// Room that the robot needs above a floor, m, where nothing else is set; `None` without a robot.
    pub headroom_m: Option<f64>,
}

/// A world model that has a name.
pub type WorldModelPart = Part<fn(&WorldModelNeeds<'_>) -> Result<Box<dyn WorldModel>, MakeError>>;
