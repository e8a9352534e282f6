//! The state `walk`: the walk to the next height change, or to the goal.

use planning::footsteps::{FootstepPlan, StepManner};
use planning::{Path, Plan};

use super::route::LastSteps;
use super::{Footsteps, State};
use crate::machine::Tick;
use crate::{Behaviour, BehaviourError, Decision, Motion, Outcome, Situation};

/// The walk before the next height change.
#[derive(Debug, Clone)]
pub(super) struct Lead {
    /// A plan for `walking` up to there.
    plan: Plan,
    /// How far it was, m.
    step_away_m: f64,
    /// From where it was so far, m.
    from_m: [f64; 2],
}

impl Lead {
    /// How far the first height change is now, m.
    fn step_away_m(&self, tick: &Tick<'_>) -> f64 {
        self.step_away_m - geometry::distance_m(self.from_m, [tick.pose.x_m, tick.pose.y_m])
    }

    /// Along the first steps of a plan, as far as they are walked.
    fn along(plan: &FootstepPlan, tick: &Tick<'_>) -> Option<Self> {
        let careful = (plan.steps.iter()).position(|step| step.manner == StepManner::Careful);
        let walked = &plan.steps[..careful.unwrap_or(plan.steps.len())];
        let mut feet = Footsteps::soles(tick);
        let mut points_m = vec![[tick.pose.x_m, tick.pose.y_m]];
        for step in walked {
            feet[step.side.index()] = step.pose;
            let [left, right] = &feet;
            points_m.push([
                f64::midpoint(left.x_m, right.x_m),
                f64::midpoint(left.y_m, right.y_m),
            ]);
        }
        let along_m = points_m
            .windows(2)
            .map(|pair| geometry::distance_m(pair[0], pair[1]));
        let step_away_m = along_m.sum();
        let count = points_m.len();
        let path = Path {
            points_m,
            unknown: vec![false; count],
            clearance_m: vec![f64::INFINITY; count],
            ..Path::default()
        };
        (count > 1 || careful.is_some()).then_some(Self {
            plan: Plan {
                way: Ok(path),
                replanned: false,
            },
            step_away_m,
            from_m: [tick.pose.x_m, tick.pose.y_m],
        })
    }
}

impl Footsteps {
    /// Lets `walking` decide again.
    pub(super) fn begin_walk(&mut self, tick: &Tick<'_>) {
        self.walking.resume(tick.situation);
        self.failed.forget();
        self.felt.clear();
        self.stances.forget();
        self.last = LastSteps::default();
        self.looks = 0;
        self.enter(State::Walk);
    }

    /// One tick of `walking`, on the way to the next height change or to the goal.
    pub(super) fn walk(&mut self, tick: &Tick<'_>) -> Result<Decision, BehaviourError> {
        let situation = tick.situation;
        let steps_here = !situation.estimate.lost && !self.has_given_up_here(tick);
        if tick.new_frame {
            self.lead = if steps_here {
                self.find_lead(tick)
            } else {
                None
            };
        }
        let looking = self.walking.is_looking_around();
        if looking && self.lead.is_some() && self.machine.lasted_s() > self.config.first_look {
            self.walking.end_look();
        }
        let climbs = has_climbs(tick);
        let near = self.lead.as_ref().map_or(climbs, |lead| {
            lead.step_away_m(tick) < self.config.stop_before
        });
        if steps_here && !looking && (near || self.is_at_list(tick)) {
            return Ok(self.stop_to_step(tick));
        }
        let led = self.lead.as_ref().map(|lead| &lead.plan);
        // Nobody walks along a way that leads over a height change.
        let level = situation.plan.filter(|_| !climbs);
        let (led, plan) = (led.is_some(), led.or(level));
        let decision = self.walking.next(&Situation {
            plan,
            last_goal: situation.last_goal && !led,
            ..*situation
        })?;
        let refuses = matches!(decision.outcome, Some(Outcome::Refused(_)));
        let no_way = self.walking.no_way_s() > self.config.no_way_after && situation.standing;
        if steps_here && !looking && tick.finds_no_way() && (refuses || no_way) {
            return Ok(self.stop_to_step(tick));
        }
        Ok(Decision {
            goal_passed: decision.goal_passed && !led,
            ..decision
        })
    }

    fn stop_to_step(&mut self, tick: &Tick<'_>) -> Decision {
        self.lead = None;
        self.head.gazer.start(tick.situation.gaze);
        self.begin_look(tick, None);
        self.decision(tick, Motion::Stand)
    }

    /// Where the walk leads to the first height change: by the footsteps that are planned to the goal, where the planner's way there is not
    /// level all along; else along the planner's way. Planned anew every few frames.
    fn find_lead(&mut self, tick: &Tick<'_>) -> Option<Lead> {
        let way = tick.situation.plan.and_then(|plan| plan.way.as_ref().ok());
        let level = way.is_some_and(|path| path.climbs.is_empty() && path.end.is_certain());
        if level && !self.goal_is_elsewhere(tick) {
            return None;
        }
        if !tick
            .situation
            .frames_used
            .is_multiple_of(self.config.plan_every)
        {
            return self.lead.take();
        }
        let feet = Self::soles(tick);
        self.read_ground(tick, &self.standing(tick));
        let found = self.plan_from(tick, feet, None, &[]).ok();
        let by_steps = found.filter(|plan| plan.exit_m.is_none() || way.is_none());
        by_steps
            .and_then(|plan| Lead::along(&plan, tick))
            .or_else(|| self.lead_of_planner(tick))
    }

    fn goal_is_elsewhere(&self, tick: &Tick<'_>) -> bool {
        tick.goal_off_level_m()
            .is_some_and(|off_m| off_m > self.told_m)
    }

    fn lead_of_planner(&self, tick: &Tick<'_>) -> Option<Lead> {
        Some(Lead {
            step_away_m: climb_away_m(tick)?,
            plan: self.cut_plan(tick)?,
            from_m: [tick.pose.x_m, tick.pose.y_m],
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
        Some(Plan {
            way: Ok(path.first(kept)),
            replanned: plan.replanned,
        })
    }

    /// Whether the robot may walk on from here: its way is level, and the next height change is far.
    pub(super) fn may_walk_on(&self, tick: &Tick<'_>) -> bool {
        let level = !tick.finds_no_way() && tick.situation.plan.is_some();
        level && climb_away_m(tick).is_none_or(|away_m| away_m > self.config.walk_on)
    }
}

/// Whether the planner's way leads over a height change.
fn has_climbs(tick: &Tick<'_>) -> bool {
    let path = tick.situation.plan.and_then(|plan| plan.way.as_ref().ok());
    path.is_some_and(|path| !path.climbs.is_empty())
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
