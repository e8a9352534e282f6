//! The legs of a path that are walked sideways, as seen from the robot.

use geometry::{PlanarPose, angle_between};
use planning::{Path, Sidle};

use super::tuning::SidleTuning;

/// The robot on a leg sideways.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct OnLeg {
    /// What is left of it, m.
    pub(super) left_m: f64,
    /// The leg's direction, in the robot's frame.
    pub(super) along: [f64; 2],
    /// From the robot to the leg, square to it, in the robot's frame, m.
    pub(super) beside_m: [f64; 2],
    /// By how much its heading is to change, rad.
    pub(super) turn_rad: f64,
}

impl OnLeg {
    pub(super) fn new(path: &Path, sidle: &Sidle, pose: &PlanarPose) -> Option<Self> {
        let robot_from_map = pose.inverse();
        let in_robot = |point: usize| {
            let [x, y] = *path.points_m.get(point)?;
            Some(robot_from_map.apply(x, y))
        };
        let ((x0, y0), (x1, y1)) = (in_robot(sidle.from_point)?, in_robot(sidle.to_point)?);
        let length_m = geometry::hypot(x1 - x0, y1 - y0);
        if length_m < 1e-6 {
            return None;
        }
        let along = [(x1 - x0) / length_m, (y1 - y0) / length_m];
        let left_m = x1 * along[0] + y1 * along[1];
        Some(Self {
            left_m,
            along,
            beside_m: [x1 - left_m * along[0], y1 - left_m * along[1]],
            turn_rad: angle_between(pose.yaw_rad, sidle.heading_rad),
        })
    }
}

/// The first leg sideways of a path that the robot has not come to the end of.
pub(super) fn next_sidle<'a>(
    path: &'a Path,
    pose: &PlanarPose,
    tuning: &SidleTuning,
) -> Option<&'a Sidle> {
    let over = |sidle: &&Sidle| {
        let on_leg = OnLeg::new(path, sidle, pose);
        sidle.from_point == 0 && on_leg.is_none_or(|on_leg| on_leg.left_m < tuning.done)
    };
    path.sidles.iter().find(|sidle| !over(sidle))
}
