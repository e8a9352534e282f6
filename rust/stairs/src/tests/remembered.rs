//! What is kept while the robot walks and steps.

use super::prisms::{Prism, frame};
use super::*;
use crate::Stair;

fn heights(staircase: &Staircase) -> Vec<i64> {
    staircase
        .stairs
        .iter()
        .map(|stair| (stair.height_m() * 1e3 / 30.0).round() as i64)
        .collect()
}

/// Looks at stairs 0.45 m away.
fn seen(seed: u64) -> (Looker, Scene) {
    seen_with(seed, StairsConfig::default())
}

fn seen_with(seed: u64, config: StairsConfig) -> (Looker, Scene) {
    let scene = Scene::stairs(0.45, 0.03, 0.12, 4);
    let mut looker = Looker::with(config, seed, SIGMA);
    for i in 0..12 {
        let _ = looker.look(
            &scene,
            &camera_pose(0.05 * f64::from(i - 6), 0.75),
            &Pose::identity(),
            0,
        );
    }
    (looker, scene)
}

/// S-M9 and S-M11: four steps that odometry takes for 1 % longer, up the stairs, without a look.
#[test]
fn a_step_empties_what_is_seen_and_what_is_remembered_stays_within_1_cm() {
    let (mut looker, scene) = seen(2);
    looker.planes.reliable = false;
    let scan = Scan::new(CAMERA);
    for steps in 1..=4_u64 {
        let way_m = 0.12 * steps as f64;
        let pose: Pose<Map, Robot> = Pose::from_yaw(1.01 * way_m, 0.0, 0.03 * steps as f64, 0.0);
        let staircase = looker
            .recognizer
            .update(&scan, &looker.planes, &pose, steps)
            .unwrap();
        assert_eq!(staircase.frames, 0);
        assert!(
            staircase
                .stairs
                .iter()
                .all(|stair| u64::from(stair.steps_ago) == steps)
        );
        for (block, height_m) in scene.blocks.iter().zip([0.03, 0.06, 0.09, 0.12]) {
            let same = |stair: &&Stair<Map>| (stair.height_m() - height_m).abs() < 0.005;
            let stair = staircase.stairs.iter().find(same).unwrap();
            // Those that are climbed next.
            let ahead_m = block.low_m[0] - way_m;
            if (0.05..0.3).contains(&ahead_m) {
                let found = stair.front.transformed(&pose.inverse());
                assert!(
                    found.beyond_m([ahead_m, 0.0]).abs() < 0.01,
                    "{steps} {stair:?}"
                );
            }
        }
    }
}

#[test]
fn the_picture_of_stairs_is_steady_while_the_robot_walks_up_to_them() {
    let (mut looker, scene) = seen(4);
    let mut noise = Noise::new(9);
    for i in 1..=36 {
        let way_m = 0.006 * f64::from(i);
        let steps = u64::try_from(i / 6).unwrap();
        let moved = Scene::with(
            &scene
                .blocks
                .iter()
                .map(|block| {
                    let mut block = *block;
                    block.low_m[0] -= way_m;
                    block.high_m[0] -= way_m;
                    block
                })
                .collect::<Vec<_>>(),
        );
        // The estimate is 2 cm off from the second step on.
        let off_m = if steps > 1 { 0.02 } else { 0.0 };
        let pose: Pose<Map, Robot> = Pose::from_yaw(way_m + off_m, 0.0, noise.within(0.001), 0.0);
        let staircase = looker.look(&moved, &camera_pose(0.0, 0.75), &pose, steps);
        let mut found = heights(staircase);
        found.sort_unstable();
        assert_eq!(found, [1, 2, 3, 4], "frame {i}: {:?}", staircase.stairs);
    }
}

#[test]
fn stairs_that_vanish_are_dropped_after_some_frames_and_not_at_once() {
    let (mut looker, _) = seen(6);
    let first = heights(looker.look(
        &Scene::floor(),
        &camera_pose(0.0, 0.75),
        &Pose::identity(),
        1,
    ));
    assert!(first.contains(&1));
    for _ in 0..6 {
        let _ = looker.look(
            &Scene::floor(),
            &camera_pose(0.0, 0.75),
            &Pose::identity(),
            1,
        );
    }
    let last = heights(&looker.recognizer.staircase);
    assert!(!last.contains(&1) && !last.contains(&2), "{last:?}");
}

/// Levels one behind the other, each from a place on and so high.
fn levels(from_and_top_m: &[[f64; 2]]) -> Vec<Prism> {
    let ends = from_and_top_m[1..]
        .iter()
        .map(|&[from_m, _]| from_m)
        .chain([5.0]);
    let each = from_and_top_m.iter().zip(ends);
    let prism = |(&[from_m, top_m], to_m): (&[f64; 2], f64)| {
        let corners = [[from_m, -3.0], [to_m, -3.0], [to_m, 3.0], [from_m, 3.0]];
        Prism::new(&corners, top_m)
    };
    each.map(prism).collect()
}

