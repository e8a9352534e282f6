//! What the robot does in each state, and what comes next.

use geometry::{angle_between, wrap_angle};

use super::WalkingBehaviour;
use crate::machine::Tick;
use crate::walking::ahead::unknown_ahead;
use crate::walking::gaze::{Sweep, glance};
use crate::walking::progress::Headway;
use crate::walking::state::State;
use crate::walking::track::{Track, turn_speed};
use crate::{Gaze, Motion, Velocity};

/// Without a plan for less than this the last command holds, s.
const HOLD_S: f64 = 0.3;
/// A way must hold this long to end a look around before its end, s.
const SURE_S: f64 = 0.5;
/// Looks in that many directions, this far apart (rad), see all around: each sweep covers 3 rad with the camera's width,
/// and the head looks on while the robot turns.
const LOOKS: u32 = 2;
const LOOK_APART_RAD: f64 = 3.1;
/// A turn ends after this, wherever it points, s.
const LONGEST_TURN_S: f64 = 15.0;
/// A look around ends after this, whatever the frames do, s.
const LONGEST_LOOK_S: f64 = 20.0;
/// A turn with less than this left looks at the ground near by, rad.
const LOOK_NEAR_RAD: f64 = 1.0;
/// Above this a turn keeps its direction, rad.
const KEEP_DIRECTION_RAD: f64 = 2.4;
/// A robot whose feet come upon unseen steps more often than this gives up.
const STUMBLES: u32 = 3;

impl WalkingBehaviour {
    /// One tick of the present state.
    pub(super) fn act(&mut self, tick: &Tick<'_>) -> Motion {
        match self.state {
            State::LookAround => self.look_around(tick),
            State::Walk => self.walk(tick),
            State::Turn => self.turn(tick),
            State::Sidle => self.sidle(tick),
            State::Stop => self.stop(tick),
            State::Arrive => self.arrive(tick),
            State::Refuse => {
                self.gaze_at(tick, 0.0, self.config.gaze_far);
                Motion::Stand
            }
            State::Blind => self.wait_for_sight(tick),
            State::Locate => self.locate(tick),
        }
    }

    fn look_around(&mut self, tick: &Tick<'_>) -> Motion {
        let frames = tick.situation.frames_used;
        let speed_radps = self.config.gaze_speed;
        let seen = self
            .sweep
            .advance(&mut self.gazer, frames, tick.passed_s, speed_radps);
        let found_a_way = self.looks > 0 && self.way.s() > SURE_S;
        if seen || found_a_way || self.state_s > LONGEST_LOOK_S {
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
            self.turn_to_rad = Some(wrap_angle(tick.pose.yaw_rad + LOOK_APART_RAD));
            self.enter(State::Turn);
            return;
        }
        if self.no_way.s() >= self.config.refuse_time
            && let Some(reason) = tick.no_way_reason()
        {
            self.refuse(reason);
            return;
        }
        self.sweep = Sweep::around(&self.config);
        self.state_s = 0.0;
    }

    /// Walk, or first turn to where the way leads.
    pub(super) fn set_off(&mut self, track: &Track) {
        self.turn_to_rad = None;
        let turn = self.must_turn(track);
        self.enter(if turn { State::Turn } else { State::Walk });
    }

    fn must_turn(&self, track: &Track) -> bool {
        track.remaining_m >= self.config.approach
            && track.bearing_rad().abs() > self.config.turn_above
    }

    fn walk(&mut self, tick: &Tick<'_>) -> Motion {
        let Some((path, track)) = &tick.track else {
            return self.without_way(tick);
        };
        if let Some(motion) = self.check_way(tick) {
            return motion;
        }
        let view = tick.situation.view;
        let (unknown, stays_unknown) = unknown_ahead(path, track, view, &self.looked, &self.config);
        if let Some(place_m) = unknown {
            self.look(Sweep::at(tick.bearing_rad(place_m), &self.config));
            return Motion::Stand;
        }
        if tick.is_at_sidle() {
            self.enter(State::Sidle);
            return Motion::Stand;
        }
        if self.must_turn(track) {
            self.enter(State::Turn);
        }
        self.idle.reset();
        let gaze = glance(tick.elapsed_s, track.bearing_rad(), &self.config);
        self.gazer.turn(gaze, tick.passed_s, self.config.gaze_speed);
        let limit_mps = if stays_unknown {
            self.config.creep_speed
        } else {
            f64::INFINITY
        };
        Motion::Walk(track.velocity(limit_mps, &self.config))
    }

