//! How points are carried to the map, and which of them tell of what.

use super::*;
use geometry::Camera;
use proptest::prelude::*;

fn reading(snap: bool, max_range_m: f64) -> Reading {
    Reading {
        snap_stretch: snap.then_some(2.0),
        max_range_m,
        sure_range_m: 1.2,
        delta_m: 0.028,
        rough: 1.6,
    }
}

fn planes(point: [f32; 3], height: f32) -> Planes {
    let mut planes = Planes::new(1);
    planes.robot_from_camera = Pose::<Robot, Camera>::from_yaw(0.0, 0.0, 0.5, 0.0);
    planes.points_in_robot_m[0] = point;
    planes.floor_height_m[0] = height;
    planes
}

proptest! {
    #[test]
    fn points_are_turned_then_moved_and_invalid_stays_invalid(
        x in -2.0..2.0f32, y in -2.0..2.0f32, z in -0.2..0.4f32, pose in prop::array::uniform4(-1.0..1.0f64),
    ) {
        let [px, py, pz, yaw] = pose;
        let map_from_robot = Pose::from_yaw(px, py, pz, yaw);
        let mut frame = LabelledFrame::default();
        frame.read(&planes([x, y, z], f32::NAN), &map_from_robot, reading(true, 10.0));
        let (sin, cos) = libm::sincos(yaw);
        let (x, y, z) = (f64::from(x), f64::from(y), f64::from(z));
        let expected = [cos * x - sin * y + px, sin * x + cos * y + py, z + pz];
        for (found, wanted) in frame.points[0].position_m.iter().zip(expected) {
            prop_assert!((found - wanted).abs() < 1e-12);
        }
        prop_assert!(frame.points[0].floor_height_m.is_nan());
        frame.read(&planes([1.0, 0.0, 0.0], 0.25), &map_from_robot, reading(false, 10.0));
        prop_assert!((frame.points[0].floor_height_m - (0.25 + pz)).abs() < 1e-12);
    }
}

#[test]
fn a_snapped_point_lies_on_its_plane_and_on_its_ray() {
    let mut frame = LabelledFrame::default();
    frame.read(
        &planes([0.5, 0.0, 0.02], 0.0),
        &Pose::identity(),
        reading(true, 10.0),
    );
    let [x, _, z] = frame.points[0].position_m;
    assert!(z.abs() < 1e-9, "{z}");
    assert!((x / 0.5 - 0.5 / 0.48).abs() < 1e-6, "{x}");
}

#[test]
fn what_is_too_far_only_clears() {
    let mut frame = LabelledFrame::default();
    frame.read(
        &planes([6.0, 0.0, 0.5], 0.5),
        &Pose::identity(),
        reading(true, 2.0),
    );
    let point = frame.points[0];
    assert!(!point.hit && point.floor_height_m.is_nan());
    assert!((point.position_m[0] - 2.0).abs() < 1e-12);
}

#[test]
fn points_not_seen_or_at_a_step_are_left_out() {
    let mut frame = LabelledFrame::default();
    let mut at_step = planes([0.5, 0.0, 0.0], 0.0);
    at_step.at_step[0] = true;
    frame.read(&at_step, &Pose::identity(), reading(true, 2.0));
    assert!(frame.points.is_empty());
    frame.read(
        &planes([f32::NAN; 3], 0.0),
        &Pose::identity(),
        reading(true, 2.0),
    );
    assert!(frame.points.is_empty());
}

#[test]
fn what_may_as_well_be_floor_far_away_is_no_hit() {
    let hit = |point: [f32; 3], height: f32| {
        let mut frame = LabelledFrame::default();
        frame.read(
            &planes(point, height),
            &Pose::from_yaw(0.0, 0.0, 0.1, 0.0),
            reading(true, 4.0),
        );
        frame.points[0].hit
    };
    assert!(
        !hit([1.5, 0.0, 0.02], f32::NAN),
        "far, level with the robot"
    );
    assert!(!hit([1.5, 0.0, -0.1], f32::NAN), "far, lower");
    assert!(hit([1.5, 0.0, 0.04], f32::NAN), "far, and stands out");
    assert!(hit([1.5, 0.0, 0.0], 0.0), "far, a floor");
    assert!(hit([0.8, 0.0, 0.02], f32::NAN), "near");
}