#[test]
fn a_lower_tread_is_dropped_once_the_ground_itself_is_seen_in_its_place_from_near() {
    let mut recognizer = Recognizer::new(StairsConfig::default(), CAMERA).unwrap();
    let mut has_tread = |prisms: &[Prism]| {
        let (scan, mut planes) = frame(prisms, &Pose::identity(), &camera_pose(0.0, 0.9));
        planes.ground = Some(0);
        for _ in 0..6 {
            let found = recognizer.update(&scan, &planes, &Pose::identity(), 0);
            assert!(found.is_ok());
        }
        let stairs = &recognizer.staircase.stairs;
        (stairs.iter()).any(|stair| (-0.03..-0.01).contains(&stair.height_m()))
    };
    let ground = [-3.0, 0.0];
    assert!(has_tread(&levels(&[ground, [0.3, -0.02], [0.45, -0.04]])));
    assert!(!has_tread(&levels(&[ground])));
}

/// Looking up, a robot whose camera is off by half a degree sees the floor a centimetre lower.
#[test]
fn floor_that_seems_lower_is_no_stair_while_the_ground_before_the_feet_is_not_seen() {
    for (ground, is_one) in [(None, false), (Some(0), true)] {
        let mut recognizer = Recognizer::new(StairsConfig::default(), CAMERA).unwrap();
        let prisms = levels(&[[-3.0, 0.0], [0.2, -0.014]]);
        let (scan, mut planes) = frame(&prisms, &Pose::identity(), &camera_pose(0.0, 0.4));
        planes.ground = ground;
        for _ in 0..6 {
            let found = recognizer.update(&scan, &planes, &Pose::identity(), 0);
            assert!(found.is_ok());
        }
        let stairs = &recognizer.staircase.stairs;
        assert_eq!(!stairs.is_empty(), is_one, "{ground:?}: {stairs:?}");
    }
}

/// From afar a step and the platform behind it run into each other for some frames. Of the platform little is seen from near by.
#[test]
fn two_steps_that_were_taken_for_one_do_not_stay_beside_them() {
    let box_from = |from_m: f64, top_m| {
        let corners = [[from_m, -0.4], [3.0, -0.4], [3.0, 0.4], [from_m, 0.4]];
        Prism::new(&corners, top_m)
    };
    let ground = Prism::new(&[[-3.0, -3.0], [5.0, -3.0], [5.0, 3.0], [-3.0, 3.0]], 0.0);
    let first = box_from(0.45, 0.03);
    let apart = [
        first.clone(),
        box_from(0.57, 0.06),
        box_from(0.69, 0.09),
        ground.clone(),
    ];
    let joined = [first, box_from(0.57, 0.077), ground];
    let ghost = |stair: &Stair<Map>| (0.065..0.085).contains(&stair.height_m());
    let mut recognizer = Recognizer::new(StairsConfig::default(), CAMERA).unwrap();
    for (frames, prisms, tilt_rad, steps) in [
        (12, &apart[..], 0.9, 0),
        (3, &joined[..], 0.6, 0),
        (12, &apart[..], 0.75, 1),
    ] {
        for i in 0..frames {
            let camera = camera_pose(0.05 * f64::from(i % 5 - 2), tilt_rad);
            let (scan, planes) = frame(prisms, &Pose::identity(), &camera);
            let staircase = recognizer
                .update(&scan, &planes, &Pose::identity(), steps)
                .unwrap();
            assert!(
                !staircase.stairs.iter().any(ghost),
                "frame {i} at {tilt_rad}: {:?}",
                staircase.stairs
            );
        }
    }
    let mut found = heights(&recognizer.staircase);
    found.sort_unstable();
    assert_eq!(found, [1, 2, 3]);
}

#[test]
fn open_floor_and_boxes_are_no_stairs() {
    let boxes = [
        Block {
            low_m: [0.5, 0.05, 0.0],
            high_m: [0.6, 0.17, 0.1],
        },
        Block {
            low_m: [0.9, -0.8, 0.0],
            high_m: [0.95, 0.8, 0.6],
        },
    ];
    for seed in 0..3 {
        for scene in [Scene::floor(), Scene::with(&boxes)] {
            let mut looker = Looker::new(seed, SIGMA);
            for i in 0..12 {
                let camera = camera_pose(0.05 * f64::from(i - 6), 0.7);
                let found = looker.look(&scene, &camera, &Pose::identity(), 0);
                assert!(found.stairs.is_empty(), "{:?}", found.stairs);
            }
        }
    }
}

