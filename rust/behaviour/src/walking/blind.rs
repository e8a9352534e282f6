//! The state `blind`: nothing is seen. The robot looks elsewhere, steps back the way it came, turns on the spot, and then gives up.
//!
//! What is too near to be seen, a frozen picture or a light that is out may be seen again from another place, or in another direction.

use std::f64::consts::PI;

use geometry::{angle_between, distance_m, wrap_angle};
use terrain::support::is_roomy;

use super::WalkingBehaviour;
use super::room_beside::obstacles_to_the_left;
use crate::machine::{SightAgain, State as _};
use crate::walking::gaze::Sweep;
use crate::walking::state::{Blind, State};
use crate::walking::tick::WayTick;
use crate::walking::tuning::BlindTuning;
use crate::{Motion, Velocity};

/// What was tried since the robot last walked.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Tried {
    stepped_back: bool,
    turned: bool,
}

/// The way that the robot came by: places in the map, the newest last, m.
#[derive(Debug, Clone, Default)]
pub(super) struct CameBy {
    places_m: Vec<[f64; 2]>,
}

impl CameBy {
    /// Notes a place, and forgets those that lie further back than one would step.
    pub(super) fn note(&mut self, place_m: [f64; 2], tuning: &BlindTuning) {
        let is_new = |&last_m: &[f64; 2]| distance_m(last_m, place_m) > tuning.reached;
        if self.places_m.last().is_none_or(is_new) {
            self.places_m.push(place_m);
        }
        let too_far = |&&back_m: &&[f64; 2]| distance_m(back_m, place_m) > tuning.back;
        let gone = self.places_m.iter().take_while(too_far).count();
        self.places_m.drain(..gone).for_each(drop);
    }

    /// The map moved, or another behaviour carried the robot on.
    pub(super) fn forget(&mut self) {
        self.places_m.clear();
    }

    /// Where to step back to from here, if it is worth a step.
    fn back_from(&self, here_m: [f64; 2], tuning: &BlindTuning) -> Option<[f64; 2]> {
        let first_m = *self.places_m.first()?;
        (distance_m(first_m, here_m) > tuning.reached).then_some(first_m)
    }
}

impl WalkingBehaviour {
    /// One tick without sight. A turn and steps back are done to their end: what is seen on the way is seen from there, too, or it was
    /// seen by chance.
    pub(super) fn wait_for_sight(&mut self, tick: &WayTick<'_>, blind: Blind) -> Motion {
        match blind {
            Blind::Look(sweep) => self.look_blindly(tick, sweep),
            Blind::StepBack { to_m } => self.step_back(tick, to_m),
            Blind::Turn { to_rad } => self.turn_blindly(tick, to_rad),
        }
    }

    /// Begins to look for sight. Who walked into the dark first steps back: what it cannot see may stand right before it.
    pub(super) fn begin_blind(&mut self, tick: &WayTick<'_>) {
        let walked_into_it = self.machine.state().walks() && self.machine.is_dark();
        self.darks += u32::from(walked_into_it);
        if self.darks > self.config.tries {
            self.refuse("blocked: nothing can be seen ahead, time after time".to_owned());
            return;
        }
        self.enter(State::Blind(self.blind_look()));
        if walked_into_it {
            let _ = self.tries_elsewhere(tick);
        }
    }

    /// The look of a robot that sees nothing, from its beginning.
    pub(super) fn blind_look(&self) -> Blind {
        Blind::Look(Sweep::in_the_dark(&self.config))
    }

    fn look_blindly(&mut self, tick: &WayTick<'_>, mut sweep: Sweep) -> Motion {
        let (frames, speed_radps) = (tick.situation.frames_used, self.config.gaze_speed);
        let sight = self.machine.sight(tick);
        if sight == SightAgain::Back {
            self.look(self.around());
        } else if !sweep.advance(&mut self.gazer, frames, tick.passed_s, speed_radps) {
            self.machine.go_on(State::Blind(Blind::Look(sweep)));
        } else if !self.tries_elsewhere(tick) {
            self.look_down(tick);
            if let SightAgain::Hopeless(reason) = sight {
                self.refuse(reason);
            }
        }
        Motion::Stand
    }

    /// Looks to the feet and near by in turns: what it stands on may be out of view.
    fn look_down(&mut self, tick: &WayTick<'_>) {
        let gaze = &self.config.tuning.gaze;
        let phase = (self.machine.lasted_s() / gaze.period).fract();
        let down_rad = if phase < gaze.far_share {
            self.config.gaze_feet
        } else {
            self.config.gaze_near
        };
        self.gaze_at(tick, 0.0, down_rad);
    }

    /// Begins what was not tried yet; false where all was, and where it is the camera that gives no picture: then no place is better.
    fn tries_elsewhere(&mut self, tick: &WayTick<'_>) -> bool {
        if tick.situation.measured_share.is_none() {
            return false;
        }
        let here_m = [tick.pose.x_m, tick.pose.y_m];
        let back_m = (self.came_by.back_from(here_m, &self.config.tuning.blind))
            .filter(|_| !self.tried.stepped_back);
        if let Some(to_m) = back_m {
            self.tried.stepped_back = true;
            let next = State::Blind(Blind::StepBack { to_m });
            self.machine.begin_again(next);
            return true;
        }
        if self.tried.turned {
            return false;
        }
        self.tried.turned = true;
        let to_rad = wrap_angle(tick.pose.yaw_rad + self.blind_turn_rad(tick));
        let next = State::Blind(Blind::Turn { to_rad });
        self.machine.begin_again(next);
        true
    }

