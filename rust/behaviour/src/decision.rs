//! What every behaviour sees and says.

use geometry::PlanarPose;
use localization::Estimate;
use mapping::{FloorView, HeightMap};
use planning::footsteps::{FootstepPlan, NoFootsteps, PlanTimes};
use planning::{Goal, Plan};
use stairs::Staircase;

use crate::{Command, Stepping};

/// Why a behaviour failed as a program.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BehaviourError {
    /// A behaviour of the user's failed.
    #[error("{0}")]
    Failed(String),
}

/// A sole, by the joints.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SoleAt {
    /// Its middle, and its heading, in the robot's frame.
    pub pose: PlanarPose,
    /// Its height above the robot's ground, m.
    pub height_m: f64,
    /// Its rise per metre, along it and to its left.
    pub slope: [f64; 2],
}

/// Everything a decision may rest on.
#[derive(Debug, Clone, Copy)]
pub struct Situation<'a> {
    /// Nanoseconds since the start.
    pub time_ns: u64,
    /// Where the robot believes to be.
    pub estimate: &'a Estimate,
    /// What it knows of the floor.
    pub view: &'a FloorView,
    /// The stairs that it sees or remembers.
    pub stairs: &'a Staircase,
    /// The way to the goal, once one was planned.
    pub plan: Option<&'a Plan>,
    /// The goal that is pursued now.
    pub goal: &'a Goal,
    /// Whether that goal is the last one (not a via point).
    pub last_goal: bool,
    /// Whether the walker stands still on both soles.
    pub standing: bool,
    /// Where the soles are, left and right.
    pub soles: [SoleAt; 2],
    /// Whether the walker takes listed footsteps. Who lists them for one that does not refuses.
    pub takes_footsteps: bool,
    /// How the listed footsteps go.
    pub stepping: Stepping,
    /// Where the head looks now.
    pub gaze: crate::Gaze,
    /// Depth frames taken into the map so far.
    pub frames_used: u64,
    /// When the last frame was taken into the map, nanoseconds since the start; `None` before the first.
    pub last_frame_ns: Option<u64>,
    /// Share of the pixels of the newest picture that were measured; `None` without a picture that was taken anew.
    pub measured_share: Option<f64>,
}

/// What the robot declares.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// It has arrived and stands.
    GoalReached,
    /// It found no way that it may take, and stands. `word: sentence`.
    Refused(String),
}

/// The product of a behaviour.
#[derive(Debug, Clone, PartialEq)]
pub struct Decision {
    /// What the walker is told.
    pub command: Command,
    /// Name of the state, as in the recording's lane.
    pub state: &'static str,
    /// Set when a via point is passed: go for the next goal.
    pub goal_passed: bool,
    /// Set when the episode is over for the robot.
    pub outcome: Option<Outcome>,
}

/// Decides what to do next.
pub trait Behaviour: Send + Sync {
    /// The decision at a control tick.
    fn next(&mut self, situation: &Situation<'_>) -> Result<Decision, BehaviourError>;

    /// The footsteps that it planned last, to look at; none of a behaviour that plans none.
    fn planned_footsteps(&self) -> Option<PlannedFootsteps<'_>> {
        None
    }
}

/// Footsteps that a behaviour planned, and over what ground. Nothing that decides reads it.
#[derive(Debug, Clone, Copy)]
pub struct PlannedFootsteps<'a> {
    /// The plan, or why there was none.
    pub plan: Result<&'a FootstepPlan, NoFootsteps>,
    /// The ground as it was known then.
    pub ground: &'a HeightMap,
    /// How long the planning took.
    pub times: PlanTimes,
    /// How many plans there were until then, this one too.
    pub count: u64,
    /// Why steps that the planner listed were not taken, the last time that they were not.
    pub refused: Option<&'a str>,
}