#[test]
fn a_pose_that_is_no_number_is_refused_and_changes_nothing() {
    let (mut looker, _) = seen(1);
    let before = looker.recognizer.staircase.clone();
    let nowhere: Pose<Map, Robot> = Pose::from_yaw(f64::NAN, 0.0, 0.0, 0.0);
    let refused = looker
        .recognizer
        .update(&Scan::new(CAMERA), &looker.planes, &nowhere, 9);
    assert_eq!(refused.unwrap_err(), crate::StairsError::PoseNotFinite);
    assert_eq!(&looker.recognizer.staircase, &before);
}

/// Edges leave the picture at its lower border, askew where the head is turned: what is left of a tread then ends there.
#[test]
fn edges_that_were_fitted_stay_where_they_are_when_they_leave_the_view() {
    let fronts_m = [0.45, 0.57, 0.69];
    let mut prisms: Vec<_> = fronts_m
        .iter()
        .zip([0.03, 0.06, 0.09])
        .map(|(&from_m, top_m)| {
            let to_m: f64 = from_m + if top_m > 0.08 { 0.6 } else { 0.12 };
            let corners = [[from_m, -0.4], [to_m, -0.4], [to_m, 0.4], [from_m, 0.4]];
            Prism::new(&corners, top_m)
        })
        .collect();
    prisms.push(Prism::new(
        &[[-3.0, -3.0], [5.0, -3.0], [5.0, 3.0], [-3.0, 3.0]],
        0.0,
    ));
    let mut recognizer = Recognizer::new(StairsConfig::default(), CAMERA).unwrap();
    for i in 0..240 {
        let way_m = 0.08 * f64::from(i / 40);
        let pose: Pose<Map, Robot> = Pose::from_yaw(way_m, 0.0, 0.0, 0.0);
        let camera = camera_pose(
            0.3 * libm::sin(0.7 * f64::from(i)),
            0.9 + 0.04 * f64::from(i / 40),
        );
        let (scan, planes) = frame(&prisms, &pose, &camera);
        let steps = u64::try_from(i / 40).unwrap();
        let staircase = recognizer.update(&scan, &planes, &pose, steps).unwrap();
        for (level, front_m) in (1..).zip(fronts_m) {
            let same =
                |stair: &&Stair<Map>| (stair.height_m() - 0.03 * f64::from(level)).abs() < 0.005;
            let told = format!("frame {i} step {level}: {:?}", staircase.stairs);
            if i >= 40 && level < 3 {
                let stair = staircase.stairs.iter().find(same).expect(&told);
                assert!(stair.front_fit.is_some(), "{told}");
                assert!(stair.front.beyond_m([front_m, 0.0]).abs() < 0.01, "{told}");
                assert!(stair.front.heading_rad().abs() < 0.05, "{told}");
            }
        }
    }
}

#[test]
fn who_is_elsewhere_forgets_the_edges_that_were_fitted_too() {
    let (mut looker, scene) = seen(5);
    looker.recognizer.forget();
    assert!(looker.recognizer.staircase.stairs.is_empty());
    let camera = camera_pose(0.0, 0.75);
    for _ in 0..2 {
        let _ = looker.look(&scene, &camera, &Pose::identity(), 0);
    }
    let stairs = &looker.recognizer.staircase.stairs;
    let frames = |stair: &Stair<Map>| stair.front_fit.map_or(0, |fit| fit.frames);
    assert!(!stairs.is_empty());
    assert!(stairs.iter().all(|stair| frames(stair) <= 2), "{stairs:?}");
}

#[test]
fn what_may_be_remembered_for_no_step_is_gone_after_one() {
    for (forget_steps, remembered) in [(0, false), (1, true)] {
        let config = StairsConfig {
            forget_steps,
            ..StairsConfig::default()
        };
        let (mut looker, _) = seen_with(2, config);
        let camera = camera_pose(0.0, 0.75);
        let staircase = looker.look(&Scene::floor(), &camera, &Pose::identity(), 1);
        assert_eq!(!staircase.stairs.is_empty(), remembered, "{forget_steps}");
    }
}

/// An edge that was fitted well is no less sure against the map, which the same steps carry along.
#[test]
fn edges_that_were_fitted_well_are_known_for_many_steps_and_not_for_ever() {
    let (mut looker, _) = seen(2);
    looker.planes.reliable = false;
    let scan = Scan::new(CAMERA);
    let sure = looker.recognizer.staircase.edges.len();
    assert!(sure > 1, "{sure}");
    let mut known = |steps: u64| {
        let planes = &looker.planes;
        let staircase = (looker.recognizer).update(&scan, planes, &Pose::identity(), steps);
        staircase.unwrap().edges.len()
    };
    assert_eq!(known(20), sure);
    assert_eq!(known(90), 0);
}
