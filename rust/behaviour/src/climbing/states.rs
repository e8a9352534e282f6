//! The states up to the first step: search, align, approach; and what may end any state.

use geometry::angle_between;

use super::walk::SURE_S;
use super::{Phase, StairClimbing, State};
use crate::climbing::brink::Brink;
use crate::climbing::footsteps::{Stance, level};
use crate::climbing::setback::told;
use crate::climbing::stepper::Stepped;
use crate::machine::Tick;
use crate::{Motion, Velocity};

/// Without a step or a walk for this long the robot gives up, s.
const LONGEST_IDLE_S: f64 = 60.0;
/// Why a robot gives up that looked at an edge often enough.
const NOT_MEASURED: &str = "lost: the edge of the step could not be measured";
/// Aligning ends after this, however well, s.
const LONGEST_ALIGN_S: f64 = 10.0;

impl StairClimbing {
    /// What may end any state of the climb while no foot is on its way.
    pub(super) fn interrupt(&mut self, tick: &Tick<'_>) {
        if self.stepper.is_running() || matches!(self.state, State::Refuse | State::Blind) {
            return;
        }
        if tick.situation.estimate.lost || tick.sees_nothing() {
            self.enter(State::Blind);
        } else if self.idle_s > LONGEST_IDLE_S {
            let reason = tick.no_way_reason().unwrap_or_else(|| {
                format!("lost: no step could be taken for {LONGEST_IDLE_S:.0} s")
            });
            self.refuse(reason);
        }
    }

    /// One tick of a state of the climb.
    pub(super) fn act(&mut self, tick: &Tick<'_>) -> Motion {
        match self.state {
            State::Walk | State::Refuse => Motion::Stand,
            State::Search => self.search(tick),
            State::Align => self.align(tick),
            State::Approach => self.approach(tick),
            State::Climb => self.climb(tick),
            State::StepBack => self.step_back(tick),
            State::Finish => self.finish(tick),
            State::Blind => self.wait_for_sight(tick),
        }
    }

    /// Looks for the step that was lost, else towards the goal.
    pub(super) fn begin_search(&mut self, tick: &Tick<'_>) {
        self.tries.searches += 1;
        self.look_for_steps(tick);
    }

    /// The same where nothing was lost.
    pub(super) fn look_for_steps(&mut self, tick: &Tick<'_>) {
        let goal = tick.situation.goal;
        let place_m = self
            .flight
            .first()
            .map_or([goal.x_m, goal.y_m], |step| step.crossing_m);
        let [x_m, y_m] = tick.in_robot(place_m);
        self.head.search(y_m.atan2(x_m));
        self.enter(State::Search);
    }

    fn search(&mut self, tick: &Tick<'_>) -> Motion {
        let climbs = self.leg(tick).is_some();
        self.count_climb_ahead(climbs, tick.passed_s);
        let found = self.climb_ahead_s > SURE_S;
        let seen = self.look(tick, false);
        if (!found && !seen) || self.had_stumbled {
            return Motion::Stand;
        }
        if self.tries.searches > self.config.tries || (!found && tick.breaks_a_limit()) {
            let reason = tick.no_way_reason().unwrap_or_else(|| {
                "lost: the stairs were seen and could not be found again".to_owned()
            });
            self.refuse(reason);
        } else {
            self.flight.clear();
            self.walking.resume(tick.situation);
            self.enter(State::Walk);
        }
        Motion::Stand
    }

    /// To the place before the first edge from which it is measured, and square to it.
    fn align(&mut self, tick: &Tick<'_>) -> Motion {
        let Some(first) = self.flight.first().copied() else {
            self.begin_search(tick);
            return Motion::Stand;
        };
        self.head
            .turn_to(tick.in_robot(first.crossing_m), tick.passed_s);
        if self.flight.is_lost() {
            self.begin_search(tick);
            return Motion::Stand;
        }
        let goal = super::leg::align_pose(&first, &self.config, &self.climbing, &self.feet);
        let way = tick.pose.relative(&goal);
        let turned_rad = angle_between(tick.pose.yaw_rad, goal.yaw_rad);
        let there = way.x_m.abs() < 0.05 && way.y_m.abs() < 0.03 && turned_rad.abs() < 0.08;
        let velocity = Velocity {
            x_mps: (1.2 * way.x_m).clamp(-0.05, 0.1),
            y_mps: (1.2 * way.y_m).clamp(-0.04, 0.04),
            yaw_radps: (1.5 * turned_rad).clamp(-0.4, 0.4),
        };
        // From before the edge the plan may know better where to cross it than when the robot set off.
        if there && self.tries.lanes == 0 && self.flight.change_lane() {
            self.tries.lanes += 1;
            self.state_s = 0.0;
        } else if there
            || self.state_s > LONGEST_ALIGN_S
            || self.brink(tick).is_neared(&tick.pose, &velocity)
        {
            self.enter(State::Approach);
            self.head.look_at(self.crossed_at_m(tick, &first));
            return Motion::Stand;
        }
        Motion::Walk(velocity)
    }

