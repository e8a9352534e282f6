//! The states `look` and `search`: the robot stands, looks at where its steps may go, and plans them.

use geometry::PlanarPose;
use planning::footsteps::{FootstepPlan, NoFootsteps, PlannedFootstep};

use super::progress::{CostToGo, Since};
use super::route::LastSteps;
use super::{Footsteps, State};
use crate::Motion;
use crate::machine::Tick;

impl Footsteps {
    /// Begins to look at a place of the map, m; where none is said, towards the goal and near.
    pub(super) fn begin_look(&mut self, tick: &Tick<'_>, place_m: Option<[f64; 2]>) {
        let ahead_m = self.config.stop_before;
        self.looked_at_m = place_m;
        let place_m = place_m.map_or_else(
            || {
                let way = tick.situation.plan.and_then(|plan| plan.way.as_ref().ok());
                let climb = way.and_then(|path| path.climbs.first()?.steps.first());
                let to_m = climb.map_or(tick.goal_m(), |step| step.crossing_m);
                let bearing_rad = tick.bearing_rad(to_m);
                let (sin, cos) = libm::sincos(bearing_rad);
                [ahead_m * cos, ahead_m * sin]
            },
            |place_m| tick.in_robot(place_m),
        );
        self.head.look_at(place_m);
        self.enter(State::Look);
    }

    /// One tick of a look; at its end steps are planned.
    pub(super) fn look(&mut self, tick: &Tick<'_>) -> Motion {
        if self.has_looked(tick) {
            self.plan_steps(tick);
        }
        Motion::Stand
    }

    /// One tick of the search; at its end steps are planned.
    pub(super) fn search(&mut self, tick: &Tick<'_>) -> Motion {
        if self.has_looked(tick) {
            self.plan_steps(tick);
        }
        Motion::Stand
    }

    fn has_looked(&mut self, tick: &Tick<'_>) -> bool {
        let frames = tick.situation.frames_used;
        tick.situation.standing && self.head.advance(frames, tick.passed_s)
    }

    /// Plans steps, and takes them, looks again, walks on or gives up.
    fn plan_steps(&mut self, tick: &Tick<'_>) {
        let feet = Self::soles(tick);
        self.feel(tick);
        self.read_ground(tick, &self.standing(tick));
        let planned = self.planned_on(tick);
        let mut found = self.plan_next(tick, feet, None, &planned);
        if self.was_looked_at_in_vain(tick, &found) {
            self.read_ground(tick, &self.standing(tick));
            found = self.plan_from(tick, feet, None, &planned);
        }
        match found {
            Ok(plan) if !plan.steps.is_empty() && self.gets_on(Since::Look, &plan) => {
                self.take(tick, &plan);
            }
            Ok(FootstepPlan {
                exit_m: None,
                steps,
                ..
            }) if steps.is_empty() => self.arrive(tick),
            Ok(plan) => self.look_in_vain(tick, plan.exit_m, || {
                "blocked: what lies ahead could not be seen".to_owned()
            }),
            // No look shows more of the ground between the feet.
            Err(NoFootsteps::NoSteps(_))
                if self.looks > 0 && !self.stands_to_walk(tick) && self.step_back(tick) => {}
            Err(none) => self.look_in_vain(tick, None, || word(&none)),
        }
    }

    /// Whether a plan ends where the robot has looked often enough from near by: no plan ends there again.
    fn was_looked_at_in_vain(
        &mut self,
        tick: &Tick<'_>,
        found: &Result<FootstepPlan, NoFootsteps>,
    ) -> bool {
        let exit_m = found.as_ref().ok().and_then(|plan| plan.exit_m);
        let (Some(looked_at_m), Some(exit_m)) = (self.looked_at_m.take(), exit_m) else {
            return false;
        };
        let near_m = self.layer.limits().sole.length_m;
        let here_m = [tick.pose.x_m, tick.pose.y_m];
        let same = geometry::distance_m(looked_at_m, exit_m) < near_m;
        let near = geometry::distance_m(here_m, exit_m) < self.config.look_from + near_m;
        same && near && self.failed.look_at(exit_m, near_m, self.config.looks)
    }

