//! Walking as a part of a longer way: begun, broken off and taken up again by another behaviour.

use super::state::State;
use super::{Progress, WalkingBehaviour};
use crate::Situation;

impl WalkingBehaviour {
    /// Takes up walking where another behaviour left the robot: what was waited for before counts no more.
    pub(crate) fn resume(&mut self, situation: &Situation<'_>) {
        self.clock.skip_to(situation.time_ns);
        self.gazer.start(situation.gaze);
        self.progress = Progress::default();
        self.followed.forget();
        self.state = State::Walk;
        self.state_s = 0.0;
        self.idle.reset();
        self.no_plan.reset();
        self.no_way.reset();
        self.looks = 0;
        self.turn_to_rad = None;
        self.watched_m = None;
    }

    /// Whether it stands and looks around.
    pub(crate) fn is_looking_around(&self) -> bool {
        self.state == State::LookAround
    }

    /// Ends a look around early, once a way is sure: what must be known on it has been seen.
    pub(crate) fn end_look(&mut self) {
        if self.is_looking_around() {
            self.looks = self.looks.max(1);
        }
    }
}