    /// The floor that the robot stands on, as the map has it end.
    fn brink<'a>(&'a self, tick: &Tick<'a>) -> Brink<'a> {
        Brink {
            view: tick.situation.view,
            feet: &self.feet,
            level_m: tick.ground_m,
        }
    }

    /// Measures the first edge, then moves up to it.
    fn approach(&mut self, tick: &Tick<'_>) -> Motion {
        let Some(first) = self.flight.first().copied() else {
            self.begin_search(tick);
            return Motion::Stand;
        };
        if self.phase == Phase::Look {
            if self.look(tick, self.is_well_measured(&first)) {
                self.judge_edge(tick, &first);
            }
            return self.stepper.motion();
        }
        self.head
            .turn_to(self.crossed_at_m(tick, &first), tick.passed_s);
        match self.stepper.advance(tick.situation, tick.passed_s) {
            Stepped::Running => {}
            Stepped::Missed(misstep, _) => {
                self.tries.missteps += 1;
                self.retreat(tick, format!("blocked: {}", told(misstep)));
            }
            Stepped::Idle | Stepped::Done | Stepped::Stuck => self.begin_climb(tick),
        }
        self.stepper.motion()
    }

    /// One tick of a look, standing; true at its end, which comes soon where enough is known.
    pub(super) fn look(&mut self, tick: &Tick<'_>, known: bool) -> bool {
        if !tick.situation.standing {
            return false;
        }
        let frames = tick.situation.frames_used;
        self.head.advance(frames, tick.passed_s) || (known && self.head.has_glanced(frames))
    }

    /// After a look at the first edge: go up to it if it is known well enough.
    fn judge_edge(&mut self, tick: &Tick<'_>, first: &planning::Step) {
        if self.flight.is_lost() {
            self.begin_search(tick);
            return;
        }
        let looked = self.tries.looks >= self.config.tries;
        if !(self.is_measured(first) || looked && self.is_usable(first)) {
            self.tries.looks += 1;
            self.head.look_at(self.crossed_at_m(tick, first));
            if self.tries.looks > self.config.tries {
                self.retreat(tick, NOT_MEASURED.to_owned());
            }
            return;
        }
        self.tries.looks = 0;
        let stance = self.before(tick).start_stance(first);
        if self.brink(tick).is_under(&stance.pose) {
            self.begin_search(tick);
            return;
        }
        let holds = level(&tick.pose, &stance, self.feet.stance_m, &self.config);
        self.stepper.start(holds, &tick.pose, tick.ground_m);
        self.phase(Phase::Step);
    }

    /// Whether the front edge of a step is known well enough to step by it.
    pub(super) fn is_measured(&self, step: &planning::Step) -> bool {
        step.stair.front_fit.is_some_and(|fit| {
            fit.frames >= self.config.edge_frames
                && fit.place_sigma_m <= self.config.edge_sigma
                && fit.heading_sigma_rad <= self.config.heading_sigma
        })
    }

    /// Whether it will do when no look tells more: sure enough, if only by few frames.
    pub(super) fn is_usable(&self, step: &planning::Step) -> bool {
        const SIGMA: f64 = 1.2;
        step.stair.front_fit.is_some_and(|fit| {
            fit.place_sigma_m <= SIGMA * self.config.edge_sigma
                && fit.heading_sigma_rad <= SIGMA * self.config.heading_sigma
        })
    }

    /// Whether it is known so well that another look would tell little.
    pub(super) fn is_well_measured(&self, step: &planning::Step) -> bool {
        const FRAMES: u32 = 2;
        const SIGMA: f64 = 0.5;
        step.stair.front_fit.is_some_and(|fit| {
            fit.frames >= FRAMES * self.config.edge_frames
                && fit.place_sigma_m <= SIGMA * self.config.edge_sigma
                && fit.heading_sigma_rad <= SIGMA * self.config.heading_sigma
        })
    }

    /// Back on the level to look again; gives up for this reason when that was done too often.
    pub(super) fn retreat(&mut self, tick: &Tick<'_>, reason: String) {
        self.tries.looks = 0;
        self.tries.searches += 1;
        if self.tries.searches.max(self.tries.missteps) > self.config.tries {
            self.refuse(reason);
            return;
        }
        self.enter(State::StepBack);
        self.refusal = reason;
        let back = self
            .flight
            .first()
            .map(|first| super::leg::align_pose(first, &self.config, &self.climbing, &self.feet));
        let back = back.filter(|back| !self.brink(tick).is_under(back));
        let back = back.unwrap_or(tick.pose);
        let stance = Stance {
            pose: back,
            height_m: tick.ground_m,
            bearing_m: [-0.5 * self.feet.length_m, 0.5 * self.feet.length_m],
        };
        let holds = level(&tick.pose, &stance, self.feet.stance_m, &self.config);
        self.stepper.start(holds, &tick.pose, tick.ground_m);
        self.phase(Phase::Step);
    }
}