    /// The steps on from here that were planned before the robot stood.
    fn planned_on(&self, tick: &Tick<'_>) -> Vec<PlannedFootstep> {
        let taken = self.stepper.holds.len();
        let next = self.last.from(taken, &PlanarPose::default());
        let standing = next.first().map(|step| step.side.other());
        standing.map_or_else(Vec::new, |standing| {
            self.last
                .from(taken, &self.told_from_map(tick, standing, taken))
        })
    }

    /// Begins to take a plan's steps.
    fn take(&mut self, tick: &Tick<'_>, plan: &FootstepPlan) {
        let feet = Self::soles(tick);
        let heights_m = [0, 1].map(|foot: usize| {
            self.height_under_m(&feet[foot])
                .unwrap_or(Self::sole_heights_m(tick)[foot])
        });
        let ground_m = heights_m[0].min(heights_m[1]);
        let holds = plan
            .steps
            .iter()
            .take(self.config.run)
            .map(|step| self.told(step));
        self.stepper.start(holds.collect(), &tick.pose, ground_m);
        self.planned_at = 0;
        self.last = LastSteps {
            steps: plan.steps.clone(),
            ..LastSteps::default()
        };
        self.to_go[Since::Step as usize] = CostToGo::default();
        self.enter(State::Step);
    }

    /// Whether a plan tells that the robot gets on: else it has been idle.
    pub(super) fn gets_on(&mut self, since: Since, plan: &FootstepPlan) -> bool {
        let (by_s, most) = (self.layer.limits().walked_s, self.config.longer);
        let gets_on = self.to_go[since as usize].gets_on(plan.whole_s, by_s, most);
        if gets_on {
            self.looks = 0;
            self.machine.gets_on();
        }
        gets_on
    }

    /// After a look without a step: once more, around, and at last never more.
    fn look_in_vain(
        &mut self,
        tick: &Tick<'_>,
        at_m: Option<[f64; 2]>,
        reason: impl FnOnce() -> String,
    ) {
        self.looks += 1;
        let reason = tick.no_way_reason().unwrap_or_else(reason);
        let unseen_m = at_m.filter(|_| self.failed.unseen() < self.config.longer as usize);
        if tick.goal_away_m() <= tick.situation.goal.radius_m && self.is_on_the_goals_level(tick) {
            // As deep in the goal as the way leads.
            self.enter(State::Arrive);
        } else if self.looks > self.config.tries {
            self.give_up(tick, reason);
        } else if let Some(unseen_m) = unseen_m.filter(|_| self.looks == self.config.tries) {
            // What cannot be seen from here leads nowhere; there may be other ways.
            self.failed.note_unseen(unseen_m);
            self.looks = 0;
            self.plan_steps(tick);
        } else if self.looks > 1 {
            let at_m = at_m.unwrap_or(tick.goal_m());
            self.head.search(tick.bearing_rad(at_m));
            self.enter(State::Search);
            self.machine.go_on(State::Search);
        } else {
            self.begin_look(tick, at_m);
            self.machine.go_on(State::Look);
        }
    }

    /// Gives stepping up here: where the feet stand side by side on one level, the robot walks on if there is a way.
    fn give_up(&mut self, tick: &Tick<'_>, reason: String) {
        self.given_up = (self.given_up.0 + 1, Some(tick.pose));
        if self.given_up.0 >= self.config.tries || !self.stands_to_walk(tick) {
            self.refuse(reason);
        } else {
            self.begin_walk(tick);
        }
    }

    /// Whether the robot is on the goal's level: both that height and its own may be off by what told heights may.
    fn is_on_the_goals_level(&self, tick: &Tick<'_>) -> bool {
        tick.goal_off_level_m()
            .is_none_or(|off_m| off_m <= 2.0 * self.told_m)
    }

    /// The robot is at the goal, if that is on its level.
    fn arrive(&mut self, tick: &Tick<'_>) {
        if self.is_on_the_goals_level(tick) {
            self.enter(State::Arrive);
        } else {
            self.refuse("no_path: the goal lies above or below this place".to_owned());
        }
    }
}

/// The refusal where there are no steps.
fn word(none: &NoFootsteps) -> String {
    format!("no_path: {none}")
}
