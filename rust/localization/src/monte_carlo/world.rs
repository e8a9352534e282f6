//! Scenes of boxes for the tests: seen by a noisy depth camera, walked through by odometry that drifts.

use std::sync::Arc;

use geometry::{Camera, Grid, Lattice, PlanarPose, Pose, Robot};
use known_map::{KnownMap, StandingRoom};
use mapping::{FloorView, Surface};
use nalgebra::{Isometry3, Matrix3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};
use segmentation::Planes;
use sensing::Intrinsics;

use super::random::{Purpose, Stream};
use super::{MonteCarloConfig, MonteCarloLocalizer, StaticMap};
use crate::localizer::Localizer;
use proprioception::BodyState;
use testkit::state_at;

/// 58 by 45 degrees.
pub(super) const CAMERA: Intrinsics = Intrinsics {
    width: 80,
    height: 60,
    focal_px: 72.2,
    baseline_m: 0.075,
};
pub(super) const SIDE_M: f64 = 0.04;
const TORSO_M: f64 = 0.33;
pub(super) const FRAME_NS: u64 = 160_000_000;
/// Noise of a range at a metre, m; it grows with the square.
const NOISE_M: f64 = 0.005;

type Block = [[f64; 3]; 2];

/// Where the camera is in the robot's frame, truly and by the joints and the attitude.
pub(super) struct Eye {
    pub(super) truly: Isometry3<f64>,
    pub(super) believed: Isometry3<f64>,
}

impl Eye {
    /// Half a metre up, 30 degrees down.
    pub(super) fn ahead() -> Self {
        let axes = Matrix3::new(0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0);
        let tilt = Rotation3::from_axis_angle(&Vector3::y_axis(), 0.52);
        let turn = tilt * Rotation3::from_matrix_unchecked(axes);
        let truly = Isometry3::from_parts(
            Translation3::new(0.04, 0.0, 0.5),
            UnitQuaternion::from_rotation_matrix(&turn),
        );
        Self {
            truly,
            believed: truly,
        }
    }
}

/// Boxes, those that the map has and those that it has not.
#[derive(Default)]
pub(super) struct World {
    pub(super) mapped: Vec<Block>,
    pub(super) unmapped: Vec<Block>,
}

impl World {
    /// Walls about a floor, 1 m high, their inner faces on it.
    pub(super) fn walled(length_m: f64, width_m: f64) -> Self {
        let (l, w) = (length_m, width_m);
        let mapped = vec![
            [[-0.2, -0.2, -0.08], [l + 0.2, w + 0.2, 0.0]],
            [[-0.2, -0.2, 0.0], [0.0, w + 0.2, 1.0]],
            [[l, -0.2, 0.0], [l + 0.2, w + 0.2, 1.0]],
            [[0.0, -0.2, 0.0], [l, 0.0, 1.0]],
            [[0.0, w, 0.0], [l, w + 0.2, 1.0]],
        ];
        Self {
            mapped,
            unmapped: Vec::new(),
        }
    }

    /// 4 by 5 m with furniture, none of it where voxels begin.
    pub(super) fn room() -> Self {
        let mut world = Self::walled(4.01, 5.03);
        world.mapped.extend([
            [[2.21, 0.93, 0.0], [2.83, 1.42, 0.51]],
            [[2.03, 3.05, 0.0], [2.52, 3.63, 0.83]],
            [[0.0, 2.1, 0.0], [0.37, 2.9, 0.62]],
            [[3.1, 1.9, 0.3], [3.9, 2.7, 0.36]],
            [[1.7, 2.2, 0.0], [1.86, 2.36, 0.34]],
        ]);
        world
    }

