//! The state `walk`: the walk to the next climb, or nearer to stairs of which too little is known (003: search).

use planning::Plan;

use super::{ApproachLeg, Pace, StairClimbing, State};
use crate::climbing::inspection::{self, Inspection};
use crate::machine::{State as _, Stopwatch, Tick};
use crate::{Behaviour, BehaviourError, Decision, Motion, Outcome, Situation};

/// What a walk finds ahead of it. It stays in mind while the robot climbs.
#[derive(Debug, Clone, Default)]
pub(super) struct ClimbAhead {
    /// The plan for `walking`: cut off before the next climb.
    plan: Option<Plan>,
    /// How long the plan has led to a climb, or to stairs that need a closer look.
    pub(super) climb: Stopwatch,
    inspection: Option<Inspection>,
    /// Whether the look around at the start is over.
    looked_around: bool,
    /// Edges of stairs that were looked at from near by, m.
    pub(super) inspected: Vec<[f64; 2]>,
}

impl ClimbAhead {
    /// Whether a climb can be counted on.
    pub(super) fn is_sure(&self, sure_after_s: f64) -> bool {
        self.climb.s() > sure_after_s
    }
}

impl StairClimbing {
    const fn first_look_s(&self) -> f64 {
        match self.pace {
            Pace::StepByStep => self.config.tuning.walk.first_look,
            Pace::Continuous => self.config.tuning.walk.first_glance,
        }
    }

    /// The next climb of the plan.
    pub(super) fn leg<'a>(&self, tick: &Tick<'a>) -> Option<ApproachLeg<'a>> {
        ApproachLeg::next(
            tick.situation.plan,
            &self.config,
            &self.climbing,
            &self.feet,
        )
    }

    /// A tick of `walking` while the robot does not know where it is.
    pub(super) fn walk_lost(&mut self, tick: &Tick<'_>) -> Result<Decision, BehaviourError> {
        self.ahead.plan = None;
        self.machine.gets_on();
        self.walking.next(tick.situation)
    }

    /// A tick of `walking` on the way to the next climb, to stairs that need a closer look, or to the goal.
    pub(super) fn walk(&mut self, tick: &Tick<'_>) -> Result<Decision, BehaviourError> {
        let situation = tick.situation;
        let leg = self.leg(tick).filter(|_| !self.is_at_the_goal(tick));
        self.machine.gets_on();
        let looking = self.walking.is_looking_around();
        self.ahead.looked_around |= !looking;
        let first_look = looking && !self.ahead.looked_around;
        if tick.new_frame {
            self.ahead.inspection = if leg.is_none() && !self.is_at_the_goal(tick) {
                self.next_inspection(tick)
            } else {
                None
            };
        }
        let climbs = leg.is_some() || self.ahead.inspection.is_some();
        self.ahead.climb.count(climbs, tick.passed_s);
        let sure = self
            .ahead
            .is_sure(self.walking.config().tuning.look_around.sure_after);
        if let Some(leg) = &leg {
            let reached = leg.is_reached(&tick.pose, &self.config.tuning.leg);
            if sure && reached && !looking && !self.looks_up(tick) {
                self.flight.adopt(leg.steps);
                self.head.gazer.start(situation.gaze);
                self.enter(State::Align);
                return Ok(self.decision(tick, Motion::Stand));
            }
            if tick.new_frame || self.ahead.plan.is_none() {
                let tuning = &self.config.tuning.leg;
                self.ahead.plan = situation.plan.and_then(|plan| leg.walk(plan, tuning));
            }
        } else if let Some(inspection) = self.ahead.inspection {
            if sure && inspection.is_reached(&tick.pose, &self.config.tuning.inspection) && !looking
            {
                self.inspect(tick, &inspection);
                return Ok(self.decision(tick, Motion::Stand));
            }
            if tick.new_frame || self.ahead.plan.is_none() {
                self.ahead.plan = Some(self.way_to(tick, &inspection));
            }
        } else if self.is_at_the_goal(tick) && !tick.has_level_way() {
            return self.walk_at_the_goal(tick);
        } else {
            self.ahead.plan = None;
            let decision = self.walking.next(situation)?;
            return Ok(self.unless_stairs_may_help(tick, decision));
        }
        if first_look && sure && self.machine.lasted_s() > self.first_look_s() {
            self.walking.end_look();
        }
        let mut decision = self.walking.next(&Situation {
            plan: self.ahead.plan.as_ref(),
            last_goal: false,
            ..*situation
        })?;
        decision.goal_passed = false;
        if first_look {
            decision.state = State::Search.name();
        }
        Ok(decision)
    }

    /// Before a climb the robot looks up at what its head would meet on the way over it, where nobody did.
    fn looks_up(&mut self, tick: &Tick<'_>) -> bool {
        let path = tick.situation.plan.and_then(|plan| plan.way.as_ref().ok());
        let within_m = self.walking.config().look_up;
        path.is_some_and(|path| self.walking.looks_up(tick, path, within_m))
    }

    /// The next stairs that need a closer look.
    fn next_inspection(&self, tick: &Tick<'_>) -> Option<Inspection> {
        let (before, room_m) = (self.before(tick), self.walking.radius_m());
        Inspection::find(tick, &before, room_m, &self.ahead.inspected)
    }

    /// The plan that leads to them.
    fn way_to(&self, tick: &Tick<'_>, inspection: &Inspection) -> Plan {
        let (room_m, tuning) = (self.walking.radius_m(), &self.config.tuning.inspection);
        inspection.plan(&tick.pose, room_m, tuning)
    }

    /// A tick of `walking` at the goal: the robot stands there already, whatever the planner makes of the surface under its feet.
    fn walk_at_the_goal(&mut self, tick: &Tick<'_>) -> Result<Decision, BehaviourError> {
        let tuning = &self.config.tuning.inspection;
        let room_m = self.walking.radius_m();
        let plan = inspection::straight_plan(&tick.pose, tick.goal_m(), room_m, tuning);
        self.walking.next(&Situation {
            plan: Some(&plan),
            ..*tick.situation
        })
    }

    /// Looks at stairs from near by.
    fn inspect(&mut self, tick: &Tick<'_>, inspection: &Inspection) {
        self.ahead.inspected.push(inspection.edge_m);
        self.flight.clear();
        self.head.gazer.start(tick.situation.gaze);
        self.memory.tries.inspections += 1;
        self.look_for_steps(tick);
        self.head.inspect(tick.in_robot(inspection.edge_m));
    }

    /// Before a refusal that stairs could prevent, the robot searches for stairs.
    fn unless_stairs_may_help(&mut self, tick: &Tick<'_>, decision: Decision) -> Decision {
        let refuses = matches!(decision.outcome, Some(Outcome::Refused(_)));
        let stairs_help = tick.goal_is_elsewhere(self.climbing.floor_max)
            || !tick.situation.stairs.stairs.is_empty();
        let has_looked = self.memory.tries.searches + self.memory.tries.inspections > 0;
        if refuses && stairs_help && tick.no_way_reason().is_some() && !has_looked {
            self.head.gazer.start(tick.situation.gaze);
            self.flight.clear();
            self.begin_search(tick);
            return self.decision(tick, Motion::Stand);
        }
        decision
    }
}
