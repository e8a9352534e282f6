//! What the states read at a tick.

use geometry::{PlanarPose, distance_m};

use crate::Situation;

/// A tick as the states read it: the situation, and what follows from it alone.
#[derive(Clone, Copy)]
pub(crate) struct Tick<'a> {
    /// All that a decision may rest on.
    pub(crate) situation: &'a Situation<'a>,
    /// Where the robot believes to be in the map.
    pub(crate) pose: PlanarPose,
    /// Height of the ground there, m.
    pub(crate) ground_m: f64,
    /// Time since the last tick, s.
    pub(crate) passed_s: f64,
    /// Time since the first tick in which the behaviour decided, s.
    pub(crate) elapsed_s: f64,
    /// Whether a frame was taken into the map since the last tick.
    pub(crate) new_frame: bool,
}

impl Tick<'_> {
    /// A place of the map in the robot's frame, m.
    pub(crate) fn in_robot(&self, [x_m, y_m]: [f64; 2]) -> [f64; 2] {
        let (x_m, y_m) = self.pose.inverse().apply(x_m, y_m);
        [x_m, y_m]
    }

    /// Direction of a place of the map, rad to the left of straight ahead.
    pub(crate) fn bearing_rad(&self, place_m: [f64; 2]) -> f64 {
        let [x_m, y_m] = self.in_robot(place_m);
        libm::atan2(y_m, x_m)
    }

    /// Whether the planner finds no way.
    pub(crate) fn finds_no_way(&self) -> bool {
        self.situation.plan.is_some_and(|plan| plan.way.is_err())
    }

    /// Why the planner finds no way, in its words.
    pub(crate) fn no_way_reason(&self) -> Option<String> {
        let no_way = self.situation.plan?.way.as_ref().err()?;
        Some(format!("{}: {}", no_way.refusal.word(), no_way.sentence))
    }

    /// The middle of the goal, m.
    pub(crate) const fn goal_m(&self) -> [f64; 2] {
        [self.situation.goal.x_m, self.situation.goal.y_m]
    }

    /// How far the goal's middle is away, m.
    pub(crate) fn goal_away_m(&self) -> f64 {
        distance_m(self.goal_m(), [self.pose.x_m, self.pose.y_m])
    }

    /// How far above or below the robot's ground the goal is, m, where its height is told.
    pub(crate) fn goal_off_level_m(&self) -> Option<f64> {
        let height_m = self.situation.goal.height_m?;
        Some((height_m - self.ground_m).abs())
    }

    /// Whether no more than this share of the newest picture was measured, once anything was.
    pub(crate) fn is_dark(&self, share: f64) -> bool {
        let situation = self.situation;
        situation.frames_used > 0 && situation.measured_share.unwrap_or(0.0) <= share
    }

    /// Time since a frame was last taken into the map, s; before the first since the behaviour began.
    pub(crate) fn unseen_s(&self) -> f64 {
        let since_s = |last_ns| self.situation.time_ns.saturating_sub(last_ns) as f64 * 1e-9;
        self.situation.last_frame_ns.map_or(self.elapsed_s, since_s)
    }
}
