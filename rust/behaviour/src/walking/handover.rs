//! Walking as a part of a longer way: another behaviour breaks it off, and hands the robot over again.

use super::{Progress, WalkingBehaviour, WayObstaclesTuning, state::State};
use crate::Situation;

impl WalkingBehaviour {
    /// Takes up walking where another behaviour left the robot: what was waited for before counts no more.
    pub(crate) fn resume(&mut self, situation: &Situation<'_>) {
        self.machine.resume(State::Walk, situation.time_ns);
        self.gazer.start(situation.gaze);
        self.progress = Progress::default();
        self.followed.forget();
        self.no_plan.reset();
        self.no_way.reset();
        self.looks = 0;
        self.watched_m = None;
    }

    /// What counts as an obstacle on the way, and as the edge of a stair.
    pub(crate) const fn obstacles(&self) -> &WayObstaclesTuning {
        &self.config.tuning.obstacles
    }

    /// Whether it stands and looks around.
    pub(crate) fn is_looking_around(&self) -> bool {
        matches!(self.machine.state(), State::LookAround(_))
    }

    /// Ends a look around early, once a way is sure: what must be known on it has been seen.
    pub(crate) fn end_look(&mut self) {
        if self.is_looking_around() {
            self.looks = self.looks.max(1);
        }
    }
}
