//! What a climb asks of a tick: whether the robot is at the goal, and whether the way there leads over stairs.

use planning::{Refusal, Step};

use super::StairClimbing;

use crate::machine::Tick;

impl StairClimbing {
    /// Whether the robot stands in the disc of the last goal, at its height where it has one.
    pub(super) fn is_in_the_goal(&self, tick: &Tick<'_>) -> bool {
        tick.is_in_the_goal(self.climbing.levels.told)
    }

    /// Whether the robot stands in the disc of the last goal, which has a height, at that height.
    pub(super) fn is_at_the_goal(&self, tick: &Tick<'_>) -> bool {
        tick.situation.goal.height_m.is_some() && self.is_in_the_goal(tick)
    }

    /// Whether the robot stands in the goal and has it on this side of the step: to take it would be to leave the goal.
    pub(super) fn leaves_the_goal_by(&self, tick: &Tick<'_>, step: &Step) -> bool {
        self.is_in_the_goal(tick) && step.stair.front.beyond_m(tick.goal_m()) < 0.0
    }
}

impl Tick<'_> {
    /// Whether the planner finds no way because of what stairs or slopes are like.
    pub(super) fn breaks_a_limit(&self) -> bool {
        let way = self.situation.plan.map(|plan| &plan.way);
        matches!(way, Some(Err(no_way)) if matches!(
            no_way.refusal,
            Refusal::StepTooHigh
                | Refusal::TreadTooShort
                | Refusal::GapTooShort
                | Refusal::TooSteep
                | Refusal::Drop
                | Refusal::TooLow
        ))
    }

    /// Whether the goal is known to be on another level than the robot.
    pub(super) fn goal_is_elsewhere(&self, floor_max_m: f64) -> bool {
        self.goal_off_level_m()
            .is_some_and(|off_m| off_m > floor_max_m)
    }

    /// Whether the robot stands in the disc of the last goal, at its height where it has one.
    /// Heights that differ by less than `level_m` are the same.
    fn is_in_the_goal(&self, level_m: f64) -> bool {
        let on_level = self.goal_off_level_m().is_none_or(|off_m| off_m < level_m);
        let inside = self.goal_away_m() < self.situation.goal.radius_m;
        self.situation.last_goal && on_level && inside
    }

    /// Whether the plan leads on without a climb.
    pub(super) fn has_level_way(&self) -> bool {
        let way = self.situation.plan.map(|plan| &plan.way);
        matches!(way, Some(Ok(path)) if path.climbs.is_empty())
    }
}
