//! The state `turn`: turns on the spot to where the path leads, or to look around from another heading.

use geometry::angle_between;

use super::{WalkingBehaviour, WalkingConfig};
use crate::walking::state::State;
use crate::walking::tick::WayTick;
use crate::{Motion, Velocity};

impl WalkingBehaviour {
    /// One tick of a turn to a heading, rad, or to where the path leads.
    pub(super) fn turn(&mut self, tick: &WayTick<'_>, to_rad: Option<f64>) -> Motion {
        let error_rad = if let Some(goal_rad) = to_rad {
            if self.has_a_sure_way() {
                self.enter(State::Stop);
                return Motion::Stand;
            }
            angle_between(tick.pose.yaw_rad, goal_rad)
        } else {
            let Some((_, track)) = &tick.track else {
                return self.without_way(tick);
            };
            if let Some(motion) = self.check_way(tick) {
                return motion;
            }
            track.bearing_rad(&self.config.tuning.track)
        };
        let tuning = &self.config.tuning.turn;
        let done =
            error_rad.abs() < self.config.turn_until || self.machine.lasted_s() > tuning.longest;
        // Far while there is much to turn, to see walls; near at its end, to see the ground that is stepped on next.
        let far = error_rad.abs() > tuning.look_near;
        if done && to_rad.is_some() {
            self.look(self.around());
            return Motion::Stand;
        }
        if done {
            self.enter(State::Walk);
        }
        let down_rad = if far {
            self.config.gaze_far
        } else {
            self.config.gaze_near
        };
        self.gaze_at(tick, error_rad, down_rad);
        Motion::Walk(Velocity {
            yaw_radps: self.turn_velocity(error_rad),
            ..Velocity::default()
        })
    }

    /// A turn that is nearly half a circle does not change its mind about the side.
    pub(super) fn turn_velocity(&self, error_rad: f64) -> f64 {
        let speed_radps = turn_speed(error_rad, &self.config);
        match &self.motion {
            Motion::Walk(before)
                if error_rad.abs() > self.config.tuning.turn.keeps_side
                    && before.x_mps == 0.0
                    && before.yaw_radps != 0.0 =>
            {
                speed_radps.copysign(before.yaw_radps)
            }
            _ => speed_radps,
        }
    }
}

/// Speed of a turn on the spot by `error_rad`, rad/s: slower at its end, never so slow that it ends before.
pub(super) fn turn_speed(error_rad: f64, config: &WalkingConfig) -> f64 {
    let tuning = &config.tuning.turn;
    let least_radps = tuning.slowest.min(config.turn_speed);
    let speed_radps = (tuning.gain * error_rad.abs()).clamp(least_radps, config.turn_speed);
    speed_radps.copysign(error_rad)
}
