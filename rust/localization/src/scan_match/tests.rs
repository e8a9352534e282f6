//! The localizer as a whole: a room of upright surfaces, drawn into frames as a camera would see them.

use geometry::{Camera, Grid, Lattice, Map, Pose, Robot, wrap_angle};
use mapping::{FloorView, Surface};
use nalgebra::{
    Isometry3, Matrix3, Rotation2, Rotation3, Translation3, UnitQuaternion, Vector2, Vector3,
};
use proptest::prelude::*;
use segmentation::Planes;
use sensing::Intrinsics;

use super::*;
use crate::odometry::OdometryLocalizerConfig;
use testkit::state_at;

const FRAME_NS: u64 = 80_000_000;
const EYE_M: Vector3<f64> = Vector3::new(0.04, 0.0, 0.46);
const CAMERA: Intrinsics = Intrinsics {
    width: 88,
    height: 72,
    focal_px: 101.0,
    baseline_m: 0.06,
};

/// A wall from one place to another, map frame.
type Side = [[f64; 2]; 2];

const CORNER: [Side; 2] = [[[0.7, -2.0], [0.7, 0.15]], [[0.7, 0.15], [-2.0, 0.15]]];
const BEFORE_IT: [f64; 3] = [0.0, 0.0, 0.0];
const ONE_WALL: [Side; 1] = [[[0.6, -9.0], [0.6, 9.0]]];

fn nothing_known() -> FloorView {
    FloorView::new(
        Lattice {
            origin_m: [-2.0, -2.0],
            cell_m: 0.04,
        },
        Grid::filled(100, 100, Surface::Unknown),
        0,
    )
}

/// How far the first wall is along a ray of the map, m.
fn first_wall_m(sides: &[Side], from: Vector2<f64>, ahead: Vector2<f64>) -> Option<f64> {
    sides
        .iter()
        .filter_map(|[begin, end]| {
            let (begin, end) = (Vector2::from(*begin), Vector2::from(*end));
            let along = end - begin;
            let scale = ahead.perp(&along);
            let (to, share) = (
                (begin - from).perp(&along) / scale,
                (begin - from).perp(&ahead) / scale,
            );
            (to > 0.0 && (0.0..=1.0).contains(&share)).then_some(to)
        })
        .min_by(f64::total_cmp)
}

/// Noise of a disparity, px, the same for the same numbers.
fn noise_px(frame: u64, pixel: usize) -> f64 {
    let mut bits = frame.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ (pixel as u64) << 20;
    let mut sum = 0.0;
    for _ in 0..4 {
        bits ^= bits >> 31;
        bits = bits.wrapping_mul(0xD6E8_FEB8_6659_FD93);
        sum += (bits >> 11) as f64 / (1_u64 << 53) as f64 - 0.5;
    }
    0.2 * sum
}

/// What the camera sees of the walls from a true pose: the pixels of which the rays meet one above the floor.
fn frame(sides: &[Side], world_from_robot: &Pose<Map, Robot>, number: u64) -> Planes {
    let mut planes = Planes::new(CAMERA.width * CAMERA.height);
    let tilt = Rotation3::from_axis_angle(&Vector3::y_axis(), 0.45);
    let axes = Rotation3::from_matrix_unchecked(Matrix3::new(
        0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0,
    ));
    let robot_from_camera: Pose<Robot, Camera> = Pose::wrap(Isometry3::from_parts(
        Translation3::from(EYE_M),
        UnitQuaternion::from_rotation_matrix(&(tilt * axes)),
    ));
    let eye = (world_from_robot.inner * nalgebra::Point3::from(EYE_M)).xy();
    for (pixel, point) in planes.points_in_robot_m.iter_mut().enumerate() {
        let (col, row) = (pixel % CAMERA.width, pixel / CAMERA.width);
        let ray = Vector3::new(col as f64 - 43.5, row as f64 - 35.5, CAMERA.focal_px);
        let in_robot = robot_from_camera.inner.rotation * (ray / CAMERA.focal_px);
        let ahead = world_from_robot.inner.rotation * in_robot;
        let Some(depth_m) = first_wall_m(sides, eye.coords, ahead.xy()) else {
            continue;
        };
        let scale = CAMERA.focal_px * CAMERA.baseline_m;
        let seen_m = scale / (scale / depth_m + noise_px(number, pixel));
        let place = EYE_M + in_robot * seen_m;
        if place.z > 0.0 && place.z < 0.6 {
            *point = [place.x as f32, place.y as f32, place.z as f32];
        }
    }
    planes.robot_from_camera = robot_from_camera;
    planes.camera = Some(CAMERA);
    planes.reliable = true;
    planes
}

