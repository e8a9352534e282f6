//! The state `walk`: follows the path, and what every state that moves along it looks out for.

use super::WalkingBehaviour;
use super::blind::Tried;
use crate::Motion;
use crate::walking::gaze::{Sweep, glance};
use crate::walking::progress::Headway;
use crate::walking::state::State;
use crate::walking::tick::WayTick;
use crate::walking::track::Track;
use crate::walking::unknown::unknown_ahead;

impl WalkingBehaviour {
    /// Walks, or first turns to where the way leads.
    pub(super) fn set_off(&mut self, track: &Track) {
        let turn = self.must_turn(track);
        self.enter(if turn {
            State::Turn { to_rad: None }
        } else {
            State::Walk
        });
    }

    fn bearing_rad(&self, track: &Track) -> f64 {
        track.bearing_rad(&self.config.tuning.track)
    }

    fn must_turn(&self, track: &Track) -> bool {
        track.remaining_m >= self.config.approach
            && self.bearing_rad(track).abs() > self.config.turn_above
    }

    /// One tick of the walk.
    pub(super) fn walk(&mut self, tick: &WayTick<'_>) -> Motion {
        let Some((path, track)) = &tick.track else {
            return self.without_way(tick);
        };
        if let Some(motion) = self.check_way(tick) {
            return motion;
        }
        let view = tick.situation.view;
        let (unknown, stays_unknown) = unknown_ahead(
            path,
            track,
            view,
            &self.looked,
            &self.config,
            self.foot_side_m,
        );
        if let Some(place_m) = unknown {
            self.look(Sweep::at(tick.bearing_rad(place_m), &self.config));
            return Motion::Stand;
        }
        if self.looks_up(tick, path, self.config.look_up_distance) {
            return Motion::Stand;
        }
        let overhead = self.overhead_ahead(path, track, view, tick.ground_m);
        if self.is_at_sidle(tick) {
            self.enter(State::Sidle);
            return Motion::Stand;
        }
        if self.must_turn(track) {
            self.enter(State::Turn { to_rad: None });
        }
        self.machine.gets_on();
        self.tried = Tried::default();
        (self.came_by).note([tick.pose.x_m, tick.pose.y_m], &self.config.tuning.blind);
        let mut gaze = glance(tick.elapsed_s, self.bearing_rad(track), &self.config);
        if let Some(place) = overhead.unlooked
            && gaze.down_rad == self.config.gaze_far
        {
            let bearing_rad = tick.bearing_rad(place.at_m);
            gaze.pan_rad = bearing_rad.clamp(-self.config.sweep, self.config.sweep);
            gaze.down_rad = place.down_rad;
        }
        self.gazer.turn(gaze, tick.passed_s, self.config.gaze_speed);
        let limit_mps = if stays_unknown || overhead.stays_unseen {
            self.config.creep_speed
        } else {
            f64::INFINITY
        };
        Motion::Walk(track.velocity(limit_mps, &self.config))
    }

    /// Looks at what is new on the way, and at the watchdog; a motion when that ends the state.
    pub(super) fn check_way(&mut self, tick: &WayTick<'_>) -> Option<Motion> {
        let (path, track) = tick.track.as_ref()?;
        if tick.new_frame {
            let (view, stairs) = (tick.situation.view, tick.situation.stairs);
            let robot = (&tick.pose, tick.ground_m - self.levels.same);
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
            Headway::Stuck => self.look(self.around()),
            Headway::Hopeless => {
                let waited_s = self.progress.waited_ever_s;
                self.refuse(format!(
                    "blocked: no headway for {waited_s:.0} s, {remaining_m:.2} m before the goal"
                ));
            }
        }
        Some(Motion::Stand)
    }

    /// Waits or stops without a way: just after a goal was passed the plan is not there yet; else the way is gone.
    pub(super) fn without_way(&mut self, tick: &WayTick<'_>) -> Motion {
        let waiting =
            tick.situation.plan.is_none() && self.no_plan.s() < self.config.tuning.plan_hold;
        if waiting {
            return self.motion.clone();
        }
        self.watched_m = None;
        self.enter(State::Stop);
        Motion::Stand
    }
}
