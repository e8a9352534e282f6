//! The ground: found, kept, lost, and never a step; the camera levelled by it.

use super::*;

#[test]
fn open_floor_is_one_ground_and_the_camera_is_level_on_it() {
    let mut noise = Noise::new(1);
    let (mut tilts, mut heights) = (vec![], vec![]);
    for _ in 0..20 {
        let truth = camera_pose(noise.within(0.6), 0.75 + noise.within(0.15));
        let planes = look(&mut segmenter(), &Scene::floor(), &truth, &mut noise);
        assert_eq!(planes.ground, Some(0));
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
        let believed = turned(&truth, &turn, noise.within(0.01));
        let scan = Scene::floor().scan(&truth, believed, SIGMA, &mut noise);
        let mut planes = planes();
        segmenter().segment(&scan, &mut planes).unwrap();
        assert!(planes.ground.is_some(), "{seed}: {turn}");
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
            let pan = 0.9 * libm::sin(f64::from(frame) * 0.15);
            let truth = camera_pose(pan, 0.75 + 0.15 * libm::sin(f64::from(frame) * 0.1));
            let believed = turned(&truth, &Vector3::new(pitch, 0.0, roll), 0.0);
            let scan = Scene::floor().scan(&truth, believed, SIGMA, &mut noise);
            segmenter.segment(&scan, &mut planes).unwrap();
            assert!(planes.ground.is_some(), "frame {frame}");
            assert!(pose_error(&planes, &truth).0 < 0.02, "frame {frame}");
        }
    }
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
fn heights_are_trusted_once_the_ground_was_seen_for_eight_frames() {
    let mut noise = Noise::new(13);
    let (mut segmenter, pose) = (segmenter(), camera_pose(0.0, 0.75));
    for frame in 1..12 {
        let planes = look(&mut segmenter, &Scene::floor(), &pose, &mut noise);
        assert!(planes.ground.is_some());
        assert_eq!(planes.reliable, frame >= 8);
    }
}

