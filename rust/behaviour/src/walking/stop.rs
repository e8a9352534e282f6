//! The state `stop`: stands and looks at what appeared on the way, and goes on when the way is free.

use super::WalkingBehaviour;
use crate::{Motion, walking::state::State, walking::tick::WayTick};

impl WalkingBehaviour {
    /// One tick of standing.
    pub(super) fn stop(&mut self, tick: &WayTick<'_>) -> Motion {
        let bearing_rad = self
            .watched_m
            .map_or(0.0, |place_m| tick.bearing_rad(place_m));
        self.gaze_at(tick, bearing_rad, self.config.gaze_near);
        if self.standing.s() > 0.0 && self.machine.lasted_s() > self.config.stop_time {
            let met = self.met.take();
            if let Some(to_m) = met.and_then(|felt| self.off_m(tick, &felt)) {
                self.enter(State::StepOff { to_m });
            } else if let Some((_, track)) = &tick.track {
                self.set_off(track);
            } else {
                self.looks = 0;
                self.look(self.around());
            }
        }
        Motion::Stand
    }
}