/// A robot whose odometry turns by `drift_radps` that are not true, and its localizer.
struct Drive {
    localizer: MatchingLocalizer,
    sides: Vec<Side>,
    number: u64,
    error_rad: f64,
    drift_radps: f64,
    /// True place and that of odometry, m.
    places_m: [Vector2<f64>; 2],
    /// About the vertical, of the torso: not at rest while it is large.
    rate_radps: f64,
}

fn odometry(start: Pose<Map, Robot>) -> OdometryLocalizer {
    OdometryLocalizer::new(start, 0.08, OdometryLocalizerConfig::default()).unwrap()
}

fn matching(start: Pose<Map, Robot>) -> MatchingLocalizer {
    let senses = ProprioceptionConfig::default();
    MatchingLocalizer::new(odometry(start), senses, MatchingConfig::default()).unwrap()
}

impl Drive {
    fn new(sides: &[Side], drift_radps: f64) -> Self {
        Self {
            localizer: matching(Pose::identity()),
            sides: sides.to_vec(),
            number: 0,
            error_rad: 0.0,
            drift_radps,
            places_m: [Vector2::zeros(); 2],
            rate_radps: 1.0,
        }
    }

    /// Sees a frame from a true pose; returns the estimate.
    fn see(&mut self, [x_m, y_m, yaw_rad]: [f64; 3]) -> Pose<Map, Robot> {
        let true_pose = Pose::from_yaw(x_m, y_m, 0.0, yaw_rad);
        let planes = frame(&self.sides, &true_pose, self.number);
        let mut body = state_at(self.number * FRAME_NS);
        body.angular_velocity_radps.z = self.rate_radps;
        let [place_m, odometry_m] = &mut self.places_m;
        *odometry_m += Rotation2::new(self.error_rad) * (Vector2::new(x_m, y_m) - *place_m);
        *place_m = Vector2::new(x_m, y_m);
        body.odometry_from_robot =
            Pose::from_yaw(odometry_m.x, odometry_m.y, 0.0, yaw_rad + self.error_rad);
        self.localizer
            .correct(&body, &planes, &nothing_known())
            .unwrap();
        self.number += 1;
        self.error_rad += self.drift_radps * FRAME_NS as f64 * 1e-9;
        self.localizer.estimate(&body).unwrap().map_from_robot
    }

    /// Stands for a time, s; returns the largest errors of the heading, rad, and of the place, m.
    fn stand(&mut self, pose: [f64; 3], time_s: f64) -> (f64, f64) {
        let frames = (time_s / (FRAME_NS as f64 * 1e-9)) as usize;
        let mut worst = (0.0_f64, 0.0_f64);
        for _ in 0..frames {
            let estimate = self.see(pose);
            let place = estimate.origin().inner;
            worst.0 = worst.0.max(wrap_angle(estimate.yaw_rad() - pose[2]).abs());
            worst.1 = worst
                .1
                .max(geometry::hypot(place.x - pose[0], place.y - pose[1]));
        }
        worst
    }
}

#[test]
fn standing_before_a_corner_the_pose_does_not_creep() {
    let (heading_rad, place_m) = Drive::new(&CORNER, 0.0).stand(BEFORE_IT, 60.0);
    assert!(heading_rad < 0.004, "{heading_rad}");
    assert!(place_m < 1e-9, "{place_m}");
}

#[test]
fn standing_with_a_wrong_gyroscope_the_heading_stays() {
    // Without what is seen it would be 0.06 rad, and standing still proves nothing: the soles creep.
    for drift_radps in [-0.001, 0.001] {
        let (heading_rad, _) = Drive::new(&CORNER, drift_radps).stand(BEFORE_IT, 60.0);
        assert!(heading_rad < 0.02, "{heading_rad}");
    }
}

#[test]
fn one_wall_is_enough_for_the_heading_and_moves_nothing() {
    let mut drive = Drive::new(&ONE_WALL, 0.001);
    let (heading_rad, _) = drive.stand(BEFORE_IT, 10.0);
    assert!(heading_rad < 0.02, "{heading_rad}");
    // Along it, with odometry that is right about the way.
    for step in 0..500 {
        let y_m = 0.002 * f64::from(step);
        let estimate = drive.see([0.0, y_m, 0.0]);
        let place = estimate.origin().inner;
        // No further off than that heading takes it over the way.
        assert!(geometry::hypot(place.x, place.y - y_m) < 0.02, "{place}");
        assert!(estimate.yaw_rad().abs() < 0.02, "{}", estimate.yaw_rad());
    }
}

