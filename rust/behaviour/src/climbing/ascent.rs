//! The climb: look, check the conditions, step; wait, correct, take back, give up (003, section V.C).

use planning::Step;

use super::{Pace, Phase, StairClimbing, State};
use crate::Motion;
use crate::climbing::flight::{covers, nearest};
use crate::climbing::footsteps::{Stance, alternating, leading_side, level};
use crate::climbing::placement::{Behind, Verdict, reason};
use crate::climbing::stepper::Stepped;
use crate::machine::Tick;

impl StairClimbing {
    /// The first step is within reach of a step.
    pub(super) fn begin_climb(&mut self, tick: &Tick<'_>) {
        self.enter(State::Climb);
        self.begin_look(tick);
    }

    /// Looks at what comes after the next step.
    pub(super) fn begin_look(&mut self, tick: &Tick<'_>) {
        const AHEAD_M: f64 = 0.2;
        let step = self.edge_to_watch().or(self.flight.first());
        let place_m = step.map_or([AHEAD_M, 0.0], |step| self.crossed_at_m(tick, step));
        self.head.look_at([place_m[0].max(0.15), place_m[1]]);
        self.phase(Phase::Look);
    }

    /// Of the edges behind the next one that are wanted the first that is not well measured.
    fn edge_to_measure(&self) -> Option<&Step> {
        let wanted = self.config.edges_ahead as usize;
        let mut behind = self.flight.steps().iter().skip(1).take(wanted);
        behind.find(|step| !self.is_well_measured(step))
    }

    /// The edge behind the next one that most is to be learnt of.
    fn edge_to_watch(&self) -> Option<&Step> {
        self.edge_to_measure().or(self.flight.second())
    }

    /// Where the robot will cross a step's front edge, in its frame, m.
    pub(super) fn crossed_at_m(&self, tick: &Tick<'_>, step: &Step) -> [f64; 2] {
        tick.in_robot(self.before(tick).crossed_at_m(step))
    }

    /// One tick.
    pub(super) fn climb(&mut self, tick: &Tick<'_>) -> Motion {
        match self.phase {
            Phase::Look | Phase::Wait => {
                let known = self.phase == Phase::Look
                    && self.tries.missteps == 0
                    && self.tries.looks == 0
                    && self.knows_enough(tick);
                if self.look(tick, known) {
                    self.decide(tick);
                }
            }
            Phase::Step => {
                let watched = self.edge_to_watch();
                let place_m = watched.map_or([0.3, 0.0], |step| self.crossed_at_m(tick, step));
                self.head.turn_to(place_m, tick.passed_s);
                if tick.new_frame {
                    self.go_on_without_a_stop(tick);
                }
                let stepped = self.stepper.advance(tick.situation, tick.passed_s);
                self.after_steps(tick, stepped);
            }
        }
        self.stepper.motion()
    }

    /// Whether a glance will do: what is behind the next step was well measured, or the way leads on without a step.
    fn knows_enough(&self, tick: &Tick<'_>) -> bool {
        match (self.flight.first(), self.flight.second()) {
            (None, _) => tick.has_level_way(),
            (Some(_), None) => false,
            (Some(_), Some(_)) => self.edge_to_measure().is_none(),
        }
    }

    /// After a look: what to do about the next step.
    fn decide(&mut self, tick: &Tick<'_>) {
        let Some(first) = self.next_step(tick) else {
            self.end_climb(tick);
            return;
        };
        if !self.is_usable(&first) {
            self.look_again(tick, || {
                "lost: the edge of the next step could not be measured".to_owned()
            });
            return;
        }
        let verdict = self.before(tick).check(&first, &self.behind(tick, &first));
        match verdict {
            Verdict::Go(stance) => {
                if self.tries.missteps > 0 && !is_seen_now(tick, &first) {
                    self.look_again(tick, || {
                        "blocked: the next step is not where it was seen".to_owned()
                    });
                } else if self.is_occupied(tick, &stance) {
                    self.wait(tick);
                } else {
                    self.step(tick, &stance);
                }
            }
            Verdict::Move(stance) if !self.stays_on(tick, &stance, &first) => {
                // What is in mind cannot be. By the time it has looked the plan may know better.
                self.flight.clear();
                self.look_again(tick, || {
                    "lost: the edge of the next step is not where it can be".to_owned()
                });
            }
            Verdict::Move(stance) => {
                self.tries.moves += 1;
                if self.tries.moves > self.config.tries {
                    self.refuse(
                        "lost: the robot could not get in place for the next step".to_owned(),
                    );
                    return;
                }
                let holds = level(&tick.pose, &stance, self.feet.stance_m, &self.config);
                self.run.clear();
                self.stepper.start(holds, &tick.pose, tick.ground_m);
                self.phase(Phase::Step);
            }
            Verdict::Look(depth_m) => self.look_again(tick, || {
                format!(
                    "blocked: only {:.0} mm of the next step were seen",
                    1e3 * depth_m
                )
            }),
            Verdict::Refuse(unfit) => self.look_again(tick, || reason(&unfit)),
        }
    }

