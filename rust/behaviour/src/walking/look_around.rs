//! The state `look_around`: the head sweeps over the ground around, or over a place on the path, until there is a way.

use geometry::wrap_angle;

use super::WalkingBehaviour;
use crate::machine::Tick;
use crate::walking::gaze::Sweep;
use crate::walking::state::State;
use crate::{Gaze, Motion};

/// A way must hold this long to end a look around, or a turn to the next one, before its end, s.
pub(super) const SURE_S: f64 = 0.5;
/// Looks in that many directions see all around: each sweep covers 3 rad with the camera's width, and the head looks on while the
/// robot turns.
const LOOKS: u32 = 2;
/// The directions of the looks are this far apart, rad.
const LOOK_APART_RAD: f64 = 3.1;
/// A look around ends after this, whatever the frames do, s.
const LONGEST_LOOK_S: f64 = 20.0;

impl WalkingBehaviour {
    /// Stands and looks where the sweep leads.
    pub(super) fn look(&mut self, sweep: Sweep) {
        self.enter(State::LookAround(sweep));
    }

    /// One tick of the look.
    pub(super) fn look_around(&mut self, tick: &Tick<'_>) -> Motion {
        let State::LookAround(sweep) = self.machine.state_mut() else {
            return Motion::Stand;
        };
        let frames = tick.situation.frames_used;
        let speed_radps = self.config.gaze_speed;
        let seen = sweep.advance(&mut self.gazer, frames, tick.passed_s, speed_radps);
        let found_a_way = self.looks > 0 && self.way.s() > SURE_S;
        if seen || found_a_way || self.machine.lasted_s() > LONGEST_LOOK_S {
            if let Some((path, track)) = &tick.track {
                let view = tick.situation.view;
                self.looked.mark(path, track, view, &self.config);
                self.looks = 0;
                self.set_off(track);
            } else {
                self.look_elsewhere(tick);
            }
        }
        Motion::Stand
    }

    /// There is no way from what was seen here: turn and look there, and give up when all around was looked at.
    fn look_elsewhere(&mut self, tick: &Tick<'_>) {
        self.looks += 1;
        if self.looks < LOOKS {
            let to_rad = Some(wrap_angle(tick.pose.yaw_rad + LOOK_APART_RAD));
            self.enter(State::Turn { to_rad });
            return;
        }
        if self.no_way.s() >= self.config.refuse_time
            && let Some(reason) = tick.no_way_reason()
        {
            self.refuse(reason);
            return;
        }
        let around = Sweep::around(&self.config);
        self.machine.begin_again(State::LookAround(around));
    }

    /// Turns the head towards a direction, as far as it goes.
    pub(super) fn gaze_at(&mut self, tick: &Tick<'_>, pan_rad: f64, down_rad: f64) {
        let pan_rad = pan_rad.clamp(-self.config.sweep, self.config.sweep);
        let goal = Gaze { pan_rad, down_rad };
        self.gazer.turn(goal, tick.passed_s, self.config.gaze_speed);
    }
}
