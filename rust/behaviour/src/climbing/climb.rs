//! The state `climb`: look, check the conditions, step; wait, correct, take back, give up (003, section V.C).

use planning::Step;

use super::{Pace, StairClimbing, State, memory::Tries, state::Climb};
use crate::Motion;
use crate::climbing::flight::covers;
use crate::climbing::footsteps::{Stance, alternating, leading_side, level};
use crate::climbing::placement::{Verdict, reason};
use crate::climbing::stepper::Stepped;
use crate::machine::Tick;

impl StairClimbing {
    /// Begins to climb: the first step is within reach.
    pub(super) fn begin_climb(&mut self, tick: &Tick<'_>) {
        self.enter(State::Climb(Climb::Look));
        self.begin_look(tick);
    }

    /// Looks at what comes after the next step.
    pub(super) fn begin_look(&mut self, tick: &Tick<'_>) {
        let tuning = &self.config.tuning.head;
        let (ahead_m, nearest_m) = (tuning.look_ahead, tuning.look_nearest);
        let step = self.edge_to_watch().or(self.flight.first());
        let place_m = step.map_or([ahead_m, 0.0], |step| self.crossed_at_m(tick, step));
        self.head.look_at([place_m[0].max(nearest_m), place_m[1]]);
        self.machine.go_on(State::Climb(Climb::Look));
    }

    /// The first of the wanted edges behind the next one that is not well measured.
    fn edge_to_measure(&self) -> Option<&Step> {
        let wanted = self.config.edges_ahead as usize;
        let mut behind = self.flight.steps.iter().skip(1).take(wanted);
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
        match self.machine.state_mut() {
            State::Climb(Climb::Look) => {
                let tries = &self.memory.tries;
                let known = tries.missteps == 0 && tries.looks == 0 && self.knows_enough(tick);
                if self.look(tick, known) {
                    self.decide(tick);
                }
            }
            State::Climb(Climb::Wait { waited_s }) => {
                *waited_s += tick.passed_s;
                if self.look(tick, false) {
                    self.decide(tick);
                }
            }
            _ => self.take_steps(tick),
        }
        self.stepper.motion()
    }

    /// One tick while the feet move.
    fn take_steps(&mut self, tick: &Tick<'_>) {
        let watched = self.edge_to_watch();
        let ahead_m = self.config.tuning.head.step_ahead;
        let place_m = watched.map_or([ahead_m, 0.0], |step| self.crossed_at_m(tick, step));
        self.head.turn_to(place_m, tick.passed_s);
        if tick.new_frame {
            self.go_on_without_a_stop(tick);
        }
        let stepped = self.stepper.advance(tick.situation, tick.passed_s);
        self.after_steps(tick, stepped);
    }

    /// Whether a glance will do: what is behind the next step was well measured, or the way leads on without a step.
    fn knows_enough(&self, tick: &Tick<'_>) -> bool {
        match (self.flight.first(), self.flight.second()) {
            (None, _) => tick.has_level_way(),
            (Some(_), None) => false,
            (Some(_), Some(_)) => self.edge_to_measure().is_none(),
        }
    }

    /// Decides after a look what to do about the next step.
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
                if self.memory.tries.missteps > 0 && !self.is_seen_now(tick, &first) {
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
                self.memory.tries.moves += 1;
                if self.memory.tries.moves > self.walking.config().tries {
                    self.refuse(
                        "lost: the robot could not get in place for the next step".to_owned(),
                    );
                    return;
                }
                let holds = level(&tick.pose, &stance, self.feet.stance_m, &self.config);
                self.stepper.start(holds, &tick.pose, tick.ground_m);
                self.move_feet(Vec::new());
            }
            Verdict::Look(depth_m) => self.look_again(tick, || {
                format!(
                    "blocked: only {:.0} mm of the next step were seen",
                    1e3 * depth_m
                )
            }),
            Verdict::Refuse(unfit) => {
                let reason = reason(&self.climbing, &unfit);
                self.look_again(tick, || reason);
            }
        }
    }

    /// Looks once more; when that was done too often, the climb ends where there is room to walk on or nowhere left to go, and else
    /// the robot gives up for this reason.
    pub(super) fn look_again(&mut self, tick: &Tick<'_>, reason: impl FnOnce() -> String) {
        self.memory.tries.looks += 1;
        if self.memory.tries.looks > self.walking.config().tries {
            if self.memory.on.is_some() && (self.has_room(tick) || self.is_in_the_goal(tick)) {
                self.enter(State::FINISH);
                return;
            }
            self.refuse(reason());
        } else {
            self.begin_look(tick);
        }
    }

    /// Waits for what stands on the next step to go away.
    fn wait(&mut self, tick: &Tick<'_>) {
        let waited_s = match self.machine.state() {
            State::Climb(Climb::Wait { waited_s }) => *waited_s,
            _ => 0.0,
        };
        if waited_s > self.config.wait {
            self.refuse(format!(
                "blocked: something has stood on the next step for {:.0} s",
                self.config.wait
            ));
        } else {
            self.begin_look(tick);
            self.machine.go_on(State::Climb(Climb::Wait { waited_s }));
        }
    }

    /// Moves the feet, to these stances where they are steps.
    pub(super) fn move_feet(&mut self, run: Vec<Stance>) {
        self.machine.go_on(State::Climb(Climb::Step { run }));
    }

    fn step(&mut self, tick: &Tick<'_>, stance: &Stance) {
        let first = leading_side(&tick.pose, &stance.pose, &self.config.tuning.footsteps);
        let mut run = vec![*stance];
        if self.pace == Pace::Continuous && !self.memory.pauses {
            let _ = self.lengthen_run(tick, &mut run);
        }
        let holds = if run.len() > 1 {
            alternating(first, &run, self.feet.stance_m)
        } else {
            stance.both(first, self.feet.stance_m).to_vec()
        };
        let half_m = 0.5 * self.feet.length_m;
        self.memory.came_from = Some(Stance {
            pose: tick.pose,
            height_m: tick.ground_m,
            bearing_m: [-half_m, half_m],
        });
        self.stepper.start(holds, &tick.pose, tick.ground_m);
        self.move_feet(run);
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
            self.memory.on = self.flight.taken();
            self.machine.gets_on();
            self.memory.tries = Tries::default();
        }
    }

    /// Whether a step is in the present view.
    fn is_seen_now(&self, tick: &Tick<'_>, step: &Step) -> bool {
        let lookup = self.flight.lookup();
        let stairs = &tick.situation.stairs.stairs;
        stairs
            .iter()
            .any(|stair| covers(stair, step, lookup) && stair.steps_ago == 0)
    }
}
