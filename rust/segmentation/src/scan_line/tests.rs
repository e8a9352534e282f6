//! What the segmenter must do as a whole, on synthetic scenes.

use nalgebra::{UnitQuaternion, Vector3};
use proptest::prelude::*;

use super::*;
use crate::synthetic::{Block, CAMERA, GROUND, NOTHING, Noise, Scene, camera_pose};

/// The sensor's noise, px.
const SIGMA: f64 = 0.125;

fn segmenter() -> ScanLine {
    ScanLine::new(ScanLineConfig::default(), CAMERA).unwrap()
}

fn planes() -> Planes {
    Planes::new(CAMERA.width * CAMERA.height)
}

/// A segmenter that has seen open floor and tracks the ground.
fn tracking(noise: &mut Noise) -> ScanLine {
    let mut segmenter = segmenter();
    let mut planes = planes();
    let pose = camera_pose(0.0, 0.75);
    for _ in 0..3 {
        let scan = Scene::floor().scan(&pose, pose, SIGMA, noise);
        segmenter.segment(&scan, &mut planes).unwrap();
        assert_eq!(planes.ground, Some(0));
    }
    segmenter
}

fn look(
    segmenter: &mut ScanLine,
    scene: &Scene,
    truth: &Pose<Robot, Camera>,
    noise: &mut Noise,
) -> Planes {
    let mut planes = planes();
    let scan = scene.scan(truth, *truth, SIGMA, noise);
    segmenter.segment(&scan, &mut planes).unwrap();
    planes
}

