//! The state `blind`: stands until something is seen again.

use super::WalkingBehaviour;
use crate::{Motion, machine::SightAgain, walking::tick::WayTick};

impl WalkingBehaviour {
    /// One tick without sight.
    pub(super) fn wait_for_sight(&mut self, tick: &WayTick<'_>) -> Motion {
        self.gaze_at(tick, 0.0, self.config.gaze_near);
        match self.machine.sight(tick) {
            SightAgain::Back => self.look(self.around()),
            SightAgain::Away => {}
            SightAgain::Hopeless(reason) => self.refuse(reason),
        }
        Motion::Stand
    }
}
