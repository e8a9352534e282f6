//! Sideways through what is too narrow to be walked straight ahead: turn before it, then side steps with the heading kept.

use super::WalkingBehaviour;
use super::side_leg::{OnLeg, next_sidle};
use super::state::State;
use super::tick::WayTick;
use super::turn::turn_speed;
use crate::{Motion, Velocity, walking::gaze::glance};

impl WalkingBehaviour {
    /// Whether the robot is on a leg sideways, or where one begins.
    pub(super) fn is_at_sidle(&self, tick: &WayTick<'_>) -> bool {
        let tuning = &self.config.tuning.sidle;
        tick.track.is_some_and(|(path, track)| {
            next_sidle(path, &tick.pose, tuning)
                .is_some_and(|sidle| sidle.from_point == 0 || track.remaining_m < tuning.there)
        })
    }

    /// One tick of the walk sideways.
    pub(super) fn sidle(&mut self, tick: &WayTick<'_>) -> Motion {
        let Some((path, _)) = tick.track else {
            return self.without_way(tick);
        };
        if let Some(motion) = self.check_way(tick) {
            return motion;
        }
        let on_leg = next_sidle(path, &tick.pose, &self.config.tuning.sidle)
            .filter(|_| self.is_at_sidle(tick))
            .and_then(|sidle| OnLeg::new(path, sidle, &tick.pose));
        let Some(on_leg) = on_leg else {
            self.enter(State::Walk);
            return Motion::Stand;
        };
        self.machine.gets_on();
        let bearing_rad = on_leg.along[1].atan2(on_leg.along[0]);
        let gaze = glance(tick.elapsed_s, bearing_rad, &self.config);
        self.gazer.turn(gaze, tick.passed_s, self.config.gaze_speed);
        Motion::Walk(self.sidestep(&on_leg))
    }

    fn sidestep(&self, on_leg: &OnLeg) -> Velocity {
        let turning = matches!(&self.motion, Motion::Walk(before)
            if before.x_mps == 0.0 && before.y_mps == 0.0);
        let tuning = &self.config.tuning.sidle;
        let allowed_rad = if turning {
            tuning.turned
        } else {
            tuning.astray
        };
        if on_leg.turn_rad.abs() > allowed_rad {
            return Velocity {
                yaw_radps: turn_speed(on_leg.turn_rad, &self.config),
                ..Velocity::default()
            };
        }
        let OnLeg {
            along, beside_m, ..
        } = on_leg;
        let side_mps = self.config.side_speed;
        let aside_m = beside_m[0].hypot(beside_m[1]);
        let along_mps = side_mps * (1.0 - aside_m / tuning.beside).max(0.0);
        let back = |axis: usize| (beside_m[axis]).clamp(-side_mps, side_mps);
        Velocity {
            x_mps: along_mps * along[0] + back(0),
            y_mps: along_mps * along[1] + back(1),
            yaw_radps: on_leg.turn_rad,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Outcome;
    use crate::walking::simulation::Simulation;
    use geometry::PlanarPose;
    use planning::{AStar, AStarConfig, Footprint};
    use proptest::prelude::*;
    use stairs::{ClimbingConfig, Feet};

    /// Size of the robot from front to back and across, m.
    const BOX_M: [f64; 2] = [0.2, 0.35];
    /// Radius of the planner's circle, m.
    const RADIUS_M: f64 = 0.14;
    /// Where in its cell a wall ends the map does not tell: half a cell, m.
    const HALF_M: f64 = 0.02;

    /// Before a wall with a gap of some width.
    fn before_a_gap(start: PlanarPose, gap_m: f64, footprint: Footprint) -> Simulation {
        let mut simulation = Simulation::new(start, [1.4, 0.0]);
        let half_m = 0.5 * gap_m;
        simulation.boxes = vec![[[0.6, half_m], [0.68, 2.4]], [[0.6, -2.4], [0.68, -half_m]]];
        let config = AStarConfig {
            footprint,
            ..AStarConfig::default()
        };
        let feet = Feet {
            length_m: 0.105,
            pair_width_m: 0.16,
            stance_m: 0.085,
        };
        let planner = AStar::new(config, ClimbingConfig::default(), feet, RADIUS_M).unwrap();
        simulation.planner = Some(planner.with_rectangle(BOX_M));
        simulation
    }

    /// How deep the corners of the wall reached into the robot, m, below 0 where none did: into its circle while it walks ahead or
    /// turns, into its box while it walks sideways.
    fn deepest_m(simulation: &Simulation, motion: &Motion) -> f64 {
        let sideways = matches!(motion, Motion::Walk(v) if v.y_mps.abs() > v.x_mps.abs());
        let corners = simulation.boxes.iter().flat_map(|[low, high]| {
            let y = if low[1] > 0.0 { low[1] } else { high[1] };
            [[low[0], y], [high[0], y]]
        });
        let robot_from_map = simulation.pose.inverse();
        let inside = corners.map(|[x, y]| {
            let (x, y) = robot_from_map.apply(x, y);
            if sideways {
                (0.5 * BOX_M[0] - x.abs()).min(0.5 * BOX_M[1] - y.abs())
            } else {
                RADIUS_M - HALF_M - x.hypot(y)
            }
        });
        inside.fold(f64::NEG_INFINITY, f64::max)
    }

    #[test]
    fn the_circle_refuses_it_and_what_is_wide_is_walked_straight_ahead() {
        let mut narrow = before_a_gap(PlanarPose::default(), 0.28, Footprint::Circle);
        // In a closed room: out of the window and around the wall's ends leads a way that this window does not follow.
        narrow.boxes.extend([
            [[-0.9, 1.2], [0.68, 1.28]],
            [[-0.9, -1.28], [0.68, -1.2]],
            [[-0.98, -1.28], [-0.9, 1.28]],
        ]);
        let (outcome, _) = narrow.run(150.0);
        assert!(
            matches!(outcome, Some(Outcome::Refused(reason)) if reason.starts_with("too_narrow: "))
        );
        let mut wide = before_a_gap(PlanarPose::default(), 0.5, Footprint::Oriented);
        assert_eq!(wide.run(150.0).0, Some(Outcome::GoalReached));
        assert!(!wide.was_in("sidle"));
    }

    /// What takes seconds: not in the fast part of the tests.
    mod slow {
        use super::*;

        proptest! {
            #![proptest_config(ProptestConfig::with_cases(3))]

            #[test]
            fn what_is_too_narrow_straight_ahead_is_passed_sideways_without_contact(
                x in -0.5..0.1f64, y in -0.4..0.4f64, yaw in -3.1..3.1f64,
            ) {
                let mut simulation = before_a_gap(PlanarPose::new(x, y, yaw), 0.28, Footprint::Oriented);
                let mut outcome = None;
                while outcome.is_none() && simulation.time_ns < 150_000_000_000 {
                    let decision = simulation.tick();
                    outcome = decision.outcome;
                    let deepest_m = deepest_m(&simulation, &decision.command.motion);
                    prop_assert!(deepest_m < 0.0, "{} at {:?}: {:?}", deepest_m, simulation.pose, simulation.states);
                }
                prop_assert_eq!(outcome, Some(Outcome::GoalReached), "{:?}", simulation.states);
                prop_assert!(simulation.was_in("sidle"));
            }
        }
    }
}
