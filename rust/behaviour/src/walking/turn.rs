//! The state `turn`: turns on the spot to where the path leads, or to look around from another heading.

use geometry::angle_between;

use super::WalkingBehaviour;
use crate::machine::Tick;
use crate::walking::gaze::Sweep;
use crate::walking::look_around::SURE_S;
use crate::walking::state::State;
use crate::walking::track::turn_speed;
use crate::{Motion, Velocity};

/// A turn ends after this, wherever it points, s.
const LONGEST_TURN_S: f64 = 15.0;
/// A turn with less than this left looks at the ground near by, rad.
const LOOK_NEAR_RAD: f64 = 1.0;
/// Above this a turn keeps its direction, rad.
const KEEP_DIRECTION_RAD: f64 = 2.4;

impl WalkingBehaviour {
    /// One tick of a turn to a heading, rad, or to where the path leads.
    pub(super) fn turn(&mut self, tick: &Tick<'_>, to_rad: Option<f64>) -> Motion {
        let error_rad = if let Some(goal_rad) = to_rad {
            if self.way.s() > SURE_S {
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
            track.bearing_rad()
        };
        let done =
            error_rad.abs() < self.config.turn_until || self.machine.lasted_s() > LONGEST_TURN_S;
        if done && to_rad.is_some() {
            self.look(Sweep::around(&self.config));
            return Motion::Stand;
        }
        if done {
            self.enter(State::Walk);
        }
        // Far while there is much to turn, to see walls; near at its end, to see the ground that is stepped on next.
        let far = error_rad.abs() > LOOK_NEAR_RAD;
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
    fn turn_velocity(&self, error_rad: f64) -> f64 {
        let speed_radps = turn_speed(error_rad, &self.config);
        match &self.motion {
            Motion::Walk(before)
                if error_rad.abs() > KEEP_DIRECTION_RAD
                    && before.x_mps == 0.0
                    && before.yaw_radps != 0.0 =>
            {
                speed_radps.copysign(before.yaw_radps)
            }
            _ => speed_radps,
        }
    }
}
