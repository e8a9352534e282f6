//! The state `locate`: the robot does not know where it is, and looks round until the localizer does.

use geometry::PlanarPose;
use mapping::{FloorView, Surface};

use super::WalkingBehaviour;
use crate::machine::Tick;
use crate::walking::gaze::Sweep;
use crate::walking::state::State;
use crate::{Motion, Velocity};

/// The head sways so far to each side of straight ahead, rad: walls tell more than the floor before the feet.
const SWAY_RAD: f64 = 0.6;
/// The head sways to and fro in this time, s.
const SWAY_S: f64 = 4.0;
/// The look around at the start ends after this, whatever the frames do, s.
const LONGEST_LOOK_S: f64 = 12.0;
/// A robot that lost its place again within this time does not begin with a look around, s.
const LOOK_HOLDS_S: f64 = 30.0;
/// After as much turning, rad, small circles tell more than turning on.
const TURNED_RAD: f64 = 4.0;
/// Share of the turning speed on a circle.
const CIRCLE_SHARE: f64 = 0.6;
/// The odometry frame moves further than this in the map, m, when the robot finds itself elsewhere.
const ELSEWHERE_M: f64 = 0.2;
/// Floor is needed so far ahead to walk on, m.
const AHEAD_M: [f64; 3] = [0.15, 0.25, 0.35];
/// Floor is needed so far to the side, m, at each distance ahead.
const ASIDE_M: [f64; 3] = [-0.12, 0.0, 0.12];
/// Floor to walk on is as level as this, m.
const LEVEL_M: f64 = 0.012;

/// What is known while the robot finds out where it is.
#[derive(Debug, Clone)]
pub(crate) struct Locating {
    /// The look around at its beginning.
    pub(super) sweep: Sweep,
    /// The odometry frame in the map when the robot lost its place.
    pub(super) lost_at: PlanarPose,
}

impl WalkingBehaviour {
    /// Begins to find out where it is.
    pub(super) fn begin_locating(&mut self, tick: &Tick<'_>) {
        if matches!(self.machine.state(), State::Locate(_)) {
            return;
        }
        // A robot that has just looked round turns on.
        self.looked_round_s =
            (self.looked_round_s).filter(|looked_s| tick.elapsed_s - looked_s < LOOK_HOLDS_S);
        self.enter(State::Locate(Locating {
            sweep: Sweep::around(&self.config),
            lost_at: odometry_in_map(tick),
        }));
    }

    /// Stands and looks around, the ground before the feet first; turns on the spot, then goes in small circles where the floor
    /// ahead is free, and gives up in the end.
    pub(super) fn locate(&mut self, tick: &Tick<'_>) -> Motion {
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
            if seen || lasted_s > LONGEST_LOOK_S {
                self.looked_round_s = Some(tick.elapsed_s);
            }
            return Motion::Stand;
        };
        let turned_s = tick.elapsed_s - looked_s;
        let phase = std::f64::consts::TAU * turned_s / SWAY_S;
        self.gaze_at(tick, SWAY_RAD * phase.sin(), self.config.gaze_far);
        let turn_radps = self.config.turn_speed;
        let circles = turned_s * turn_radps > TURNED_RAD && is_free_ahead(tick);
        Motion::Walk(if circles {
            Velocity {
                x_mps: self.config.creep_speed,
                yaw_radps: CIRCLE_SHARE * turn_radps,
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
    fn go_on(&mut self, tick: &Tick<'_>) {
        let now = odometry_in_map(tick);
        let stayed = match self.machine.state() {
            State::Locate(Locating { lost_at, .. }) => now.distance_m(lost_at) < ELSEWHERE_M,
            _ => false,
        };
        match &tick.track {
            Some((_, track)) if stayed => self.set_off(track),
            _ => self.look(Sweep::around(&self.config)),
        }
    }
}

/// The odometry frame in the map: it moves when the robot finds itself elsewhere.
fn odometry_in_map(tick: &Tick<'_>) -> PlanarPose {
    let frame = &tick.situation.estimate.map_from_odometry;
    let origin = frame.origin().inner;
    PlanarPose::new(origin.x, origin.y, frame.yaw_rad())
}

/// Whether the floor before the feet is known, level and free.
fn is_free_ahead(tick: &Tick<'_>) -> bool {
    let view: &FloorView = tick.situation.view;
    let ground_m = tick.ground_m;
    AHEAD_M.iter().all(|&ahead_m| {
        ASIDE_M.iter().all(|&aside_m| {
            let (x, y) = tick.pose.apply(ahead_m, aside_m);
            matches!(view.at(x, y), Surface::Floor(height_m) if (f64::from(height_m) - ground_m).abs() < LEVEL_M)
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::walking::simulation::Simulation;
    use crate::{Outcome, WalkingConfig};

    #[test]
    fn who_took_long_to_find_out_where_it_is_was_not_idle_and_goes_on() {
        let mut simulation = Simulation::new(PlanarPose::default(), [1.0, 0.0]);
        let config = WalkingConfig {
            locate_limit: 120.0,
            ..WalkingConfig::default()
        };
        simulation.behaviour = WalkingBehaviour::new(config).unwrap();
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
        simulation.behaviour = WalkingBehaviour::new(config).unwrap();
        simulation.blind = true;
        let _ = simulation.run(90.0);
        simulation.blind = false;
        let (outcome, _) = simulation.run(180.0);
        let states = &simulation.states;
        assert_eq!(outcome, Some(Outcome::GoalReached), "{states:?}");
    }
}
