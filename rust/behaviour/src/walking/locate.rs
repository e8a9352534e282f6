//! The state `locate`: the robot does not know where it is, and looks round until the localizer does.

use geometry::PlanarPose;
use terrain::support::is_level_floor;

use super::WalkingBehaviour;
use crate::walking::state::{Locating, State};
use crate::walking::tick::WayTick;
use crate::walking::tuning::LocateTuning;
use crate::{Motion, Velocity};

impl WalkingBehaviour {
    /// Begins to find out where it is.
    pub(super) fn begin_locating(&mut self, tick: &WayTick<'_>) {
        if matches!(self.machine.state(), State::Locate(_)) {
            return;
        }
        self.came_by.forget();
        // A robot that has just looked round turns on.
        let holds_s = self.config.tuning.locate.look_holds;
        self.looked_round_s =
            (self.looked_round_s).filter(|looked_s| tick.elapsed_s - looked_s < holds_s);
        self.enter(State::Locate(Locating {
            sweep: self.around(),
            lost_at: odometry_in_map(tick),
        }));
    }

    /// Stands and looks around, the ground before the feet first; turns on the spot, then goes in small circles where the floor
    /// ahead is free, and gives up in the end.
    pub(super) fn locate(&mut self, tick: &WayTick<'_>) -> Motion {
        if !tick.situation.estimate.lost {
            self.go_on(tick);
            return Motion::Stand;
        }
        let lasted_s = self.machine.lasted_s();
        if lasted_s > self.config.locate_limit {
            self.refuse(format!(
                "lost: the robot has not found out where it is for {lasted_s:.0} s"
            ));
            return Motion::Stand;
        }
        let Some(looked_s) = self.looked_round_s else {
            let frames = tick.situation.frames_used;
            let speed_radps = self.config.gaze_speed;
            let State::Locate(Locating { sweep, .. }) = self.machine.state_mut() else {
                return Motion::Stand;
            };
            let seen = sweep.advance(&mut self.gazer, frames, tick.passed_s, speed_radps);
            if seen || lasted_s > self.config.tuning.look_around.longest {
                self.looked_round_s = Some(tick.elapsed_s);
            }
            return Motion::Stand;
        };
        let turned_s = tick.elapsed_s - looked_s;
        let phase = std::f64::consts::TAU * turned_s / self.config.tuning.locate.sway_period;
        let pan_rad = self.config.tuning.locate.sway * libm::sin(phase);
        self.gaze_at(tick, pan_rad, self.config.gaze_far);
        let tuning = &self.config.tuning.locate;
        let turn_radps = self.config.turn_speed;
        let circles =
            turned_s * turn_radps > tuning.turned && is_free_ahead(tick, tuning, self.levels.same);
        Motion::Walk(if circles {
            Velocity {
                x_mps: self.config.creep_speed,
                yaw_radps: tuning.circle_share * turn_radps,
                ..Velocity::default()
            }
        } else {
            Velocity {
                yaw_radps: turn_radps,
                ..Velocity::default()
            }
        })
    }

    /// Looks round at a place where it was not known to be; goes on where it is where it was.
    fn go_on(&mut self, tick: &WayTick<'_>) {
        let now = odometry_in_map(tick);
        let stayed = match self.machine.state() {
            State::Locate(Locating { lost_at, .. }) => {
                now.distance_m(lost_at) < self.config.tuning.locate.elsewhere
            }
            _ => false,
        };
        match &tick.track {
            Some((_, track)) if stayed => self.set_off(track),
            _ => self.look(self.around()),
        }
    }
}

/// The odometry frame in the map: it moves when the robot finds itself elsewhere.
fn odometry_in_map(tick: &WayTick<'_>) -> PlanarPose {
    let frame = &tick.situation.estimate.map_from_odometry;
    let origin = frame.origin().inner;
    PlanarPose::new(origin.x, origin.y, frame.yaw_rad())
}

/// Whether the floor before the feet is known, level and free.
fn is_free_ahead(tick: &WayTick<'_>, tuning: &LocateTuning, level_m: f64) -> bool {
    let (view, ground_m) = (tick.situation.view, tick.ground_m);
    tuning.ahead.iter().all(|&ahead_m| {
        tuning.aside.iter().all(|&aside_m| {
            let (x_m, y_m) = tick.pose.apply(ahead_m, aside_m);
            is_level_floor(view, [x_m, y_m], ground_m, level_m)
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::walking::simulation::{Simulation, walking};
    use crate::{Outcome, WalkingConfig};

    #[test]
    fn who_took_long_to_find_out_where_it_is_was_not_idle_and_goes_on() {
        let mut simulation = Simulation::new(PlanarPose::default(), [1.0, 0.0]);
        let config = WalkingConfig {
            locate_limit: 120.0,
            ..WalkingConfig::default()
        };
        simulation.behaviour = walking(config);
        simulation.lost_until_s = 90.0;
        let (outcome, _) = simulation.run(180.0);
        let states = &simulation.states;
        assert_eq!(outcome, Some(Outcome::GoalReached), "{states:?}");
    }

    #[test]
    fn who_sees_nothing_for_a_while_is_not_idle_meanwhile() {
        let mut simulation = Simulation::new(PlanarPose::default(), [1.0, 0.0]);
        let config = WalkingConfig {
            blind_limit: 120.0,
            ..WalkingConfig::default()
        };
        simulation.behaviour = walking(config);
        simulation.blind = true;
        let _ = simulation.run(90.0);
        simulation.blind = false;
        let (outcome, _) = simulation.run(180.0);
        let states = &simulation.states;
        assert_eq!(outcome, Some(Outcome::GoalReached), "{states:?}");
    }
}
