//! Two pictures against the way between them: who is whole is never blamed, and who was carried off, or whose camera was turned, is told.

use geometry::{Camera, Odometry, Pose, Robot};
use nalgebra::{Isometry3, Translation3, UnitQuaternion};
use proptest::prelude::*;
use sensing::{Scan, SceneWatch, SceneWatchConfig};
use testkit::synthetic::{Block, Noise, Scene, camera_pose};

const PERIOD_NS: u64 = 80_000_000;
const TILT_RAD: f64 = 0.55;

/// A course with things on both sides, and the robot in it.
struct Trial {
    scene: Scene,
    watch: SceneWatch,
    noise: Noise,
    pictures: u64,
    /// Where the robot truly is: x, y, heading.
    truth: [f64; 3],
    /// Where the legs have it.
    legs: [f64; 3],
    pan_rad: f64,
    /// How the camera hangs in the head, and by what its disparities are multiplied.
    hangs: UnitQuaternion<f64>,
    scale: f32,
    /// How far the torso is tilted.
    tilt_rad: f64,
}

fn post(x_m: f64, y_m: f64) -> Block {
    Block {
        low_m: [x_m - 0.1, y_m - 0.1, 0.0],
        high_m: [x_m + 0.1, y_m + 0.1, 0.5],
    }
}

impl Trial {
    /// On a course, or on open floor.
    fn new(blocks: &[Block], seed: u64) -> Self {
        Self {
            scene: Scene::with(blocks),
            watch: SceneWatch::new(SceneWatchConfig::default()),
            noise: Noise::new(seed),
            pictures: 0,
            truth: [0.0; 3],
            legs: [0.0; 3],
            pan_rad: 0.0,
            hangs: UnitQuaternion::identity(),
            scale: 1.0,
            tilt_rad: 0.0,
        }
    }

    /// The robot walks and turns, and looks.
    fn look(&mut self, ahead_m: f64, turn_rad: f64) {
        for pose in [&mut self.truth, &mut self.legs] {
            let (sin, cos) = libm::sincos(pose[2]);
            pose[0] += ahead_m * cos;
            pose[1] += ahead_m * sin;
            pose[2] += turn_rad;
        }
        let robot_from_camera = camera_pose(self.pan_rad, TILT_RAD);
        let hangs: Pose<Camera, Camera> =
            Pose::wrap(Isometry3::from_parts(Translation3::identity(), self.hangs));
        let odometry_from_robot =
            |[x, y, yaw]: [f64; 3]| Pose::<Odometry, Robot>::from_yaw(x, y, 0.0, yaw);
        let truth: Pose<Robot, Camera> =
            Pose::wrap((odometry_from_robot(self.truth) * (robot_from_camera * hangs)).inner);
        let mut scan: Scan = self
            .scene
            .scan(&truth, robot_from_camera, 0.11, &mut self.noise);
        for disparity_px in &mut scan.disparity_px {
            *disparity_px *= self.scale;
        }
        scan.exposure_ns = self.pictures * PERIOD_NS;
        self.pictures += 1;
        self.watch
            .look(&scan, &odometry_from_robot(self.legs), self.tilt_rad);
    }

    fn look_often(&mut self, times: u32) {
        for _ in 0..times {
            self.look(0.01, 0.02);
        }
    }

    /// Whether nothing is so near that a robot would touch it.
    fn has_room(&self) -> bool {
        self.scene.blocks.iter().all(|block| {
            let middle = |axis: usize| 0.5 * (block.low_m[axis] + block.high_m[axis]);
            geometry::hypot(middle(0) - self.truth[0], middle(1) - self.truth[1]) > 0.4
        })
    }

    fn told(&self) -> [bool; 2] {
        [self.watch.carried(), self.watch.turned()].map(|fault| fault.is_some())
    }
}

fn slalom() -> [Block; 4] {
    [
        post(1.0, 0.3),
        post(1.2, -0.4),
        post(0.6, -1.2),
        post(-0.5, 1.0),
    ]
}

proptest! {
    #[test]
    fn a_robot_that_walks_turns_and_looks_around_is_never_blamed(
        seed in 0..1000u64,
        ways in prop::collection::vec((0.0..0.03f64, -0.06..0.06f64, -0.06..0.06f64), 2..6),
    ) {
        let mut trial = Trial::new(&slalom(), seed);
        trial.look_often(15);
        for (ahead_m, turn_rad, pan_rad) in ways {
            for _ in 0..8 {
                trial.pan_rad += pan_rad;
                trial.look(if trial.has_room() { ahead_m } else { 0.0 }, turn_rad);
            }
        }
        prop_assert_eq!(trial.told(), [false, false]);
    }

    #[test]
    fn a_camera_that_is_turned_or_measures_otherwise_is_told(
        seed in 0..1000u64,
        degrees in 2.5..6.0f64,
        up in any::<bool>(),
        scaled in any::<bool>(),
    ) {
        let mut trial = Trial::new(&slalom(), seed);
        trial.look_often(15);
        prop_assert_eq!(trial.told(), [false, false]);
        let sign = if up { 1.0 } else { -1.0 };
        if scaled {
            trial.scale = (1.0 + sign * 0.01 * (degrees + 3.0)) as f32;
        } else {
            trial.hangs = UnitQuaternion::from_euler_angles(sign * degrees.to_radians(), 0.0, 0.0);
        }
        trial.look_often(3);
        prop_assert_eq!(trial.told(), [false, true]);
    }
}

#[test]
fn a_robot_that_is_put_among_other_things_was_carried_off() {
    let mut trial = Trial::new(&slalom(), 1);
    trial.look_often(15);
    trial.truth = [0.3, -0.9, -0.3];
    trial.look_often(2);
    assert_eq!(trial.told(), [false, false]);
    trial.look_often(1);
    assert_eq!(trial.told(), [true, false]);
}

#[test]
fn what_comes_or_goes_is_nobodys_fault() {
    let mut trial = Trial::new(&[post(1.0, 0.3)], 2);
    trial.look_often(15);
    for blocks in [
        vec![],
        vec![post(0.8, 0.0)],
        vec![post(0.8, 0.0), post(0.9, 0.5)],
        vec![post(0.9, 0.5)],
        vec![],
    ] {
        trial.scene = Scene::with(&blocks);
        trial.look_often(6);
        assert_eq!(trial.told(), [false, false], "{blocks:?}");
    }
}

#[test]
fn of_a_robot_that_stumbles_and_stands_again_nothing_is_claimed() {
    let tilted_by = |tilt_rad: f64| {
        let mut trial = Trial::new(&slalom(), 3);
        trial.look_often(20);
        (trial.tilt_rad, trial.hangs) =
            (tilt_rad, UnitQuaternion::from_euler_angles(0.05, 0.0, 0.0));
        trial.look_often(5);
        (trial.tilt_rad, trial.hangs) = (0.0, UnitQuaternion::identity());
        trial.look_often(20);
        trial.told()
    };
    assert_eq!(tilted_by(0.3), [false, false]);
    assert_eq!(tilted_by(0.0), [false, true]);
}

#[test]
fn after_a_time_without_pictures_nothing_is_claimed() {
    let mut trial = Trial::new(&slalom(), 3);
    trial.look_often(15);
    trial.pictures += 10;
    trial.truth = [0.3, -0.9, -0.3];
    trial.look_often(10);
    assert_eq!(trial.told(), [false, false]);
}