    /// The step to take now: the memorised one, else what is seen ahead. None where the climb has led to the goal, or to a place
    /// from which the way goes on level, whatever stairs there are beyond it.
    fn next_step(&mut self, tick: &Tick<'_>) -> Option<Step> {
        if self.on.is_some() && tick.has_level_way() && self.has_room(tick) {
            self.flight.clear();
            return None;
        }
        if self.is_in_doubt() || self.flight.first().is_none() {
            if let Some(steps) = self.planned_ahead(tick) {
                self.flight.adopt(steps);
            } else if tick.situation.plan.is_none() && self.flight.first().is_none() {
                let reach_m = self.reach_m();
                let (stairs, ground_m) = (tick.situation.stairs, tick.ground_m);
                let step = nearest(stairs, &tick.pose, ground_m, reach_m, &self.climbing);
                self.flight.adopt(step.as_slice());
            }
        }
        let mut first = self.flight.first().copied()?;
        if self.on.is_some() && tick.leaves_the_goal_by(&first) {
            self.flight.clear();
            return None;
        }
        if self.on.is_some() {
            // A tread may be narrow and the edge behind it wide: wherever a plan crosses that, there is no walking to the side.
            let at = [tick.pose.x_m, tick.pose.y_m];
            first.crossing_m = first.stair.front.straight_on_m(at);
        }
        Some(first)
    }

    /// Whether the memorised step may have been a glance of something beside the way: no foot has tried it, and by now it is not
    /// seen, or not planned and its edge never was measured.
    pub(super) fn is_in_doubt(&self) -> bool {
        let unseen = self.flight.is_out_of_sight();
        let measured = self
            .flight
            .first()
            .is_some_and(|first| self.is_usable(first));
        self.tries.missteps == 0 && self.flight.is_lost() && (unseen || !measured)
    }

    /// The steps within reach that the plan leads over.
    fn planned_ahead<'a>(&self, tick: &Tick<'a>) -> Option<&'a [Step]> {
        let at = [tick.pose.x_m, tick.pose.y_m];
        let beyond_m = |step: &Step| step.stair.front.beyond_m(at);
        let path = tick.situation.plan?.way.as_ref().ok()?;
        let steps = path.climbs.iter().find_map(|climb| {
            // The plan may not have noticed yet that a step was taken.
            let ahead = climb.steps.iter().position(|step| beyond_m(step) <= 0.0)?;
            Some(&climb.steps[ahead..])
        })?;
        (beyond_m(&steps[0]) > -2.0 * self.reach_m()).then_some(steps)
    }

    /// How far ahead of the robot's middle the edge of a step may be that is taken next, m.
    fn reach_m(&self) -> f64 {
        0.5 * self.feet.length_m + 0.06
    }

    /// What is behind the next step, as far as it was measured.
    fn behind(&self, tick: &Tick<'_>, first: &Step) -> Behind<'_> {
        match self.flight.second() {
            Some(second) if self.is_measured(second) || self.tries.looks >= self.config.tries => {
                Behind::Step(second)
            }
            Some(second) => Behind::Unseen(super::placement::depth_m(first, second)),
            None => self.before(tick).without_next(first),
        }
    }

    /// Looks once more; when that was done too often, the climb ends where there is room to walk on or nowhere left to go, and else
    /// the robot gives up for this reason.
    pub(super) fn look_again(&mut self, tick: &Tick<'_>, reason: impl FnOnce() -> String) {
        self.tries.looks += 1;
        if self.tries.looks > self.config.tries {
            if self.on.is_some() && (self.has_room(tick) || tick.is_in_the_goal()) {
                self.enter(State::Finish);
                return;
            }
            self.refuse(reason());
        } else {
            self.begin_look(tick);
        }
    }

    /// Waits for what stands on the next step to go away.
    fn wait(&mut self, tick: &Tick<'_>) {
        if self.phase != Phase::Wait {
            self.begin_look(tick);
            self.phase(Phase::Wait);
        } else if self.phase_s > self.config.wait {
            self.refuse(format!(
                "blocked: something has stood on the next step for {:.0} s",
                self.config.wait
            ));
        } else {
            let waited_s = self.phase_s;
            self.begin_look(tick);
            self.phase = Phase::Wait;
            self.phase_s = waited_s;
        }
    }

    fn step(&mut self, tick: &Tick<'_>, stance: &Stance) {
        let first = leading_side(&tick.pose, &stance.pose);
        self.run.clear();
        self.run.push(*stance);
        if self.pace == Pace::Continuous && !self.pauses {
            let _ = self.lengthen_run(tick);
        }
        let holds = if self.run.len() > 1 {
            alternating(first, &self.run, self.feet.stance_m)
        } else {
            stance.both(first, self.feet.stance_m).to_vec()
        };
        let half_m = 0.5 * self.feet.length_m;
        self.came_from = Some(Stance {
            pose: tick.pose,
            height_m: tick.ground_m,
            bearing_m: [-half_m, half_m],
        });
        self.stepper.start(holds, &tick.pose, tick.ground_m);
        self.phase(Phase::Step);
    }

    fn after_steps(&mut self, tick: &Tick<'_>, stepped: Stepped) {
        match stepped {
            Stepped::Running => {}
            Stepped::Missed(misstep, landed) => self.after_misstep(tick, misstep, landed),
            Stepped::Idle | Stepped::Done | Stepped::Stuck => {
                self.count_steps(tick);
                self.begin_look(tick);
            }
        }
    }

    /// The steps whose front edge lies behind the robot have been taken.
    fn count_steps(&mut self, tick: &Tick<'_>) {
        let at = [tick.pose.x_m, tick.pose.y_m];
        while self
            .flight
            .first()
            .is_some_and(|step| step.stair.front.beyond_m(at) > 0.0)
        {
            self.on = self.flight.taken();
            self.idle_s = 0.0;
            self.tries = super::Tries::default();
        }
    }
}

/// Whether a step is in the present view.
fn is_seen_now(tick: &Tick<'_>, step: &Step) -> bool {
    tick.situation
        .stairs
        .stairs
        .iter()
        .any(|stair| covers(stair, step) && stair.steps_ago == 0)
}