#[test]
fn a_lost_ground_stays_reliable_for_a_while_and_is_found_again() {
    let mut noise = Noise::new(10);
    let mut segmenter = tracking(&mut noise);
    let config = GroundConfig::default();
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

/// The first finds come while the attitude still settles, and all of them may err alike.
#[test]
fn a_track_that_began_wrong_is_put_right() {
    for (pitch, roll) in [(0.0, 0.034), (0.0, -0.034), (0.034, 0.0), (-0.034, 0.0)] {
        let mut noise = Noise::new(6);
        let (mut segmenter, mut planes) = (segmenter(), planes());
        let truth = camera_pose(0.0, 0.68);
        for frame in 0..40 {
            let turn = Vector3::new(pitch, 0.0, roll) * if frame < 8 { 0.0 } else { 1.0 };
            let believed = turned(&truth, &turn, 0.0);
            let scan = Scene::floor().scan(&truth, believed, SIGMA, &mut noise);
            segmenter.segment(&scan, &mut planes).unwrap();
        }
        let (tilt, _) = pose_error(&planes, &truth);
        assert!(tilt < 0.008, "{pitch} {roll}: {tilt}");
    }
}

/// A platform from behind the robot up to `front_m`, and low steps from there on.
fn low_steps(front_m: f64, rise_m: f64, tread_m: f64) -> Scene {
    let block = |i: i32| {
        let front = front_m + f64::from(i - 1) * tread_m;
        Block {
            low_m: [if i == 0 { -1.0 } else { front }, -0.6, -0.5],
            high_m: [
                if i == 5 { 2.5 } else { front + tread_m },
                0.6,
                f64::from(i) * rise_m,
            ],
        }
    };
    Scene {
        ground: false,
        blocks: (0..=5).map(block).collect(),
    }
}

/// With the camera this much too high by the joints the first step lies farther from where they have the ground than it can.
#[test]
fn a_ground_that_the_joints_misplace_is_found_at_first_sight_before_low_stairs() {
    for (raised_m, rise_m) in [(0.012, 0.016), (0.012, 0.022), (0.016, 0.02)] {
        let mut noise = Noise::new(11);
        let scene = low_steps(0.7, rise_m, 0.18);
        let truth = camera_pose(0.0, 0.85);
        let believed = turned(&truth, &Vector3::zeros(), raised_m);
        let mut found = 0;
        for _ in 0..8 {
            let (mut segmenter, mut planes) = (segmenter(), planes());
            let scan = scene.scan(&truth, believed, SIGMA, &mut noise);
            segmenter.segment(&scan, &mut planes).unwrap();
            let (_, height_m) = pose_error(&planes, &truth);
            assert!(
                planes.ground.is_none() || height_m.abs() < 0.007,
                "{height_m}"
            );
            found += usize::from(planes.ground.is_some());
        }
        assert!(found >= 6, "{raised_m} {rise_m}: {found} of 8");
    }
}

#[test]
fn uncorrected_the_camera_stays_where_the_joints_have_it() {
    let config = GroundConfig {
        correct: false,
        ..GroundConfig::default()
    };
    let mut segmenter = ScanLine::new(&ScanLineConfig::default(), config, CAMERA).unwrap();
    let (mut noise, mut planes) = (Noise::new(3), planes());
    let truth = camera_pose(0.0, 0.75);
    let off = UnitQuaternion::from_scaled_axis(Vector3::new(0.0, 0.03, 0.0));
    for (by_joints, height_m) in [
        (truth, 0.0),
        (
            Pose::wrap(off * truth.inner),
            f64::NAN, // tilted, the floor has no one height
        ),
    ] {
        let scan = Scene::floor().scan(&truth, by_joints, SIGMA, &mut noise);
        segmenter.segment(&scan, &mut planes).unwrap();
        assert_eq!(planes.robot_from_camera, by_joints);
        assert!(planes.reliable && planes.ground.is_none());
        let heights = planes.floor_height_m.iter().filter(|h| !h.is_nan());
        let found: Vec<_> = heights.map(|&h| f64::from(h)).collect();
        assert!(height_m.is_nan() || (median(found) - height_m).abs() < 0.003);
    }
}

/// What takes seconds: not in the fast part of the tests.
mod slow {
    use super::*;

    /// The start in front of stairs: the head goes from looking ahead to looking down at the feet, and aside.
    #[test]
    fn stairs_that_fill_the_view_at_the_start_are_never_taken_for_the_ground() {
        for (front_m, rise_m) in [(0.4, 0.03), (0.5, 0.03), (0.4, 0.045)] {
            for seed in 0..6 {
                let mut noise = Noise::new(seed);
                let (mut segmenter, mut planes) = (segmenter(), planes());
                let turn = Vector3::new(noise.within(0.07), 0.0, noise.within(0.03));
                let scene = Scene::stairs(front_m, rise_m, 0.12, 5);
                for frame in 0..45 {
                    let down = 1.0 - 0.07 * f64::from((14_i32 - frame).max(0));
                    let aside = 0.07 * f64::from((frame - 20).max(0)).min(14.0);
                    let truth = camera_pose(aside, down - 0.15 * aside);
                    let believed = turned(&truth, &turn, 0.004);
                    let scan = scene.scan(&truth, believed, SIGMA, &mut noise);
                    segmenter.segment(&scan, &mut planes).unwrap();
                    let (tilt, height) = pose_error(&planes, &truth);
                    let told = format!("{front_m} {rise_m} {seed} frame {frame}: {tilt} {height}");
                    assert!(
                        !planes.reliable || tilt < 0.035 && height.abs() < 0.008,
                        "{told}"
                    );
                    assert!(planes.reliable || frame < 30, "{told}");
                }
            }
        }
    }

    #[test]
    fn low_stairs_in_view_at_the_start_are_not_taken_for_the_ground_of_a_tilted_camera() {
        for (front_m, rise_m) in [(0.4, -0.017), (0.55, -0.017), (0.4, 0.017), (0.55, 0.017)] {
            let scene = low_steps(front_m, rise_m, 0.19);
            for seed in 0..6 {
                let mut noise = Noise::new(seed);
                let (mut segmenter, mut planes) = (segmenter(), planes());
                let turn = Vector3::new(noise.within(0.1), 0.0, noise.within(0.1));
                for frame in 0..90 {
                    let down =
                        (0.02 + 0.07 * f64::from(frame)).min(if frame > 20 { 0.85 } else { 1.0 });
                    let aside = 0.8 * libm::sin(f64::from((frame - 20).max(0)) * 0.09);
                    let truth = camera_pose(aside, down);
                    let believed = turned(&truth, &turn, 0.004);
                    let scan = scene.scan(&truth, believed, SIGMA, &mut noise);
                    segmenter.segment(&scan, &mut planes).unwrap();
                    let (tilt, _) = pose_error(&planes, &truth);
                    let told = format!("{front_m} {rise_m} {seed} frame {frame}: {tilt}");
                    assert!(!planes.reliable || tilt < 0.045, "{told}");
                    assert!(planes.reliable || frame < 30, "{told}");
                }
            }
        }
    }
}
