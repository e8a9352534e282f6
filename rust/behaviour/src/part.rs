//! What a behaviour is made of. Those that come with the crate stand in `lib.rs`, a line each.

use planning::footsteps::StepLimits;
use robot::Body;
use settings::{MakeError, Part, Tables};
use stairs::Feet;

use crate::Behaviour;

/// What a behaviour can be made of.
#[derive(Clone, Copy)]
pub struct BehaviourNeeds<'a> {
    /// The tables of `[navigation]`.
    pub tables: &'a Tables,
    /// The robot's body.
    pub body: &'a Body,
    /// Its feet, side by side as the walker stands on them.
    pub feet: Feet,
    /// What its steps are limited by.
    pub steps: StepLimits,
}

/// A behaviour that has a name.
pub type BehaviourPart = Part<fn(&BehaviourNeeds<'_>) -> Result<Box<dyn Behaviour>, MakeError>>;