    /// Two floors: below a room, above it on one half a deck with other things on it, 0.72 m up.
    pub(super) fn two_levels() -> Self {
        let mut world = Self::walled(4.0, 3.0);
        for wall in &mut world.mapped[1..] {
            wall[1][2] = 1.6;
        }
        world.mapped.extend([
            // The deck, its rail, and what stands on it.
            [[0.0, 0.0, 0.64], [1.8, 3.0, 0.72]],
            [[1.76, 0.0, 0.72], [1.8, 2.2, 1.0]],
            [[0.0, 0.0, 0.72], [0.5, 0.7, 1.3]],
            [[0.9, 2.6, 0.72], [1.4, 3.0, 1.1]],
            // Below.
            [[3.2, 0.4, 0.0], [3.7, 1.1, 0.5]],
            [[2.4, 2.3, 0.0], [2.7, 3.0, 0.9]],
            [[0.3, 1.2, 0.0], [0.4, 1.3, 0.64]],
            [[1.5, 0.2, 0.0], [1.62, 0.32, 0.64]],
        ]);
        world
    }

    pub(super) fn map(&self, config: &MonteCarloConfig) -> Arc<StaticMap> {
        let known = KnownMap::of_boxes(&self.mapped, SIDE_M).unwrap();
        let room = StandingRoom {
            radius_m: 0.1,
            height_m: 0.55,
        };
        Arc::new(StaticMap::new(&known, room, config).unwrap())
    }

    /// Distance along a ray, and whether its end is ground: the top of something that is no higher.
    fn meet(&self, from: &Vector3<f64>, along: &Vector3<f64>) -> Option<(f64, bool)> {
        let meet = |[low, high]: &Block| {
            let (mut enter, mut leave, mut axis) = (0.0_f64, f64::INFINITY, 3);
            for a in 0..3 {
                let (t0, t1) = (
                    (low[a] - from[a]) / along[a],
                    (high[a] - from[a]) / along[a],
                );
                if t0.min(t1) > enter {
                    (enter, axis) = (t0.min(t1), a);
                }
                leave = leave.min(t0.max(t1));
            }
            (enter < leave && axis < 3).then_some((enter, axis == 2 && high[2] < 0.01))
        };
        (self.mapped.iter().chain(&self.unmapped))
            .filter_map(meet)
            .min_by(|a, b| a.0.total_cmp(&b.0))
    }

    fn line_of_sight(robot: &Isometry3<f64>, eye: &Eye, pixel: usize) -> [Vector3<f64>; 2] {
        let world_from_camera = robot * eye.truly;
        let ray = Vector3::from(CAMERA.ray(pixel % CAMERA.width, pixel / CAMERA.width));
        let along = world_from_camera.rotation * ray.normalize();
        [world_from_camera.translation.vector, along]
    }

    /// Whether a pixel's line of sight ends on the ground.
    pub(super) fn meets_ground(&self, robot: &Isometry3<f64>, eye: &Eye, pixel: usize) -> bool {
        let [from, along] = Self::line_of_sight(robot, eye, pixel);
        self.meet(&from, &along).is_some_and(|(_, ground)| ground)
    }

    /// What the camera sees from a robot's frame, as a segmenter hands it on.
    pub(super) fn frame(&self, robot: &Isometry3<f64>, eye: &Eye, number: u64) -> Planes {
        let mut planes = Planes::new(CAMERA.width * CAMERA.height);
        for pixel in 0..planes.points_in_robot_m.len() {
            let [from, along] = Self::line_of_sight(robot, eye, pixel);
            let Some((range_m, _)) = self.meet(&from, &along) else {
                continue;
            };
            let [noise] = Stream::new(99, number, Purpose::Beams, pixel).normals();
            let seen_m = range_m + NOISE_M * range_m * range_m * noise;
            let ray = Vector3::from(CAMERA.ray(pixel % CAMERA.width, pixel / CAMERA.width));
            let point = eye.believed * Point3::from(ray.normalize() * seen_m);
            planes.points_in_robot_m[pixel] = [point.x as f32, point.y as f32, point.z as f32];
        }
        planes.robot_from_camera = Pose::<Robot, Camera>::wrap(eye.believed);
        planes.camera = Some(CAMERA);
        planes.reliable = true;
        planes
    }
}

/// A floor view that nobody reads.
pub(super) fn no_view() -> FloorView {
    FloorView::new(
        Lattice {
            origin_m: [0.0, 0.0],
            cell_m: 1.0,
        },
        Grid::filled(1, 1, Surface::Unknown),
        0,
    )
}

