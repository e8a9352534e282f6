//! What the states of the climb read at a tick.

use geometry::PlanarPose;
use planning::{Refusal, Step};

use crate::Situation;

/// What the states read at a tick.
#[derive(Clone, Copy)]
pub(super) struct Here<'a> {
    pub(super) situation: &'a Situation<'a>,
    pub(super) pose: PlanarPose,
    pub(super) ground_m: f64,
    pub(super) passed_s: f64,
    pub(super) new_frame: bool,
}

impl Here<'_> {
    /// A place of the map in the robot's frame, m.
    pub(super) fn in_robot(&self, [x_m, y_m]: [f64; 2]) -> [f64; 2] {
        let (x_m, y_m) = self.pose.inverse().apply(x_m, y_m);
        [x_m, y_m]
    }

    /// Why the planner finds no way, in its words.
    pub(super) fn no_way(&self) -> Option<String> {
        let no_way = self.situation.plan?.way.as_ref().err()?;
        Some(format!("{}: {}", no_way.refusal.word(), no_way.sentence))
    }

    /// Whether the planner finds no way because of what stairs are like.
    pub(super) fn breaks_a_limit(&self) -> bool {
        let way = self.situation.plan.map(|plan| &plan.way);
        matches!(way, Some(Err(no_way)) if matches!(
            no_way.refusal,
            Refusal::StepTooHigh
                | Refusal::TreadTooShort
                | Refusal::GapTooShort
                | Refusal::Drop
        ))
    }

    /// Whether the goal is known to be on another level than the robot.
    pub(super) fn goal_is_elsewhere(&self, floor_max_m: f64) -> bool {
        let height_m = self.situation.goal.height_m;
        height_m.is_some_and(|height_m| (height_m - self.ground_m).abs() > floor_max_m)
    }

    pub(super) fn goal_m(&self) -> [f64; 2] {
        [self.situation.goal.x_m, self.situation.goal.y_m]
    }

    /// Whether the robot stands in the disc of the last goal, which has a height, at that height.
    pub(super) fn is_at_the_goal(&self) -> bool {
        self.situation.goal.height_m.is_some() && self.is_in_the_goal()
    }

    /// Whether the robot stands in the disc of the last goal, at its height where it has one.
    pub(super) fn is_in_the_goal(&self) -> bool {
        const LEVEL_M: f64 = 0.02;
        let [x_m, y_m] = self.goal_m();
        let goal = self.situation.goal;
        let away_m = (x_m - self.pose.x_m).hypot(y_m - self.pose.y_m);
        let on_level = goal
            .height_m
            .is_none_or(|height_m| (height_m - self.ground_m).abs() < LEVEL_M);
        self.situation.last_goal && on_level && away_m < goal.radius_m
    }

    /// Whether the robot stands in the goal and has it on this side of the step: to take it would be to leave the goal.
    pub(super) fn leaves_the_goal_by(&self, step: &Step) -> bool {
        self.is_in_the_goal() && step.stair.front.beyond_m(self.goal_m()) < 0.0
    }

    /// Whether the plan leads on without a climb.
    pub(super) fn has_level_way(&self) -> bool {
        let way = self.situation.plan.map(|plan| &plan.way);
        matches!(way, Some(Ok(path)) if path.climbs.is_empty())
    }

    /// Seconds since a frame was last taken into the map.
    pub(super) fn unseen_s(&self) -> f64 {
        let now_ns = self.situation.time_ns;
        self.situation
            .last_frame_ns
            .map_or(0.0, |last_ns| now_ns.saturating_sub(last_ns) as f64 * 1e-9)
    }
}
