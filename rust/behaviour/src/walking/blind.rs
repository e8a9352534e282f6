//! The state `blind`: stands until something is seen again.

use super::WalkingBehaviour;
use crate::{Motion, machine::SightAgain, walking::gaze::Sweep, walking::tick::WayTick};

impl WalkingBehaviour {
    /// One tick without sight.
    pub(super) fn wait_for_sight(&mut self, tick: &WayTick<'_>) -> Motion {
        // What it stands on may be out of view: it looks there, too.
        let phase = (self.machine.lasted_s() / self.config.tuning.gaze.period).fract();
        let down_rad = if phase < self.config.tuning.gaze.far_share {
            self.config.gaze_feet
        } else {
            self.config.gaze_near
        };
        self.gaze_at(tick, 0.0, down_rad);
        match self.machine.sight(tick) {
            SightAgain::Back => self.look(Sweep::around(&self.config)),
            SightAgain::Away => {}
            SightAgain::Hopeless(reason) => self.refuse(reason),
        }
        Motion::Stand
    }
}
