//! The state `approach`: measures the first edge and moves up to it, or back to look again (003, section V.B).

use planning::Step;

use super::footsteps::{Stance, level};
use super::leg::align_pose;
use super::setback::told;
use super::state::Approach;
use super::stepper::Stepped;
use super::{StairClimbing, State};
use crate::{Motion, machine::Tick};

/// Why a robot gives up that looked at an edge often enough.
const NOT_MEASURED: &str = "lost: the edge of the step could not be measured";

impl StairClimbing {
    /// One tick of measuring the first edge, or of moving up to it.
    pub(super) fn approach(&mut self, tick: &Tick<'_>, approach: Approach) -> Motion {
        let Some(first) = self.flight.first().copied() else {
            self.begin_search(tick);
            return Motion::Stand;
        };
        if tick.situation.standing && self.walks_on(tick, &first) {
            return Motion::Stand;
        }
        if approach == Approach::Measure {
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
                self.memory.tries.missteps += 1;
                self.retreat(tick, format!("blocked: {}", told(misstep)));
            }
            Stepped::Idle | Stepped::Done | Stepped::Stuck => self.begin_climb(tick),
        }
        self.stepper.motion()
    }

    /// Goes up to the first edge after a look at it, if it is known well enough.
    fn judge_edge(&mut self, tick: &Tick<'_>, first: &Step) {
        if self.flight.is_lost() {
            self.begin_search(tick);
            return;
        }
        let looked = self.memory.tries.looks >= self.walking.config().tries;
        if !(self.is_measured(first) || looked && self.is_usable(first)) {
            self.memory.tries.looks += 1;
            self.head.look_at(self.crossed_at_m(tick, first));
            if self.memory.tries.looks > self.walking.config().tries {
                self.retreat(tick, NOT_MEASURED.to_owned());
            }
            return;
        }
        self.memory.tries.looks = 0;
        let stance = self.before(tick).start_stance(first);
        if self.drop_off(tick).is_under(&stance.pose) {
            self.begin_search(tick);
            return;
        }
        let holds = level(&tick.pose, &stance, self.feet.stance_m, &self.config);
        self.stepper.start(holds, &tick.pose, tick.ground_m);
        self.machine.go_on(State::Approach(Approach::MoveUp));
    }

    /// Moves back on the level to look again; gives up for this reason when that was done too often.
    pub(super) fn retreat(&mut self, tick: &Tick<'_>, reason: String) {
        self.memory.tries.looks = 0;
        self.memory.tries.searches += 1;
        if self.memory.tries.searches.max(self.memory.tries.missteps) > self.walking.config().tries
        {
            self.refuse(reason);
            return;
        }
        self.enter(State::StepBack { reason });
        let back = self
            .flight
            .first()
            .map(|first| align_pose(first, &self.config, &self.climbing, &self.feet));
        let back = back.filter(|back| !self.drop_off(tick).is_under(back));
        let back = back.unwrap_or(tick.pose);
        let stance = Stance {
            pose: back,
            height_m: tick.ground_m,
            bearing_m: [-0.5 * self.feet.length_m, 0.5 * self.feet.length_m],
        };
        let holds = level(&tick.pose, &stance, self.feet.stance_m, &self.config);
        self.stepper.start(holds, &tick.pose, tick.ground_m);
    }
}