/// Angle between true and found vertical, rad, and error of the camera's height, m.
fn pose_error(planes: &Planes, truth: &Pose<Robot, Camera>) -> (f64, f64) {
    let found = planes.robot_from_camera.inner;
    let up = found.rotation * truth.inner.rotation.inverse() * Vector3::z();
    (
        up.xy().norm().asin(),
        found.translation.z - truth.inner.translation.z,
    )
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn wall(at_m: f64) -> Block {
    Block {
        low_m: [at_m, -2.0, 0.0],
        high_m: [at_m + 0.1, 2.0, 1.0],
    }
}

/// The true label that most pixels of region `index` have.
fn true_label(planes: &Planes, labels: &[u16], index: usize) -> u16 {
    let mut counts = [0; 64];
    for (&found, &label) in planes.labels.iter().zip(labels) {
        if usize::from(found) == index + 1 {
            counts[usize::from(label)] += 1;
        }
    }
    (0..64).max_by_key(|&label| counts[label]).unwrap() as u16
}

#[test]
fn open_floor_is_one_ground_and_the_camera_is_level_on_it() {
    let mut noise = Noise::new(1);
    let (mut tilts, mut heights) = (vec![], vec![]);
    for _ in 0..20 {
        let truth = camera_pose(noise.within(0.6), 0.75 + noise.within(0.15));
        let planes = look(&mut segmenter(), &Scene::floor(), &truth, &mut noise);
        assert_eq!(planes.ground, Some(0));
        assert!(planes.reliable);
        assert_eq!(planes.regions[0].floor_height_m, Some(0.0));
        let (tilt, height) = pose_error(&planes, &truth);
        tilts.push(tilt.to_degrees());
        heights.push(height);
    }
    assert!(tilts.iter().all(|&tilt| tilt < 0.8), "{tilts:?}");
    assert!(median(tilts) < 0.3);
    let bias = heights.iter().sum::<f64>() / 20.0;
    assert!(bias.abs() < 0.0012, "{bias}");
    assert!(
        heights.iter().all(|height| height.abs() < 0.006),
        "{heights:?}"
    );
}

#[test]
fn camera_errors_of_seven_degrees_and_ten_millimetres_are_put_right_in_one_frame() {
    let mut noise = Noise::new(2);
    let (mut tilts, mut heights) = (vec![], vec![]);
    for seed in 0..40 {
        let truth = camera_pose(noise.within(0.3), 0.75);
        let turn = Vector3::new(noise.within(0.122), 0.0, noise.within(0.122));
        let mut believed = truth;
        believed.inner.rotation *= UnitQuaternion::new(turn);
        believed.inner.translation.vector.z += noise.within(0.01);
        let scan = Scene::floor().scan(&truth, believed, SIGMA, &mut noise);
        let mut planes = planes();
        segmenter().segment(&scan, &mut planes).unwrap();
        assert!(planes.ground.is_some() && planes.reliable, "{seed}: {turn}");
        let (tilt, height) = pose_error(&planes, &truth);
        tilts.push(tilt.to_degrees());
        heights.push(height.abs());
    }
    assert!(tilts.iter().all(|&tilt| tilt < 0.9), "{tilts:?}");
    assert!(heights.iter().all(|&height| height < 0.006), "{heights:?}");
    assert!(median(tilts) < 0.3 && median(heights) < 0.002);
}

#[test]
fn the_ground_is_kept_while_the_head_turns_with_an_error_of_seven_degrees() {
    for (pitch, roll) in [(0.12, 0.1), (-0.12, 0.1), (0.1, -0.12), (-0.1, -0.12)] {
        let mut noise = Noise::new(3);
        let (mut segmenter, mut planes) = (segmenter(), planes());
        for frame in 0..50 {
            let pan = 0.9 * (f64::from(frame) * 0.15).sin();
            let truth = camera_pose(pan, 0.75 + 0.15 * (f64::from(frame) * 0.1).sin());
            let mut believed = truth;
            believed.inner.rotation *= UnitQuaternion::new(Vector3::new(pitch, 0.0, roll));
            let scan = Scene::floor().scan(&truth, believed, SIGMA, &mut noise);
            segmenter.segment(&scan, &mut planes).unwrap();
            assert!(planes.ground.is_some(), "frame {frame}");
            assert!(pose_error(&planes, &truth).0 < 0.02, "frame {frame}");
        }
    }
}

#[test]
fn stairs_of_thirty_millimetres_are_told_apart() {
    let mut noise = Noise::new(4);
    let (mut visible, mut correct, mut under) = (0, 0, 0);
    for front_m in [0.2, 0.25, 0.3, 0.35, 0.4] {
        for _ in 0..4 {
            let truth = camera_pose(0.0, 0.8);
            let scene = Scene::stairs(front_m, 0.03, 0.12, 4);
            let mut segmenter = tracking(&mut noise);
            let planes = look(&mut segmenter, &scene, &truth, &mut noise);
            let (_, labels) = scene.exact(&truth);
            let seen = |at: &usize| !planes.points_in_robot_m[*at][0].is_nan();
            let shared = |i: usize, surface: u16| {
                (0..labels.len())
                    .filter(|&at| labels[at] == surface && usize::from(planes.labels[at]) == i + 1)
                    .count()
            };
            // Risers of four rows lie within one matching window of both treads: they may go to either.
            let treads_of = |i: usize| (GROUND..10).step_by(2).map(|s| shared(i, s)).sum::<usize>();
            for surface in (GROUND..10).step_by(2) {
                let pixels: Vec<_> = (0..labels.len())
                    .filter(|&at| labels[at] == surface)
                    .filter(seen)
                    .collect();
                if pixels.len() > 100 {
                    visible += 1;
                    let hit = (0..planes.regions.len()).any(|i| {
                        let (both, all) = (shared(i, surface), treads_of(i));
                        5 * both >= 4 * pixels.len() && 5 * both >= 4 * all
                    });
                    correct += usize::from(hit);
                }
            }
            // A region that holds a good part of two surfaces' pixels was not cut where it should have been.
            for i in 0..planes.regions.len() {
                let parts = (GROUND..10)
                    .step_by(2)
                    .filter(|&surface| 5 * shared(i, surface) > treads_of(i))
                    .count();
                under += usize::from(parts > 1);
            }
        }
    }
    assert_eq!(under, 0);
    assert!(visible > 60);
    assert!(10 * correct >= 9 * visible, "{correct} of {visible}");
}

#[test]
fn a_step_is_never_taken_for_the_ground() {
    let mut noise = Noise::new(5);
    for front_m in [0.1, 0.15, 0.2, 0.3] {
        for rise_m in [0.025, 0.03, 0.04] {
            let scene = Scene::stairs(front_m, rise_m, 0.12, 4);
            let mut segmenter = tracking(&mut noise);
            for frame in 0..20 {
                let truth = camera_pose(0.0, 0.6 + 0.02 * f64::from(frame));
                let planes = look(&mut segmenter, &scene, &truth, &mut noise);
                let Some(ground) = planes.ground else {
                    continue;
                };
                let (_, labels) = scene.exact(&truth);
                assert_eq!(
                    true_label(&planes, &labels, ground),
                    GROUND,
                    "{front_m} {rise_m} frame {frame}"
                );
            }
        }
    }
}

#[test]
fn a_wall_is_no_floor() {
    let mut noise = Noise::new(6);
    let (mut seen, mut called_floor) = (0, 0);
    for at_m in [0.4, 0.5, 0.6, 0.8] {
        for pan in [-0.5, 0.0, 0.3] {
            let truth = camera_pose(pan, 0.7);
            let scene = Scene::with(&[wall(at_m)]);
            let planes = look(&mut tracking(&mut noise), &scene, &truth, &mut noise);
            for (at, point) in planes.points_in_robot_m.iter().enumerate() {
                // Close to the floor a wall cannot be told from it.
                if point[2] > 0.05 && point[0] > at_m as f32 - 0.05 {
                    seen += 1;
                    called_floor += usize::from(!planes.floor_height_m[at].is_nan());
                }
            }
        }
    }
    assert!(seen > 5000);
    assert!(
        f64::from(called_floor as u32) < 0.02 * f64::from(seen),
        "{called_floor} of {seen}"
    );
}

#[test]
fn a_wall_is_described_by_its_normal() {
    let mut noise = Noise::new(7);
    let truth = camera_pose(0.0, 0.6);
    let scene = Scene::with(&[wall(0.5)]);
    let planes = look(&mut tracking(&mut noise), &scene, &truth, &mut noise);
    let largest = planes
        .regions
        .iter()
        .filter(|region| region.floor_height_m.is_none())
        .max_by_key(|region| region.support)
        .unwrap();
    assert!(largest.support > 1000);
    assert!(largest.plane.normal.x < -0.995);
    assert!((largest.plane.distance_m + 0.5).abs() < 0.01);
    assert_eq!(largest.boundary, None);
}

#[test]
fn the_top_of_a_low_box_is_a_floor_of_its_own_height() {
    let mut noise = Noise::new(8);
    let truth = camera_pose(0.0, 0.75);
    let low = Block {
        low_m: [0.45, -0.15, 0.0],
        high_m: [0.65, 0.15, 0.06],
    };
    let mut errors = vec![];
    for _ in 0..20 {
        let planes = look(
            &mut tracking(&mut noise),
            &Scene::with(&[low]),
            &truth,
            &mut noise,
        );
        let (_, labels) = Scene::with(&[low]).exact(&truth);
        let top = (0..planes.regions.len())
            .find(|&i| true_label(&planes, &labels, i) == GROUND + 2)
            .unwrap();
        assert_ne!(planes.ground, Some(top));
        errors.push(planes.regions[top].floor_height_m.unwrap() - 0.06);
    }
    let bias = errors.iter().sum::<f64>() / 20.0;
    assert!(bias.abs() < 0.002, "{bias}");
    assert!(errors.iter().all(|error| error.abs() < 0.01), "{errors:?}");
}

#[test]
fn records_are_whole_planes_have_unit_normals_and_outlines_hold_their_points() {
    let mut noise = Noise::new(9);
    let truth = camera_pose(0.2, 0.75);
    let scene = Scene::stairs(0.3, 0.03, 0.12, 3);
    let planes = look(&mut tracking(&mut noise), &scene, &truth, &mut noise);
    let camera = planes.robot_from_camera.inner;
    assert!(planes.regions.len() > 2);
    for (i, region) in planes.regions.iter().enumerate() {
        assert!((region.plane.normal.norm() - 1.0).abs() < 1e-9);
        assert!(region.plane.signed_distance_m(&region.mean.inner).abs() < 1e-4);
        let pixels: Vec<_> = (0..planes.labels.len())
            .filter(|&at| usize::from(planes.labels[at]) == i + 1)
            .collect();
        assert_eq!(region.support, pixels.len());
        let (Some(outline), Some(height_m)) = (&region.boundary, region.floor_height_m) else {
            continue;
        };
        for at in pixels {
            let ray =
                camera.rotation * Vector3::from(CAMERA.ray(at % CAMERA.width, at / CAMERA.width));
            let depth = (height_m - camera.translation.z) / ray.z;
            let point = camera.translation.vector + ray * depth;
            let outside = outline
                .edges()
                .map(|(a, b)| -(b - a).normalize().perp(&(point.xy() - a.coords)))
                .fold(f64::MIN, f64::max);
            assert!(outside < 1e-4, "{outside}");
            assert_eq!(planes.floor_height_m[at], height_m as f32);
        }
    }
}

#[test]
fn nothing_seen_is_an_ordinary_product() {
    for value in [f32::NAN, 0.0, 3.0, 24.0, f32::INFINITY, -5.0] {
        let mut segmenter = segmenter();
        let mut planes = planes();
        let mut scan = Scan::new(CAMERA);
        scan.robot_from_camera = camera_pose(0.0, 0.75);
        scan.disparity_px.fill(value);
        segmenter.segment(&scan, &mut planes).unwrap();
        assert_eq!(planes.ground, None, "{value}");
        assert!(!planes.reliable, "{value}");
        let camera = planes.robot_from_camera.inner;
        assert!(camera.translation.vector.iter().all(|x| x.is_finite()));
    }
}

#[test]
fn a_scan_of_another_size_is_refused_and_changes_nothing() {
    let mut scan = Scan::new(CAMERA);
    let _ = scan.disparity_px.pop();
    let error = segmenter().segment(&scan, &mut planes()).unwrap_err();
    let (expected, found) = (88 * 72, 88 * 72 - 1);
    assert_eq!(error, SegmentError::WrongSize { expected, found });
}

#[test]
fn a_lost_ground_stays_reliable_for_a_while_and_is_found_again() {
    let mut noise = Noise::new(10);
    let mut segmenter = tracking(&mut noise);
    let config = ScanLineConfig::default();
    let truth = camera_pose(0.0, 0.3);
    let close = Scene::with(&[wall(0.2)]);
    for frame in 1..=config.forget_frames + 2 {
        let planes = look(&mut segmenter, &close, &truth, &mut noise);
        assert_eq!(planes.ground, None);
        assert_eq!(planes.reliable, frame <= config.hold_frames);
    }
    // Meanwhile the neck slipped by six degrees.
    let truth = camera_pose(0.0, 0.75);
    let believed = camera_pose(0.0, 0.65);
    let scan = Scene::floor().scan(&truth, believed, SIGMA, &mut noise);
    let mut planes = planes();
    segmenter.segment(&scan, &mut planes).unwrap();
    assert!(planes.ground.is_some());
    assert!(pose_error(&planes, &truth).0 < 0.02);
}

#[test]
fn thresholds_follow_the_noise() {
    let share = |noise_ceiling: f64| {
        let mut noise = Noise::new(11);
        let config = ScanLineConfig {
            noise_ceiling,
            ..ScanLineConfig::default()
        };
        let mut share = 0.0;
        for _ in 0..5 {
            let pose = camera_pose(0.0, 0.75);
            let scan = Scene::floor().scan(&pose, pose, 3.0 * SIGMA, &mut noise);
            let mut planes = planes();
            let mut segmenter = ScanLine::new(config.clone(), CAMERA).unwrap();
            segmenter.segment(&scan, &mut planes).unwrap();
            let largest = planes.regions.iter().map(|region| region.support).max();
            share += largest.unwrap_or(0) as f64 / scan.valid as f64 / 5.0;
        }
        share
    };
    let (adaptive, fixed) = (share(4.0), share(1.0));
    assert!(adaptive > 0.8, "{adaptive}");
    assert!(fixed < 0.6, "{fixed}");
}

#[test]
fn the_same_frames_give_the_same_products() {
    let run = || {
        let mut noise = Noise::new(12);
        let mut segmenter = tracking(&mut noise);
        let scene = Scene::stairs(0.3, 0.03, 0.12, 4);
        let truth = camera_pose(0.1, 0.75);
        let planes = look(&mut segmenter, &scene, &truth, &mut noise);
        (planes.regions, planes.labels, planes.robot_from_camera)
    };
    assert_eq!(run(), run());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]
    #[test]
    fn every_product_is_consistent_whatever_stands_around(
        blocks in prop::collection::vec(
            (0.25..1.2f64, -0.6..0.6f64, 0.05..0.4f64, 0.05..0.4f64, 0.01..0.5f64, 0.0..0.3f64), 0..4),
        pan in -0.6..0.6f64, tilt in 0.2..1.0f64, seed in 0..1000u64,
    ) {
        let blocks: Vec<_> = blocks.iter().map(|&(x, y, dx, dy, dz, base)| Block {
            low_m: [x, y, base],
            high_m: [x + dx, y + dy, base + dz],
        }).collect();
        let mut noise = Noise::new(seed);
        let truth = camera_pose(pan, tilt);
        let planes = look(&mut tracking(&mut noise), &Scene::with(&blocks), &truth, &mut noise);
        let (_, labels) = Scene::with(&blocks).exact(&truth);
        for (at, &label) in planes.labels.iter().enumerate() {
            let point = planes.points_in_robot_m[at];
            prop_assert!(usize::from(label) <= planes.regions.len());
            if label > 0 {
                let region = &planes.regions[usize::from(label) - 1];
                let height = planes.floor_height_m[at];
                prop_assert_eq!(region.floor_height_m.map(|h| h as f32), (!height.is_nan()).then_some(height));
                prop_assert!(!point[0].is_nan());
            } else {
                prop_assert!(planes.floor_height_m[at].is_nan());
            }
            if point[0].is_nan() {
                prop_assert_eq!(label, 0);
            }
        }
        if let Some(ground) = planes.ground {
            prop_assert_eq!(planes.regions[ground].floor_height_m, Some(0.0));
            prop_assert!(true_label(&planes, &labels, ground) != NOTHING);
            prop_assert!(pose_error(&planes, &truth).1.abs() < 0.02);
        }
    }
}
