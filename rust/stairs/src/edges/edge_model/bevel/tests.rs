//! A slope and a step in frames with the errors of block matching.

use geometry::Point;
use testkit::synthetic::{Block, CAMERA, Noise, Scene, camera_pose};

use super::*;

const TILT_RAD: f64 = 0.85;
const FRONT_M: f64 = 0.35;

/// Level ground up to the front, then a slope of this length in terraces of a millimetre, then level again.
fn scene(run_m: f64, rise_m: f64) -> Scene {
    let block = |from_m: f64, to_m: f64, top_m: f64| Block {
        low_m: [from_m, -0.9, -0.2],
        high_m: [to_m, 0.9, top_m],
    };
    let mut blocks = vec![
        block(-1.0, FRONT_M, 0.0),
        block(FRONT_M + run_m, 2.0, rise_m),
    ];
    let terraces = if run_m > 0.0 { 40 } else { 0 };
    blocks.extend((0..terraces).map(|i| {
        let at_m = |i: i32| FRONT_M + run_m * f64::from(i) / f64::from(terraces);
        let share = (f64::from(i) + 0.5) / f64::from(terraces);
        block(at_m(i), at_m(i + 1), share * rise_m)
    }));
    Scene {
        ground: false,
        blocks,
    }
}

/// What frames of a change of height say on the whole: by how much a slope is better, and its mean length, m.
fn told(run_m: f64, rise_m: f64) -> (f64, f64) {
    told_of(&scene(run_m, rise_m), FRONT_M + 0.5 * run_m, rise_m)
}

/// [`told`] of what changes its height by so much around a place, m.
fn told_of(scene: &Scene, middle_m: f64, rise_m: f64) -> (f64, f64) {
    let pose = camera_pose(0.0, TILT_RAD);
    let mut planes = Planes::new(CAMERA.width * CAMERA.height);
    planes.robot_from_camera = pose;
    let (mut model, tuning) = (BevelModel::default(), EdgeModelTuning::default());
    let (mut better, mut runs_m) = (0.0, 0.0);
    let frames = 6;
    for seed in 0..frames {
        let mut noise = Noise::new(seed);
        let scan = scene.scan(&pose, pose, 0.125, &mut noise);
        let at_m = middle_m + noise.within(0.02);
        let end = |left_m: f64| Point::new(at_m, left_m, rise_m);
        let guess = Edge {
            left: end(0.3),
            right: end(-0.3),
        };
        let seen = (&scan, &planes);
        let fitted = model
            .fit(seen, &guess, [0.0, rise_m], [0.17; 2], &tuning)
            .unwrap();
        better += fitted.better / f64::from(frames as u32);
        runs_m += fitted.run_m / f64::from(frames as u32);
    }
    (better, runs_m)
}

#[test]
fn short_slopes_of_5_to_14_degrees_are_told_from_steps_and_their_length_is() {
    for (length_m, degrees) in [
        (0.1, 10.0),
        (0.1, 11.3),
        (0.08, 14.0),
        (0.15, 8.0),
        (0.2, 5.0),
    ] {
        for sign in [1.0, -1.0] {
            let rise_m = sign * length_m * libm::tan(f64::to_radians(degrees));
            let (better, run_m) = told(length_m, rise_m);
            assert!(better > 3.0, "{length_m} {degrees} {sign}: {better}");
            assert!(
                (run_m - length_m).abs() < 0.3 * length_m,
                "{length_m} {degrees}: {run_m}"
            );
        }
    }
}

#[test]
fn steps_of_15_to_50_mm_are_no_slopes() {
    for rise_m in [0.015, 0.02, 0.03, 0.05, -0.015, -0.02, -0.03, -0.05] {
        let (better, _) = told(0.0, rise_m);
        assert!(better < 0.0, "{rise_m}: {better}");
    }
}

#[test]
fn two_steps_with_a_tread_of_12_cm_between_are_no_slope() {
    for rise_m in [0.05, 0.062, 0.07] {
        let mut flight = scene(0.0, 0.5 * rise_m);
        let top = Block {
            low_m: [FRONT_M + 0.12, -0.9, -0.2],
            high_m: [2.0, 0.9, rise_m],
        };
        flight.blocks.push(top);
        let (better, _) = told_of(&flight, FRONT_M + 0.06, rise_m);
        assert!(better < 0.5, "{rise_m}: {better}");
    }
}
