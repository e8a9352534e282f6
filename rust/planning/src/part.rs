//! What a planner is made of. Those that come with the crate stand in `lib.rs`, a line each.

use known_map::KnownMap;
use robot::Body;
use settings::{MakeError, Part, Tables};
use stairs::Feet;

use crate::Planner;

/// What a planner can be made of.
#[derive(Clone, Copy)]
pub struct PlannerNeeds<'a> {
    /// The tables of `[navigation]`.
    pub tables: &'a Tables,
    /// The robot's body.
    pub body: &'a Body,
    /// Its feet, side by side as the walker stands on them.
    pub feet: Feet,
    /// The map that the robot was told, if any.
    pub known_map: Option<&'a KnownMap>,
}

/// A planner that has a name.
pub type PlannerPart = Part<fn(&PlannerNeeds<'_>) -> Result<Box<dyn Planner>, MakeError>>;