    /// How far to turn: about, where the map has nothing within the robot's reach; else by a hand's breadth, away from what it has.
    fn blind_turn_rad(&self, tick: &WayTick<'_>) -> f64 {
        let (view, here_m) = (tick.situation.view, [tick.pose.x_m, tick.pose.y_m]);
        if is_roomy(view, here_m, self.radius_m) {
            return self.config.tuning.look_around.apart;
        }
        let to_the_left = obstacles_to_the_left(tick, self.radius_m);
        let turn_rad = (self.config.tuning.blind.hand / self.radius_m).min(PI);
        if to_the_left > 0.0 {
            -turn_rad
        } else {
            turn_rad
        }
    }

    /// One tick of the steps back.
    fn step_back(&mut self, tick: &WayTick<'_>, to_m: [f64; 2]) -> Motion {
        match self.step_towards(tick, to_m) {
            Some(motion) => motion,
            None => self.look_again(),
        }
    }

    /// One tick of the turn.
    fn turn_blindly(&mut self, tick: &WayTick<'_>, to_rad: f64) -> Motion {
        let error_rad = angle_between(tick.pose.yaw_rad, to_rad);
        let late = self.machine.lasted_s() > self.config.tuning.turn.longest;
        if error_rad.abs() < self.config.turn_until || late {
            return self.look_again();
        }
        self.gaze_at(tick, error_rad, self.config.gaze_near);
        Motion::Walk(Velocity {
            yaw_radps: self.turn_velocity(error_rad),
            ..Velocity::default()
        })
    }

    fn look_again(&mut self) -> Motion {
        let look = State::Blind(self.blind_look());
        self.machine.begin_again(look);
        Motion::Stand
    }
}

#[cfg(test)]
mod tests {
    use geometry::PlanarPose;

    use super::*;
    use crate::Outcome;
    use crate::walking::simulation::Simulation;

    #[test]
    fn who_stands_before_a_wall_too_near_to_be_seen_turns_about_and_goes() {
        for yaw_rad in [-0.1, 0.0, 0.1] {
            let start = PlanarPose::new(0.0, 0.0, yaw_rad);
            let mut simulation = Simulation::new(start, [-1.2, 0.2]);
            simulation.sees_only = Some((PI, 1.2));
            let (outcome, _) = simulation.run(120.0);
            let states = &simulation.states;
            assert_eq!(outcome, Some(Outcome::GoalReached), "{states:?}");
            assert!(simulation.was_in("blind"));
        }
    }

    /// Walks ahead until nothing is seen any more beyond a place, and steps back out of it.
    #[test]
    fn who_walked_to_where_nothing_is_seen_steps_back_the_way_it_came() {
        let mut simulation = Simulation::new(PlanarPose::default(), [1.0, 0.0]);
        simulation.sees_before_x_m = 0.5;
        let mut furthest_m: f64 = 0.0;
        let back = (0..9000).any(|_| {
            let _ = simulation.tick();
            furthest_m = furthest_m.max(simulation.pose.x_m);
            furthest_m - simulation.pose.x_m > 0.1
        });
        let states = &simulation.states;
        assert!(back && simulation.pose.yaw_rad.abs() < 0.3, "{states:?}");
    }

    /// What fills the whole view is too near to be measured: the map still says that the way is free.
    #[test]
    fn who_walks_into_the_dark_stops_at_once_and_steps_back() {
        let mut simulation = Simulation::new(PlanarPose::default(), [1.0, 0.0]);
        simulation.dark_beyond_x_m = 0.5;
        let mut furthest_m: f64 = 0.0;
        let back = (0..6000).any(|_| {
            let _ = simulation.tick();
            furthest_m = furthest_m.max(simulation.pose.x_m);
            furthest_m - simulation.pose.x_m > 0.1
        });
        assert!(back && furthest_m < 0.56, "{furthest_m}");
        let (outcome, _) = simulation.run(400.0);
        assert!(matches!(outcome, Some(Outcome::Refused(_))), "{outcome:?}");
    }

    #[test]
    fn who_sees_nothing_wherever_it_looks_has_turned_once_and_gives_up_in_bounded_time() {
        let mut simulation = Simulation::new(PlanarPose::default(), [1.0, 0.0]);
        simulation.blind = true;
        let (outcome, after_s) = simulation.run(120.0);
        assert!(matches!(outcome, Some(Outcome::Refused(_))), "{outcome:?}");
        assert!(after_s < 60.0, "{after_s}");
        assert!(angle_between(0.0, simulation.pose.yaw_rad).abs() > 2.5);
    }

    #[test]
    fn who_has_no_picture_stays_where_it_is_and_gives_up_soon() {
        let mut simulation = Simulation::new(PlanarPose::default(), [1.0, 0.0]);
        (simulation.blind, simulation.frozen) = (true, true);
        let (outcome, after_s) = simulation.run(120.0);
        assert!(matches!(outcome, Some(Outcome::Refused(_))), "{outcome:?}");
        assert!(
            after_s < 20.0 && simulation.pose == PlanarPose::default(),
            "{after_s}"
        );
    }

    /// A box within the robot's reach, at its left: by a hand's breadth, to the right.
    #[test]
    fn without_room_it_turns_by_a_hands_breadth_away_from_what_is_near() {
        let mut simulation = Simulation::new(PlanarPose::default(), [1.0, 0.0]);
        let cell = simulation.view.lattice.cell_at(0.0, 0.06);
        if let Some(surface) = simulation.view.cells.get_mut(cell) {
            *surface = mapping::Surface::Obstacle(0.3);
        }
        simulation.blind = true;
        let _ = simulation.run(120.0);
        let yaw_rad = simulation.pose.yaw_rad;
        assert!((-1.0..-0.1).contains(&yaw_rad), "{yaw_rad}");
    }
}
