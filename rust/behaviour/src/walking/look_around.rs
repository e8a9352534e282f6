//! The state `look_around`: the head sweeps over the ground around, or over a place on the path, until there is a way.

use geometry::wrap_angle;

use super::WalkingBehaviour;
use crate::{Gaze, Motion, walking::gaze::Sweep, walking::state::State, walking::tick::WayTick};

impl WalkingBehaviour {
    /// Stands and looks where the sweep leads.
    pub(super) fn look(&mut self, sweep: Sweep) {
        self.enter(State::LookAround(sweep));
    }

    /// One tick of the look.
    pub(super) fn look_around(&mut self, tick: &WayTick<'_>) -> Motion {
        let State::LookAround(sweep) = self.machine.state_mut() else {
            return Motion::Stand;
        };
        let frames = tick.situation.frames_used;
        let speed_radps = self.config.gaze_speed;
        let seen = sweep.advance(&mut self.gazer, frames, tick.passed_s, speed_radps);
        let found_a_way = self.looks > 0 && self.has_a_sure_way();
        if seen || found_a_way || self.machine.lasted_s() > self.config.tuning.look_around.longest {
            if let Some((path, track)) = &tick.track {
                let view = tick.situation.view;
                self.looked
                    .mark(path, track, view, &self.config, self.foot_side_m);
                self.looks = 0;
                self.set_off(track);
            } else {
                self.look_elsewhere(tick);
            }
        }
        Motion::Stand
    }

    /// Whether there is a way, and has been for long enough to go by it.
    pub(super) fn has_a_sure_way(&self) -> bool {
        self.way.s() > self.config.tuning.look_around.sure_after
    }

    /// There is no way from what was seen here: turn and look there, and give up when all around was looked at, or when a look from here
    /// showed none time and again.
    fn look_elsewhere(&mut self, tick: &WayTick<'_>) {
        let here_m = [tick.pose.x_m, tick.pose.y_m];
        if self.looks == 0
            && let Some(reason) = tick.no_way_reason()
        {
            // The first time there are other directions to look at.
            let times = self.dead_ends.meet(here_m, self.radius_m);
            if times > 1 && times >= self.config.tries {
                self.refuse(reason);
                return;
            }
        }
        self.looks += 1;
        let tuning = &self.config.tuning.look_around;
        let goal = tick.situation.goal;
        let bearing_rad = tick.bearing_rad([goal.x_m, goal.y_m]);
        let shut_in = is_the_goal_shut_in(tick);
        let saw_enough = shut_in && bearing_rad.abs() < self.config.sweep;
        if self.looks < tuning.directions && !saw_enough {
            let by_rad = if shut_in { bearing_rad } else { tuning.apart };
            let to_rad = Some(wrap_angle(tick.pose.yaw_rad + by_rad));
            self.enter(State::Turn { to_rad });
            return;
        }
        if self.no_way.s() >= self.config.refuse_time
            && let Some(reason) = tick.no_way_reason()
        {
            self.refuse(reason);
            return;
        }
        let around = self.around();
        self.machine.begin_again(State::LookAround(around));
    }

    /// Turns the head towards a direction, as far as it goes.
    pub(super) fn gaze_at(&mut self, tick: &WayTick<'_>, pan_rad: f64, down_rad: f64) {
        let pan_rad = pan_rad.clamp(-self.config.sweep, self.config.sweep);
        let goal = Gaze { pan_rad, down_rad };
        self.gazer.turn(goal, tick.passed_s, self.config.gaze_speed);
    }
}

/// Whether what is known stands all around the goal: nothing that is seen elsewhere could open a way.
fn is_the_goal_shut_in(tick: &WayTick<'_>) -> bool {
    let way = tick.situation.plan.map(|plan| &plan.way);
    matches!(way, Some(Err(no_way)) if no_way.shuts_goal_in)
}
