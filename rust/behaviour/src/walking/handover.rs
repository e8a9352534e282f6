//! Walking as a part of a longer way: another behaviour breaks it off, and hands the robot over again.

use super::{Progress, WalkingBehaviour, WalkingConfig, state::State};
use crate::Situation;

impl WalkingBehaviour {
    /// Takes up walking where another behaviour left the robot: what was waited for before counts no more.
    pub(crate) fn resume(&mut self, situation: &Situation<'_>) {
        self.machine.resume(State::Walk, situation.time_ns);
        self.gazer.start(situation.gaze);
        self.progress = Progress::default();
        self.followed.forget();
        self.came_by.forget();
        self.no_plan.reset();
        self.no_way.reset();
        self.looks = 0;
        self.watched_m = None;
    }

    /// By what it walks, and by what whoever breaks it off does the same.
    pub(crate) const fn config(&self) -> &WalkingConfig {
        &self.config
    }

    /// Radius of the upright cylinder that holds the robot, m.
    pub(crate) const fn radius_m(&self) -> f64 {
        self.radius_m
    }

    /// How long the planner has found no way, s.
    pub(crate) const fn no_way_s(&self) -> f64 {
        self.no_way.s()
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
