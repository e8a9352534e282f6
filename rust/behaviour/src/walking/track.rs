//! The path as seen from the robot: what remains, where it leads, how to walk along it.

use geometry::{PlanarPose, distance_m};
use planning::{Goal, Path};

use crate::Velocity;
use crate::walking::WalkingConfig;
use crate::walking::side_leg::next_sidle;
use crate::walking::tuning::TrackTuning;

/// The path from the robot's place on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Track {
    /// Index of the path's point next to the robot.
    pub(crate) nearest: usize,
    /// From the robot along the path to its end, or to where it has to turn to walk sideways, m.
    pub(crate) remaining_m: f64,
    /// From where it has to turn to walk sideways on to the path's end, m.
    pub(crate) beyond_m: f64,
    /// The point to steer to, in the robot's frame, m.
    pub(crate) target_m: [f64; 2],
    /// The nearest point of the path, in the robot's frame, m.
    pub(crate) offset_m: [f64; 2],
    /// Least clearance from here to the point steered to, m.
    pub(crate) clearance_m: f64,
}

impl Track {
    /// None for a path without points.
    pub(crate) fn new(
        path: &Path,
        map_from_robot: &PlanarPose,
        config: &WalkingConfig,
    ) -> Option<Self> {
        let robot_from_map = map_from_robot.inverse();
        let in_robot = |index: usize| {
            let [x, y] = path.points_m[index];
            let (x, y) = robot_from_map.apply(x, y);
            [x, y]
        };
        let distance = |index: usize| {
            let [x, y] = in_robot(index);
            geometry::hypot(x, y)
        };
        let all = path.points_m.len();
        let sidle = next_sidle(path, map_from_robot, &config.tuning.sidle);
        let end = sidle.map_or(all, |sidle| sidle.from_point + 1);
        let end = end.min(all);
        let nearest = (0..end).min_by(|&a, &b| distance(a).total_cmp(&distance(b)))?;
        let mut target_m = in_robot(nearest);
        let mut clearance_m = clearance(path, nearest);
        let mut along_m = 0.0;
        for index in nearest + 1..end {
            let step_m = length(path, index);
            if along_m < config.lookahead {
                target_m = in_robot(index);
                clearance_m = clearance_m.min(clearance(path, index));
            }
            along_m += step_m;
        }
        Some(Self {
            nearest,
            remaining_m: distance(nearest) + along_m,
            beyond_m: (end..all).map(|index| length(path, index)).sum(),
            target_m,
            offset_m: in_robot(nearest),
            clearance_m,
        })
    }

    /// What is left of the path, m.
    pub(crate) fn whole_m(&self) -> f64 {
        self.remaining_m + self.beyond_m
    }

    /// The least that is left to the goal, m: a path may end where the map does, or where more is to be seen.
    pub(crate) fn goal_ahead_m(&self, path: &Path, goal: &Goal) -> f64 {
        let end_m = path.points_m.last();
        let from_end_m = end_m.map_or(0.0, |&end_m| distance_m([goal.x_m, goal.y_m], end_m));
        self.whole_m() + from_end_m
    }

    /// This way with a last straight piece to a place, in the robot's frame, m.
    pub(crate) fn going_on_to(self, (x, y): (f64, f64)) -> Self {
        Self {
            target_m: [x, y],
            remaining_m: geometry::hypot(x, y),
            ..self
        }
    }

    /// Direction of the point steered to, rad to the left of straight ahead; 0 where the robot stands on it.
    pub(crate) fn bearing_rad(&self, tuning: &TrackTuning) -> f64 {
        let [x, y] = self.target_m;
        if geometry::hypot(x, y) < tuning.on_target {
            0.0
        } else {
            libm::atan2(y, x)
        }
    }

    /// How to walk: towards the target with turns on the way, with side steps near the end.
    pub(crate) fn velocity(&self, limit_mps: f64, config: &WalkingConfig) -> Velocity {
        let tuning = &config.tuning.track;
        let near = (self.clearance_m / config.slow_clearance).clamp(tuning.slowest_share, 1.0);
        let top_mps = (config.forward_speed * near).min(limit_mps);
        if self.remaining_m < config.approach {
            return self.approach(top_mps, config);
        }
        let bearing_rad = self.bearing_rad(tuning);
        let ahead = libm::cos(bearing_rad).max(0.0).powi(2);
        // Only a path that runs about straight ahead is met by side steps; else the turn meets it.
        let side_mps = if bearing_rad.abs() < tuning.straight {
            tuning.side_gain * self.offset_m[1]
        } else {
            0.0
        };
        Velocity {
            x_mps: top_mps * ahead,
            y_mps: side_mps.clamp(-config.side_speed, config.side_speed),
            yaw_radps: (config.tuning.turn.gain * bearing_rad)
                .clamp(-config.turn_speed, config.turn_speed),
        }
    }

