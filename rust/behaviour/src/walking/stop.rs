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
            if let Some((_, track)) = &tick.track {
                self.set_off(track);
            } else {
                self.looks = 0;
                self.look(self.around());
            }
        }
        Motion::Stand
    }

    /// Stands and looks, or gives up: the feet came upon a step that nobody saw.
    pub(super) fn stumble(&mut self) {
        self.stumbles += 1;
        if self.stumbles > self.config.tries {
            self.refuse("blocked: the feet come upon a step that cannot be seen".to_owned());
        } else {
            self.watched_m = None;
            self.enter(State::Stop);
        }
    }
}
