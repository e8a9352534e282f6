//! What every walker is given and gives. Those that come with the crate stand in `lib.rs`, a line each.

use behaviour::{Command, Gaze, Stepping};
use proprioception::BodyState;
use robot::Body;
use sensing::Observation;
use settings::{MakeError, Part, Tables};

use crate::error::WalkError;
use crate::met::Met;
use crate::relief::Slopes;
use crate::targets::JointTargets;

/// What a walker can be made of.
#[derive(Clone, Copy)]
pub struct WalkerNeeds<'a> {
    /// The tables of `[navigation]`.
    pub tables: &'a Tables,
    /// The robot's body, with its `[gait]`.
    pub body: &'a Body,
}

/// A walker that has a name.
pub type WalkerPart = Part<fn(&WalkerNeeds<'_>) -> Result<Box<dyn Walker>, MakeError>>;

/// What the body tells at a control tick. There is no pose in it but that of the odometry.
#[derive(Debug, Clone, Copy)]
pub struct WalkerSenses<'a> {
    /// The body: order, ranges and upright stance of its joints.
    pub body: &'a Body,
    /// What encoders, inertial unit and soles measured.
    pub observation: &'a Observation,
    /// What follows from it: attitude, loads, odometry.
    pub state: &'a BodyState,
    /// How the ground slopes around the robot, by its map; `None` where that knows of no slope.
    pub slopes: Option<&'a dyn Slopes>,
}

/// Moves the legs as it is told.
pub trait Walker: Send + Sync {
    /// The targets of all joints for this tick.
    fn step(
        &mut self,
        command: &Command,
        senses: &WalkerSenses<'_>,
    ) -> Result<&JointTargets, WalkError>;

    /// Whether it stands still on both soles, as of the last step; before the first it does.
    fn standing(&self) -> bool;

    /// Landings so far.
    fn steps_taken(&self) -> u64;

    /// Where the head looks, as of the last step.
    fn gaze(&self) -> Gaze;

    /// Whether it takes listed footsteps. One that does not is never given any: the robot refuses where a behaviour lists them.
    fn takes_footsteps(&self) -> bool {
        false
    }

    /// How the listed footsteps go.
    fn stepping(&self) -> Stepping {
        Stepping::default()
    }

    /// What a foot of a walk met at the last step, in the robot's frame.
    fn met(&self) -> Option<Met> {
        None
    }

    /// Whether each foot stands, or is to land, on a slope.
    fn on_slope(&self) -> [bool; 2] {
        [false; 2]
    }

    /// Whether each foot stands, or is to land, on a slope or where a foot met something: such a sole turns under the robot.
    fn on_uneven(&self) -> [bool; 2] {
        self.on_slope()
    }
}
