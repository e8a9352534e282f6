//! What every planner produces: a path, or the reason why there is none.

use geometry::{Goal, Map, PlanarPose, Pose, Robot};
use mapping::FloorView;
use stairs::{Stair, Staircase};

use crate::footsteps::ListedStep;

/// Why planning failed as a program. "There is no way" is no failure: see [`NoWay`].
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PlanError {
    /// A start or goal that is no number.
    #[error("{0} must be finite")]
    NotFinite(&'static str),
    /// A planner of the user's failed.
    #[error("{0}")]
    Failed(String),
}

/// Where the robot stands, and how high, m, when this and the goal are numbers.
pub(crate) fn place_of(
    start: &Pose<Map, Robot>,
    goal: &Goal,
) -> Result<(PlanarPose, f64), PlanError> {
    let origin = start.origin().inner;
    let place = PlanarPose::new(origin.x, origin.y, start.yaw_rad());
    if !(place.x_m + place.y_m + place.yaw_rad + origin.z).is_finite() {
        return Err(PlanError::NotFinite("the start"));
    }
    let height_m = goal.height_m.unwrap_or(0.0);
    if !(goal.x_m + goal.y_m + goal.radius_m + height_m).is_finite() {
        return Err(PlanError::NotFinite("the goal"));
    }
    Ok((place, origin.z))
}

/// One step up or down on the way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// The stair that is stepped on.
    pub stair: Stair<Map>,
    /// Change of height onto it, m.
    pub rise_m: f64,
    /// Where the way crosses its front edge, m.
    pub crossing_m: [f64; 2],
}

/// A leg of a path that is climbed: steps one behind the other.
#[derive(Debug, Clone, PartialEq)]
pub struct Climb {
    /// Index of the path's point from which the first step is taken.
    pub from_point: usize,
    /// Index of the path's point at which the last one ends.
    pub to_point: usize,
    /// The steps in their order.
    pub steps: Vec<Step>,
}

/// A leg of a path that is walked sideways, straight, through what is too narrow to be walked straight ahead.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sidle {
    /// Index of the path's point at which the robot has turned.
    pub from_point: usize,
    /// Index of the path's point at which it may turn back.
    pub to_point: usize,
    /// Where it faces in between, rad, in the map.
    pub heading_rad: f64,
}

/// Where a path ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PathEnd {
    /// In the goal's disc.
    #[default]
    Goal,
    /// At the border of the window: the goal lies outside, or the way there does.
    Border,
    /// On a stair behind which, or on unseen ground where, the way may go on.
    Hope,
    /// At a place from which more is to be seen.
    Look,
}

impl PathEnd {
    /// As it is written in results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Goal => "goal",
            Self::Border => "border",
            Self::Hope => "hope",
            Self::Look => "look",
        }
    }

    /// Whether everything up to there is as it should be.
    pub const fn is_certain(self) -> bool {
        matches!(self, Self::Goal | Self::Border)
    }
}

/// A path on the ground: legs that are walked, and between them legs that are climbed or walked sideways.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Path {
    /// Points in the map frame from the robot to the goal, m, no further apart than a cell's diagonal.
    pub points_m: Vec<[f64; 2]>,
    /// For each point, whether what lies there was never seen.
    pub unknown: Vec<bool>,
    /// For each point, distance to the nearest obstacle, m.
    pub clearance_m: Vec<f64>,
    /// The legs that are climbed, in their order; all else is walked.
    pub climbs: Vec<Climb>,
    /// The legs that are walked sideways, in their order.
    pub sidles: Vec<Sidle>,
    /// First and last point of each piece at stairs or in a passage, with what is walked close to edges there.
    pub spans: Vec<[usize; 2]>,
    /// Where a planner of the user's would put the feet, in their order. The behaviour `footsteps` takes these steps as long as they hold; no other
    /// behaviour reads them.
    pub footsteps: Vec<ListedStep>,
    /// Where it ends.
    pub end: PathEnd,
    /// What it costs, in metres of open known floor.
    pub cost_m: f64,
}

impl Path {
    /// Its first points as a way of their own, that is walked: with the sidles that end among them, and no climbs.
    #[must_use]
    pub fn first(&self, points: usize) -> Self {
        let ends = |sidle: &&Sidle| sidle.to_point < points;
        Self {
            points_m: self.points_m.iter().take(points).copied().collect(),
            unknown: self.unknown.iter().take(points).copied().collect(),
            clearance_m: self.clearance_m.iter().take(points).copied().collect(),
            sidles: self.sidles.iter().filter(ends).copied().collect(),
            cost_m: self.cost_m,
            ..Self::default()
        }
    }
}

/// The word of a refusal, as in `result.json`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Refusal {
    /// Something stands in every way.
    Blocked,
    /// Something hangs lower than the robot is high.
    TooLow,
    /// There are gaps, but none is as wide as the robot.
    TooNarrow,
    /// Steps lead there, but one is too high.
    StepTooHigh,
    /// What is to be stepped on is so low that it is floor.
    StepTooLow,
    /// Steps lead there, but one is too short for a sole.
    TreadTooShort,
    /// The ground between a way down and a way up is too short for a sole.
    GapTooShort,
    /// A slope leads there, but it is too steep to be walked on.
    TooSteep,
    /// A drop.
    Drop,
    /// No other word holds.
    NoPath,
}

impl Refusal {
    /// The word as written in `result.json`.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Blocked => "blocked",
            Self::TooLow => "too_low",
            Self::TooNarrow => "too_narrow",
            Self::StepTooHigh => "step_too_high",
            Self::StepTooLow => "step_too_low",
            Self::TreadTooShort => "tread_too_short",
            Self::GapTooShort => "gap_too_short",
            Self::TooSteep => "too_steep",
            Self::Drop => "drop",
            Self::NoPath => "no_path",
        }
    }
}

/// There is no way that the robot may take.
#[derive(Debug, Clone, PartialEq)]
pub struct NoWay {
    /// The most specific word that holds.
    pub refusal: Refusal,
    /// One sentence with figures.
    pub sentence: String,
    /// Whether what is known stands all around the goal: nothing that is seen elsewhere could open a way.
    pub shuts_goal_in: bool,
}

impl NoWay {
    /// A reason that may not last: something else may show where nobody looked yet.
    pub const fn new(refusal: Refusal, sentence: String) -> Self {
        Self {
            refusal,
            sentence,
            shuts_goal_in: false,
        }
    }
}

/// The product of a planner.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// The way, or why there is none.
    pub way: Result<Path, NoWay>,
    /// Whether it was planned anew; false: the path before still holds (its passed part cut off).
    pub replanned: bool,
}

/// Finds a way over the floor that the world model shows.
pub trait Planner: Send + Sync {
    /// A way for the robot at `start` to `goal`, over floor and stairs. Plans anew only when the path before no longer holds.
    fn plan(
        &mut self,
        view: &FloorView,
        stairs: &Staircase,
        start: &Pose<Map, Robot>,
        goal: &Goal,
    ) -> Result<Plan, PlanError>;

    /// The robot finds itself elsewhere than it believed: what was planned and remembered lies in the wrong place.
    fn forget(&mut self) {}

    /// Distance of each cell of the view to the nearest obstacle at the last call, m, row by row; `None` where the
    /// planner has none.
    fn distance_field_m(&self) -> Option<Vec<f32>> {
        None
    }
}