#[test]
fn what_is_seen_again_after_a_turn_tells_the_drift_of_that_turn() {
    let mut drive = Drive::new(&CORNER, 0.001);
    let _ = drive.stand(BEFORE_IT, 5.0);
    drive.sides.clear();
    let (blind_rad, _) = drive.stand(BEFORE_IT, 30.0);
    drive.sides = CORNER.to_vec();
    let _ = drive.stand(BEFORE_IT, 5.0);
    let (after_rad, _) = drive.stand(BEFORE_IT, 1.0);
    drive.sides.clear();
    let (blind_again_rad, _) = drive.stand(BEFORE_IT, 30.0);
    assert!(after_rad < 0.012, "{after_rad}");
    // By now the bias is known: blind, it goes on well.
    assert!(
        blind_again_rad < 0.5 * blind_rad.max(0.03),
        "{blind_again_rad} after {blind_rad}"
    );
}

#[test]
fn a_wall_that_moves_is_not_followed() {
    let mut drive = Drive::new(&ONE_WALL, 0.0);
    let _ = drive.stand(BEFORE_IT, 4.0);
    // Opens like a door, by 3 degrees a second for two seconds, and stays.
    let mut worst_rad = 0.0_f64;
    for step in 0..100 {
        let angle_rad = (0.0042 * f64::from(step)).min(0.105);
        let (sin, cos) = libm::sincos(angle_rad);
        let hinge = Vector2::new(0.6, -0.4);
        let [begin, end] = [-9.0, 9.0].map(|s| (hinge + Vector2::new(-sin, cos) * s).into());
        drive.sides = vec![[begin, end]];
        worst_rad = worst_rad.max(drive.see([0.0, 0.0, 0.0]).yaw_rad().abs());
    }
    assert!(worst_rad < 0.03, "{worst_rad}");
}

#[test]
fn empty_or_broken_frames_change_nothing() {
    let pose = Pose::from_yaw(0.3, -0.2, 0.0, 0.5);
    let mut plain = odometry(pose);
    let mut drive = Drive::new(&[], 0.0);
    drive.localizer = matching(pose);
    let mut broken = frame(&CORNER, &Pose::identity(), 1);
    for (index, point) in broken.points_in_robot_m.iter_mut().enumerate() {
        point[index % 3] = [f32::NAN, f32::INFINITY][index % 2];
    }
    let mut unreliable = frame(&CORNER, &Pose::identity(), 1);
    unreliable.reliable = false;
    let mut cameraless = frame(&CORNER, &Pose::identity(), 1);
    cameraless.camera = None;
    for number in 0..200 {
        let body = state_at(number * FRAME_NS);
        for planes in [&broken, &unreliable, &cameraless, &Planes::new(0)] {
            drive
                .localizer
                .correct(&body, planes, &nothing_known())
                .unwrap();
        }
        let estimate = drive.localizer.estimate(&body).unwrap();
        assert_eq!(estimate, plain.estimate(&body).unwrap());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn a_known_turn_is_measured_whatever_was_guessed(turn in -0.05..0.05f64, x in -0.008..0.008f64, y in -0.008..0.008f64) {
        let config = MatchingConfig::default();
        let stand = |yaw_rad| Viewpoint {
            odometry_yaw_rad: yaw_rad,
            map_from_robot: PlanarPose::default(),
        };
        let mut keyframe = Keyframe::new(stand(0.0), &config);
        for number in 0..config.frames as u64 {
            let planes = frame(&CORNER, &Pose::identity(), number);
            keyframe.add(&profile::beams(&planes, &config), &stand(0.0));
        }
        let seen = frame(&CORNER, &Pose::from_yaw(x, y, 0.0, turn), 99);
        let beams = profile::beams(&seen, &config);
        let found = keyframe.compare(&beams, &stand(0.0), (0.0, 0.03 * 0.03), &config).unwrap();
        prop_assert!((found.beyond_rad - turn).abs() < 0.012, "{} for {turn}", found.beyond_rad);
        prop_assert!(found.in_place);
    }

    #[test]
    fn the_same_frames_give_the_same_bits(drift in -0.002..0.002f64) {
        let run = || {
            let mut drive = Drive::new(&CORNER, drift);
            (0..60).map(|step| drive.see([0.0, 0.0, 0.005 * f64::from(step)])).collect::<Vec<_>>()
        };
        prop_assert_eq!(run(), run());
    }
}
