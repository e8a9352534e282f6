//! What a localizer is made of. Those that come with the crate stand in `lib.rs`, a line each.

use geometry::{Map, Pose, Robot};
use known_map::KnownMap;
use robot::Body;
use settings::{MakeError, Part, Tables};

use crate::Localizer;

/// What a localizer can be made of.
#[derive(Clone, Copy)]
pub struct LocalizerNeeds<'a> {
    /// The tables of `[navigation]`.
    pub tables: &'a Tables,
    /// The robot's frame in the map at the start, where somebody says it.
    pub start: Option<Pose<Map, Robot>>,
    /// The robot's body.
    pub body: &'a Body,
    /// Distance between the middles of its soles as the walker stands on them, m.
    pub stance_m: f64,
    /// The map that the robot was told, if any.
    pub known_map: Option<&'a KnownMap>,
}

impl LocalizerNeeds<'_> {
    /// The robot's frame in the map at the start: the map's origin where nobody says.
    pub fn start_or_origin(&self) -> Pose<Map, Robot> {
        self.start.unwrap_or_else(Pose::identity)
    }
}

/// A localizer that has a name.
pub type LocalizerPart = Part<fn(&LocalizerNeeds<'_>) -> Result<Box<dyn Localizer>, MakeError>>;
