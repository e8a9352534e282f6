//! A robot with crooked odometry among posts.

use super::*;
use crate::OdometryLocalizerConfig;
use geometry::{Camera, Grid, Lattice, Pose, Robot};
use mapping::Surface;
use sensing::Intrinsics;
use testkit::state_at;

const POSTS_M: [[f64; 2]; 6] = [
    [1.3, 0.5],
    [1.5, -0.4],
    [2.3, 0.2],
    [2.9, -0.6],
    [3.2, 0.6],
    [3.8, 0.0],
];
const RADIUS_M: f64 = 0.06;
const EYE_M: f64 = 0.5;

fn view() -> FloorView {
    let lattice = Lattice {
        origin_m: [-2.0, -2.0],
        cell_m: 0.04,
    };
    FloorView::new(lattice, Grid::filled(200, 100, Surface::Floor(0.0)), 1)
}

/// The picture of posts from a true pose, by a camera that is turned to the right: each pixel's point in the robot's frame.
fn seen(pose: &PlanarPose, turned_rad: f64) -> Planes {
    let camera = Intrinsics {
        width: 160,
        height: 40,
        focal_px: 150.0,
        baseline_m: 0.05,
    };
    let mut points = Vec::new();
    for row in 0..camera.height {
        for col in 0..camera.width {
            let bearing = libm::atan2(0.5 * camera.width as f64 - col as f64 - 0.5, 150.0);
            let (sin, cos) = libm::sincos(pose.yaw_rad + bearing - turned_rad);
            let hit = |post: &[f64; 2]| {
                let (x, y) = (post[0] - pose.x_m, post[1] - pose.y_m);
                let (along, across) = (cos * x + sin * y, cos * y - sin * x);
                let half = RADIUS_M * RADIUS_M - across * across;
                (half > 0.0 && along > 0.0).then(|| along - half.sqrt())
            };
            let range = POSTS_M.iter().filter_map(hit).fold(f64::NAN, f64::min);
            let (sin, cos) = libm::sincos(bearing);
            let height = 0.08 + 0.01 * row as f64;
            points.push([range * cos, range * sin, height].map(|part| part as f32));
        }
    }
    let mut planes = Planes::of_points(points, Pose::<Robot, Camera>::identity());
    planes.robot_from_camera.inner.translation.vector.z = EYE_M;
    planes.camera = Some(camera);
    planes
}

/// Walks ahead by an odometry whose way bends, 1/m, with a camera that is turned to the right, rad; returns the localizer, and how far off it
/// and odometry alone are in the end, m.
fn walk(
    config: FastSlamLocalizerConfig,
    posts: bool,
    [bend, turned_rad]: [f64; 2],
) -> (FastSlamLocalizer, [f64; 2]) {
    let odometry =
        || OdometryLocalizer::new(Pose::identity(), 0.08, OdometryLocalizerConfig::default());
    let start = PlanarPose::new(0.0, 0.0, 0.0);
    let mut localizer = FastSlamLocalizer::new(odometry().unwrap(), &start, config).unwrap();
    let mut alone = odometry().unwrap();
    let view = view();
    let mut off = [0.0; 2];
    for step in 0..100 {
        let way = 0.02 * f64::from(step);
        let truth = PlanarPose::new(way, 0.0, 0.0);
        let mut body = state_at(100_000_000 * step as u64);
        body.odometry_from_robot = Pose::from_yaw(way, 0.5 * bend * way * way, 0.0, bend * way);
        let planes = if posts {
            seen(&truth, turned_rad)
        } else {
            Planes::new(10)
        };
        localizer.correct(&body, &planes, &view).unwrap();
        alone.correct(&body, &planes, &view).unwrap();
        let away = |estimate: Estimate| {
            let place = estimate.map_from_robot.origin().inner;
            geometry::hypot(place.x - truth.x_m, place.y - truth.y_m)
        };
        off = [
            away(localizer.estimate(&body).unwrap()),
            away(alone.estimate(&body).unwrap()),
        ];
    }
    (localizer, off)
}

#[test]
fn posts_keep_the_way_straight_where_odometry_bends_it() {
    let config = FastSlamLocalizerConfig {
        heading_noise: [0.04, 0.01, 0.0005],
        camera_yaw: 0.0,
        apart: [0.1, 0.1],
        ..FastSlamLocalizerConfig::default()
    };
    let (_, [with_posts_m, alone_m]) = walk(config, true, [0.04, 0.0]);
    assert!(alone_m > 0.06, "{alone_m}");
    assert!(with_posts_m < 0.5 * alone_m, "{with_posts_m} of {alone_m}");
}

#[test]
fn a_camera_that_is_turned_on_its_head_is_found_and_does_not_bend_the_way() {
    let config = FastSlamLocalizerConfig {
        camera_yaw: 0.04,
        apart: [0.1, 0.1],
        ..FastSlamLocalizerConfig::default()
    };
    let (localizer, [with_posts_m, _]) = walk(config, true, [0.0, 0.04]);
    let [found_rad, sd_rad] = localizer.slam.bearing_bias();
    assert!(
        (found_rad - 0.04).abs() < 3.0 * sd_rad.max(0.005),
        "{found_rad} {sd_rad}"
    );
    assert!(sd_rad < 0.02, "{sd_rad}");
    assert!(with_posts_m < 0.02, "{with_posts_m}");
}

#[test]
fn without_landmarks_it_is_odometry() {
    let config = FastSlamLocalizerConfig::default();
    let (_, [without_m, alone_m]) = walk(config, false, [0.04, 0.0]);
    assert!((without_m - alone_m).abs() < 0.01, "{without_m} {alone_m}");
}

#[test]
fn settings_that_contradict_each_other_are_refused() {
    let config = FastSlamLocalizerConfig {
        reach: [2.0, 1.0],
        ..FastSlamLocalizerConfig::default()
    };
    assert!(config.check().is_err());
}