    fn turn(&mut self, tick: &Tick<'_>) -> Motion {
        let error_rad = if let Some(goal_rad) = self.turn_to_rad {
            if self.way.s() > SURE_S {
                self.turn_to_rad = None;
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
        let done = error_rad.abs() < self.config.turn_until || self.state_s > LONGEST_TURN_S;
        if done && self.turn_to_rad.take().is_some() {
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

    /// Looks at what is new on the way, and at the watchdog; a motion when that ends the state.
    pub(super) fn check_way(&mut self, tick: &Tick<'_>) -> Option<Motion> {
        let (path, track) = tick.track.as_ref()?;
        if tick.new_frame {
            let (view, stairs) = (tick.situation.view, tick.situation.stairs);
            let ground_m = tick.ground_m;
            let robot = (&tick.pose, ground_m);
            let obstacle_m = self.followed.obstacle_m(view, stairs, robot, &self.config);
            self.followed.keep(path, track.nearest);
            if obstacle_m.is_some() {
                self.watched_m = obstacle_m;
                self.enter(State::Stop);
                return Some(Motion::Stand);
            }
        }
        let detour = tick.situation.plan.is_some_and(|plan| plan.replanned);
        let remaining_m = track.goal_ahead_m(path, tick.situation.goal);
        let passed_s = tick.passed_s;
        match self
            .progress
            .watch(remaining_m, detour, passed_s, &self.config)
        {
            Headway::Fine => return None,
            Headway::Stuck => self.look(Sweep::around(&self.config)),
            Headway::Hopeless => {
                let waited_s = self.progress.without_headway_s();
                self.refuse(format!(
                    "blocked: no headway for {waited_s:.0} s, {remaining_m:.2} m before the goal"
                ));
            }
        }
        Some(Motion::Stand)
    }

    /// Just after a goal was passed the plan is not there yet; else the way is gone.
    pub(super) fn without_way(&mut self, tick: &Tick<'_>) -> Motion {
        let waiting = tick.situation.plan.is_none() && self.no_plan.s() < HOLD_S;
        if waiting {
            return self.motion.clone();
        }
        self.watched_m = None;
        self.enter(State::Stop);
        Motion::Stand
    }

    fn stop(&mut self, tick: &Tick<'_>) -> Motion {
        let bearing_rad = self
            .watched_m
            .map_or(0.0, |place_m| tick.bearing_rad(place_m));
        self.gaze_at(tick, bearing_rad, self.config.gaze_near);
        if self.standing.s() > 0.0 && self.state_s > self.config.stop_time {
            if let Some((_, track)) = &tick.track {
                self.set_off(track);
            } else {
                self.looks = 0;
                self.look(Sweep::around(&self.config));
            }
        }
        Motion::Stand
    }

    /// The feet came upon a step that nobody saw: stand and look, or give up.
    pub(super) fn stumble(&mut self) {
        self.stumbles += 1;
        if self.stumbles > STUMBLES {
            self.refuse("blocked: the feet come upon a step that cannot be seen".to_owned());
        } else {
            self.watched_m = None;
            self.enter(State::Stop);
        }
    }

    fn arrive(&mut self, tick: &Tick<'_>) -> Motion {
        self.gaze_at(tick, 0.0, self.config.gaze_far);
        if self.standing.s() > self.config.arrive_time && !tick.is_in_the_disc() {
            self.watched_m = None;
            self.enter(State::Stop);
        }
        Motion::Stand
    }

    fn wait_for_sight(&mut self, tick: &Tick<'_>) -> Motion {
        self.gaze_at(tick, 0.0, self.config.gaze_near);
        let unseen_s = tick.unseen_s().unwrap_or(tick.elapsed_s);
        if unseen_s < self.config.blind_after {
            self.look(Sweep::around(&self.config));
        } else if self.state_s > self.config.blind_limit {
            self.refuse(format!("lost: nothing has been seen for {unseen_s:.0} s"));
        }
        Motion::Stand
    }

    pub(super) fn gaze_at(&mut self, tick: &Tick<'_>, pan_rad: f64, down_rad: f64) {
        let pan_rad = pan_rad.clamp(-self.config.sweep, self.config.sweep);
        let goal = Gaze { pan_rad, down_rad };
        self.gazer.turn(goal, tick.passed_s, self.config.gaze_speed);
    }
}