/// A walk: the truth, what odometry says of it, and a localizer that hears and sees.
pub(super) struct Walk<'a> {
    pub(super) world: &'a World,
    pub(super) localizer: MonteCarloLocalizer,
    pub(super) truth: PlanarPose,
    pub(super) level_m: f64,
    odometry: PlanarPose,
    /// By how much odometry takes a way for longer, and a turn for more, rad a frame.
    pub(super) drift: [f64; 2],
    seed: u64,
    number: u64,
}

impl<'a> Walk<'a> {
    pub(super) fn new(
        world: &'a World,
        localizer: MonteCarloLocalizer,
        truth: PlanarPose,
        level_m: f64,
    ) -> Self {
        Self {
            world,
            seed: localizer.config.seed,
            localizer,
            truth,
            level_m,
            odometry: PlanarPose::default(),
            drift: [1.08, 0.003],
            number: 0,
        }
    }

    /// Goes on by a step and sees a frame; odometry takes it for longer, turned, and noisy. Returns the errors of the estimate
    /// in the plane, m, in heading, rad, and in height, m.
    pub(super) fn step(&mut self, forward_m: f64, turn_rad: f64) -> [f64; 3] {
        self.number += 1;
        let mut stream = Stream::new(self.seed ^ 0x5EED, self.number, Purpose::Motion, 0);
        let noise = stream.normals::<6>();
        self.truth = self
            .truth
            .compose(&PlanarPose::new(forward_m, 0.0, turn_rad));
        self.odometry = self.odometry.compose(&PlanarPose::new(
            self.drift[0] * forward_m + 0.003 * noise[0],
            0.003 * noise[1],
            turn_rad + self.drift[1] + 0.004 * noise[2],
        ));
        let sway = |number: u64| 0.03 * libm::sin(0.9 * number as f64);
        let tilt = UnitQuaternion::from_euler_angles(sway(self.number), 0.05, 0.0);
        let measured = UnitQuaternion::from_euler_angles(
            sway(self.number) + 0.005 * noise[3],
            0.05 + 0.005 * noise[4],
            0.0,
        );
        let rest = Translation3::new(0.0, 0.0, TORSO_M);
        let level = Eye::ahead().truly;
        let torso_from_camera = Translation3::new(0.0, 0.0, -TORSO_M) * level;
        let eye = Eye {
            truly: rest * tilt * torso_from_camera,
            believed: rest * measured * torso_from_camera,
        };
        let PlanarPose { x_m, y_m, yaw_rad } = self.truth;
        let robot = Pose::<geometry::World, Robot>::from_yaw(x_m, y_m, self.level_m, yaw_rad).inner;
        let planes = self
            .world
            .frame(&robot, &eye, self.seed << 32 | self.number);
        let body = self.body(&(rest * measured));
        self.localizer.correct(&body, &planes, &no_view()).unwrap();
        let estimate = self.localizer.estimate(&body).unwrap().map_from_robot;
        let at = estimate.origin().inner;
        [
            geometry::hypot(at.x - x_m, at.y - y_m),
            geometry::wrap_angle(estimate.yaw_rad() - yaw_rad).abs(),
            (at.z - self.level_m).abs(),
        ]
    }

    fn body(&self, robot_from_torso: &Isometry3<f64>) -> BodyState {
        let mut body = state_at(self.number * FRAME_NS);
        let PlanarPose { x_m, y_m, yaw_rad } = self.odometry;
        body.odometry_from_robot = Pose::from_yaw(x_m, y_m, 0.0, yaw_rad);
        body.robot_from_torso = Pose::wrap(*robot_from_torso);
        let torso = body.odometry_from_robot * body.robot_from_torso;
        body.odometry_from_torso_rotation = torso.inner.rotation;
        body
    }

    /// Where odometry alone would have the robot, against the truth, m.
    pub(super) fn odometry_error_m(&self, start: &PlanarPose) -> f64 {
        start.compose(&self.odometry).distance_m(&self.truth)
    }
}
