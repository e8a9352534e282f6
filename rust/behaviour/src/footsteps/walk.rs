//! The state `walk`: the walk to the next height change, or to the goal.

use planning::{Path, Plan};

use super::{Footsteps, State};
use crate::machine::Tick;
use crate::{Behaviour, BehaviourError, Decision, Motion, Outcome, Situation};

impl Footsteps {
    /// Lets `walking` decide again.
    pub(super) fn begin_walk(&mut self, tick: &Tick<'_>) {
        self.walking.resume(tick.situation);
        self.failed.forget();
        self.looks = 0;
        self.enter(State::Walk);
    }

    /// One tick of `walking`, on the way to the next height change or to the goal.
    pub(super) fn walk(&mut self, tick: &Tick<'_>) -> Result<Decision, BehaviourError> {
        let situation = tick.situation;
        let looking = self.walking.is_looking_around();
        let steps_here = !looking && !situation.estimate.lost && !self.has_given_up_here(tick);
        let climb_away_m = climb_away_m(tick);
        if steps_here && climb_away_m.is_some_and(|away_m| away_m < self.config.stop_before) {
            self.head.gazer.start(situation.gaze);
            self.begin_look(tick, None);
            return Ok(self.decision(tick, Motion::Stand));
        }
        let cut = climb_away_m.and_then(|_| self.cut_plan(tick));
        let decision = self.walking.next(&Situation {
            plan: cut.as_ref().or(situation.plan),
            last_goal: situation.last_goal && cut.is_none(),
            ..*situation
        })?;
        let refuses = matches!(decision.outcome, Some(Outcome::Refused(_)));
        let no_way = self.walking.no_way_s() > self.config.no_way_after && tick.situation.standing;
        if steps_here && tick.finds_no_way() && (refuses || no_way) {
            self.head.gazer.start(situation.gaze);
            self.begin_look(tick, None);
            return Ok(self.decision(tick, Motion::Stand));
        }
        Ok(Decision {
            goal_passed: decision.goal_passed && cut.is_none(),
            ..decision
        })
    }

    /// Whether stepping was given up here.
    fn has_given_up_here(&self, tick: &Tick<'_>) -> bool {
        let (times, place) = &self.given_up;
        let near = place.is_some_and(|place| place.distance_m(&tick.pose) < self.config.elsewhere);
        near || *times >= self.config.tries
    }

    /// The plan up to a place before the first height change.
    fn cut_plan(&self, tick: &Tick<'_>) -> Option<Plan> {
        let plan = tick.situation.plan?;
        let path = plan.way.as_ref().ok()?;
        let climb = path.climbs.first()?;
        let front = &climb.steps.first()?.stair.front;
        let end = climb.from_point.min(path.points_m.len().checked_sub(1)?);
        let before_m = self.config.stop_before - self.config.stop_slack;
        let before = |place_m: &[f64; 2]| front.beyond_m(*place_m) < -before_m;
        let kept = path.points_m[..=end].iter().rposition(before)? + 1;
        let cut = Path {
            points_m: path.points_m[..kept].to_vec(),
            unknown: path.unknown.iter().take(kept).copied().collect(),
            clearance_m: path.clearance_m.iter().take(kept).copied().collect(),
            sidles: path
                .sidles
                .iter()
                .filter(|sidle| sidle.to_point < kept)
                .copied()
                .collect(),
            cost_m: path.cost_m,
            ..Path::default()
        };
        Some(Plan {
            way: Ok(cut),
            replanned: plan.replanned,
        })
    }

    /// Whether the robot may walk on from here: its way is level, and the next height change is far.
    pub(super) fn may_walk_on(&self, tick: &Tick<'_>) -> bool {
        let level = !tick.finds_no_way() && tick.situation.plan.is_some();
        level && climb_away_m(tick).is_none_or(|away_m| away_m > self.config.walk_on)
    }
}

/// How far the first height change of the plan is away along the way, m.
pub(super) fn climb_away_m(tick: &Tick<'_>) -> Option<f64> {
    let path = tick.situation.plan?.way.as_ref().ok()?;
    let climb = path.climbs.first()?;
    let front = &climb.steps.first()?.stair.front;
    let end = climb.from_point.min(path.points_m.len().saturating_sub(1));
    let way = &path.points_m[..=end];
    let along_m: f64 = way
        .windows(2)
        .map(|pair| geometry::distance_m(pair[0], pair[1]))
        .sum();
    let before_m = -front.beyond_m([tick.pose.x_m, tick.pose.y_m]);
    Some(along_m.max(before_m))
}