    /// Straight to the path's end without turning, slower the nearer it is.
    fn approach(&self, top_mps: f64, config: &WalkingConfig) -> Velocity {
        let (time_s, least_mps) = (config.tuning.track.end_time, config.tuning.track.slowest);
        let [x, y] = self.target_m;
        let left_m = geometry::hypot(x, y);
        if left_m < 1e-6 {
            return Velocity::default();
        }
        let wanted_mps = (left_m / time_s).clamp(least_mps, top_mps.max(least_mps));
        let (vx, vy) = (x / left_m * wanted_mps, y / left_m * wanted_mps);
        let over = (vy.abs() / config.side_speed).max(1.0);
        Velocity {
            x_mps: vx / over,
            y_mps: vy / over,
            yaw_radps: 0.0,
        }
    }
}

fn clearance(path: &Path, index: usize) -> f64 {
    path.clearance_m
        .get(index)
        .copied()
        .unwrap_or(f64::INFINITY)
}

/// Length of the path's piece that ends at `index`, m.
pub(crate) fn length(path: &Path, index: usize) -> f64 {
    distance_m(path.points_m[index - 1], path.points_m[index])
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use proptest::prelude::*;

    pub(crate) fn config_of_tests() -> WalkingConfig {
        WalkingConfig {
            lookahead: 0.25,
            ..WalkingConfig::default()
        }
    }

    pub(crate) fn straight(from: [f64; 2], to: [f64; 2]) -> Path {
        let length_m = geometry::hypot(to[0] - from[0], to[1] - from[1]);
        let count = (length_m / 0.04).ceil().max(1.0) as usize;
        let points_m: Vec<_> = (0..=count)
            .map(|i| {
                let share = i as f64 / count as f64;
                [
                    from[0] + (to[0] - from[0]) * share,
                    from[1] + (to[1] - from[1]) * share,
                ]
            })
            .collect();
        Path {
            unknown: vec![false; points_m.len()],
            clearance_m: vec![1.0; points_m.len()],
            cost_m: length_m,
            points_m,
            ..Path::default()
        }
    }

    #[test]
    fn a_path_that_ends_before_the_goal_is_not_all_that_is_left() {
        let path = straight([0.0, 0.0], [0.6, 0.0]);
        let track = Track::new(&path, &PlanarPose::new(0.1, 0.0, 0.0), &config_of_tests()).unwrap();
        let goal = Goal {
            x_m: 0.6,
            y_m: 2.0,
            radius_m: 0.2,
            height_m: None,
        };
        assert!((track.goal_ahead_m(&path, &goal) - 2.5).abs() < 0.02);
    }

    proptest! {
        #[test]
        fn the_velocity_is_finite_and_within_the_limits(
            x in -2.0..2.0f64, y in -2.0..2.0f64, yaw in -3.2..3.2f64, tx in -2.0..2.0f64, ty in -2.0..2.0f64,
        ) {
            let config = WalkingConfig::default();
            let track = Track::new(&straight([x, y], [tx, ty]), &PlanarPose::new(x, y, yaw), &config_of_tests()).unwrap();
            let velocity = track.velocity(f64::INFINITY, &config);
            prop_assert!(velocity.x_mps.abs() <= config.forward_speed + 1e-9);
            prop_assert!(velocity.y_mps.abs() <= config.side_speed + 1e-9);
            prop_assert!(velocity.yaw_radps.abs() <= config.turn_speed + 1e-9);
            prop_assert!((velocity.x_mps + velocity.y_mps + velocity.yaw_radps).is_finite());
        }

        #[test]
        fn what_remains_is_the_way_along_the_path(x in 0.0..1.9f64, y in -0.3..0.3f64) {
            let track = Track::new(&straight([0.0, 0.0], [2.0, 0.0]), &PlanarPose::new(x, y, 0.0), &config_of_tests()).unwrap();
            prop_assert!(track.remaining_m >= 2.0 - x - 0.03);
            prop_assert!(track.remaining_m <= 2.0 - x + y.abs() + 0.05);
        }
    }

    #[test]
    fn an_empty_path_has_no_track() {
        assert_eq!(
            Track::new(&Path::default(), &PlanarPose::default(), &config_of_tests()),
            None
        );
    }

    #[test]
    fn a_path_of_one_point_under_the_feet_asks_for_no_step() {
        let track = Track::new(
            &straight([0.0, 0.0], [0.0, 0.0]),
            &PlanarPose::default(),
            &config_of_tests(),
        )
        .unwrap();
        assert_eq!(
            track.velocity(0.1, &WalkingConfig::default()),
            Velocity::default()
        );
    }

    #[test]
    fn a_tight_place_is_walked_slowly() {
        let mut path = straight([0.0, 0.0], [2.0, 0.0]);
        let config = WalkingConfig::default();
        let speed = |path: &Path| {
            let track = Track::new(path, &PlanarPose::default(), &config_of_tests()).unwrap();
            track.velocity(f64::INFINITY, &config).x_mps
        };
        let open_mps = speed(&path);
        path.clearance_m.fill(0.12);
        assert!(speed(&path) < 0.7 * open_mps && speed(&path) > 0.02);
    }
}
