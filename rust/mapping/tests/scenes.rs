//! The experiments of 000 on simulated worlds: Fig. 3, Fig. 5, section III.D, and what must never break the map.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::{Block, HEIGHT, WIDTH, camera, interior, look};
use geometry::{Map, Pose, Robot};
use mapping::{Fog, FogConfig, MapError, Surface, Update, WorldModel};
use segmentation::Planes;

fn at(x: f64, y: f64) -> Pose<Map, Robot> {
    Pose::from_yaw(x, y, 0.0, 0.0)
}

/// Looks around from a place until everything in view was seen several times.
fn look_around(fog: &mut Fog, blocks: &[Block], map_from_robot: &Pose<Map, Robot>) {
    for _ in 0..3 {
        for pitch in [0.2, 0.55, 0.9] {
            for pan in [-0.8, -0.4, 0.0, 0.4, 0.8] {
                let planes = look(blocks, map_from_robot, camera(0.5, pitch, pan));
                let _ = fog.insert(&planes, map_from_robot).unwrap();
            }
        }
    }
}

#[test]
fn floors_are_exact_and_obstacles_coarse_with_a_perfect_sensor() {
    // Fig. 3: three levels (0, 38 and 92 mm) and two obstacles whose tops are no floor.
    let blocks = [
        Block::new([0.4, -0.5, 0.0], [0.8, -0.1, 0.038], true),
        Block::new([0.4, 0.1, 0.0], [0.8, 0.5, 0.092], true),
        Block::new([1.0, -0.4, 0.0], [1.2, -0.2, 0.2], false),
        Block::new([1.0, 0.1, 0.0], [1.3, 0.3, 0.3], false),
    ];
    let mut fog = Fog::new(common::paper()).unwrap();
    for (x, y) in [(0.0, 0.0), (0.2, -0.3), (0.2, 0.3), (0.55, -0.3)] {
        look_around(&mut fog, &blocks, &at(x, y));
    }
    let levels = [
        ([0.4, -0.5], [0.8, -0.1], 0.038),
        ([0.4, 0.1], [0.8, 0.5], 0.092),
    ];
    for (min, max, height) in levels {
        for cell in interior(fog.view(), min, max) {
            match fog.view().cell(cell) {
                Surface::Floor(h) => assert!((h - height).abs() < 1e-4, "{h} at {cell:?}"),
                other => panic!("{other:?} at {cell:?}"),
            }
        }
    }
    for cell in interior(fog.view(), [0.3, -0.06], [0.9, 0.06]) {
        assert!(matches!(fog.view().cell(cell), Surface::Floor(h) if h.abs() < 1e-4));
    }
    for (block, height) in [(blocks[2], 0.2), (blocks[3], 0.3)] {
        let (mut seen, mut missed) = (0, 0);
        for cell in interior(
            fog.view(),
            [block.min[0], block.min[1]],
            [block.max[0], block.max[1]],
        ) {
            assert_eq!(
                fog.floor.height(cell),
                None,
                "the floor grid alone knows nothing here"
            );
            match fog.view().cell(cell) {
                Surface::Obstacle(h) => {
                    seen += 1;
                    assert!((h - height).abs() <= 0.04, "{h} at {cell:?}");
                }
                Surface::Unknown => missed += 1,
                Surface::Floor(h) => panic!("floor {h} at {cell:?}"),
            }
        }
        assert!(seen > 0 && missed == 0, "{seen} seen, {missed} missed");
    }
}

#[test]
fn a_removed_box_vanishes_within_12_frames() {
    let box_ = [Block::new([0.5, -0.1, 0.0], [0.8, 0.1, 0.06], true)];
    for config in [FogConfig::default(), common::paper()] {
        let mut fog = Fog::new(config).unwrap();
        let (pose, eye) = (at(0.0, 0.0), camera(0.5, 0.6, 0.0));
        for _ in 0..20 {
            let _ = fog.insert(&look(&box_, &pose, eye), &pose).unwrap();
        }
        let raised = |fog: &Fog| {
            interior(fog.view(), [0.5, -0.1], [0.8, 0.1])
                .into_iter()
                .filter(|&cell| match fog.view().cell(cell) {
                    Surface::Floor(h) | Surface::Obstacle(h) => h > 0.03,
                    Surface::Unknown => false,
                })
                .count()
        };
        assert!(raised(&fog) > 20, "the box is mapped before it goes");
        let frames = (1..=12).find(|_| {
            let _ = fog.insert(&look(&[], &pose, eye), &pose).unwrap();
            raised(&fog) == 0
        });
        assert!(frames.is_some_and(|n| n <= 4), "{frames:?}");
    }
}

#[test]
fn a_moving_box_leaves_no_heights_in_between() {
    let mut fog = Fog::new(FogConfig::default()).unwrap();
    let (pose, eye) = (at(0.0, 0.0), camera(0.5, 0.6, 0.0));
    for i in 0..60 {
        let y = -0.3 + 0.05 * 0.08 * f64::from(i);
        let moving = [Block::new([0.5, y, 0.0], [0.7, y + 0.2, 0.06], true)];
        let _ = fog.insert(&look(&moving, &pose, eye), &pose).unwrap();
        for &height in fog.floor.heights.values() {
            assert!(!(0.01..0.05).contains(&height), "{height}");
        }
    }
}

#[test]
fn a_curtain_above_a_floor_is_an_obstacle() {
    let curtain = [Block::new([0.8, -0.3, 0.35], [0.84, 0.3, 0.9], false)];
    let mut fog = Fog::new(FogConfig::default()).unwrap();
    let pose = at(0.0, 0.0);
    for pan in [0.0, 0.3, -0.3, 0.0, 0.3, -0.3] {
        for pitch in [0.1, 0.6] {
            let _ = fog
                .insert(&look(&curtain, &pose, camera(0.5, pitch, pan)), &pose)
                .unwrap();
        }
    }
    let cell = fog.view().lattice.cell_at(0.82, 0.02);
    assert!(fog.floor.height(cell).is_some(), "there is a floor below");
    assert!(matches!(fog.view().cell(cell), Surface::Obstacle(h) if h > 0.3));
}

#[test]
fn of_two_levels_only_the_higher_one_is_kept() {
    // A table whose floor below was seen first.
    let table = [Block::new([0.5, -0.3, 0.10], [1.1, 0.3, 0.12], true)];
    let mut fog = Fog::new(FogConfig::default()).unwrap();
    look_around(&mut fog, &[], &at(0.0, 0.0));
    look_around(&mut fog, &table, &at(0.0, 0.0));
    for cell in interior(fog.view(), [0.5, -0.3], [1.1, 0.3]) {
        let surface = fog.view().cell(cell);
        assert!(
            matches!(surface, Surface::Floor(h) if (h - 0.12).abs() < 1e-3),
            "{surface:?}"
        );
    }
}

#[test]
fn what_hangs_at_head_height_is_seen_from_a_landing_too() {
    let landing = Block::new([-1.0, -1.0, 0.0], [3.0, 1.0, 0.4], true);
    let bar = Block::new([0.8, -0.3, 0.9], [0.9, 0.3, 1.2], false);
    let pose = Pose::from_yaw(0.0, 0.0, 0.4, 0.0);
    let mut fog = Fog::new(FogConfig::default()).unwrap();
    for pitch in [0.0, 0.1, 0.5, 0.0, 0.1, 0.5] {
        let planes = look(&[landing, bar], &pose, camera(0.5, pitch, 0.0));
        let _ = fog.insert(&planes, &pose).unwrap();
    }
    assert!(matches!(fog.view().at(0.82, 0.02), Surface::Obstacle(h) if h > 0.88));
    assert!(matches!(fog.view().at(0.7, 0.02), Surface::Floor(h) if (h - 0.4).abs() < 1e-3));
}

#[test]
fn the_robot_stands_on_floor_that_it_cannot_see() {
    let mut fog = Fog::new(FogConfig::default()).unwrap();
    let pose = Pose::from_yaw(0.02, 0.02, 0.03, 0.0);
    let insertion = fog.insert(&Planes::new(WIDTH * HEIGHT), &pose).unwrap();
    assert!(!insertion.used, "nothing seen, no ground: nothing taken in");
    assert_eq!(fog.view().at(0.02, 0.02), Surface::Floor(0.03));
    assert_eq!(fog.view().at(0.4, 0.02), Surface::Unknown);
    let cell = fog.view().lattice.cell_at(0.02, 0.02);
    assert_eq!(
        (fog.floor.height(cell), fog.floor.sightings(cell)),
        (None, 0)
    );
    let _ = fog
        .insert(&Planes::new(WIDTH * HEIGHT), &at(0.5, 0.0))
        .unwrap();
    assert_eq!(
        fog.view().at(0.02, 0.02),
        Surface::Floor(0.03),
        "and walked over it"
    );
}

#[test]
fn a_frame_at_the_wrong_height_is_matched_to_the_floor() {
    let mut fog = Fog::new(FogConfig::default()).unwrap();
    let eye = camera(0.5, 0.6, 0.0);
    for _ in 0..5 {
        let _ = fog
            .insert(&look(&[], &at(0.0, 0.0), eye), &at(0.0, 0.0))
            .unwrap();
    }
    let planes = look(&[], &at(0.0, 0.0), eye);
    let too_high = Pose::from_yaw(0.0, 0.0, 0.008, 0.0);
    let insertion = fog.insert(&planes, &too_high).unwrap();
    assert!(
        (insertion.height_shift_m.unwrap() + 0.008).abs() < 1e-6,
        "{insertion:?}"
    );
    assert!(matches!(fog.view().at(0.7, 0.0), Surface::Floor(h) if h.abs() < 1e-5));
}

#[test]
fn a_patch_that_some_frames_got_wrong_does_not_pull_up_the_floor_beside_it() {
    let mut fog = Fog::new(FogConfig::default()).unwrap();
    let here = at(0.0, 0.0);
    for _ in 0..20 {
        let planes = look(&[], &here, camera(0.5, 0.6, 0.0));
        let _ = fog.insert(&planes, &here).unwrap();
    }
    let aside = look(&[], &here, camera(0.5, 0.6, 1.3));
    let too_high = Pose::from_yaw(0.0, 0.0, 0.016, 0.0);
    let insertion = fog.insert(&aside, &too_high).unwrap();
    assert_eq!(insertion.height_shift_m, None);
    for _ in 0..3 {
        let _ = fog.insert(&aside, &too_high).unwrap();
    }
    // More of this one lies on the patch than on what was seen often.
    let between = look(&[], &here, camera(0.5, 0.6, 0.8));
    let shift_m = fog.insert(&between, &here).unwrap().height_shift_m.unwrap();
    assert!(shift_m.abs() < 1e-6, "{shift_m}");
}

#[test]
fn a_frame_without_ground_is_withdrawn_unless_it_fits_the_floor() {
    let eye = camera(0.5, 0.6, 0.0);
    let mut planes = look(&[], &at(0.0, 0.0), eye);
    planes.reliable = false;
    let mut fog = Fog::new(FogConfig::default()).unwrap();
    let before = fog.occupancy.clone();
    assert!(!fog.insert(&planes, &at(0.0, 0.0)).unwrap().used);
    assert_eq!(fog.occupancy, before);
    planes.reliable = true;
    for _ in 0..2 {
        assert!(fog.insert(&planes, &at(0.0, 0.0)).unwrap().used);
    }
    planes.reliable = false;
    assert!(
        fog.insert(&planes, &at(0.0, 0.0)).unwrap().used,
        "it fits what is known"
    );
}

#[test]
fn a_pose_that_is_no_number_changes_nothing() {
    let mut fog = Fog::new(FogConfig::default()).unwrap();
    let planes = look(&[], &at(0.0, 0.0), camera(0.5, 0.6, 0.0));
    let _ = fog.insert(&planes, &at(0.0, 0.0)).unwrap();
    let before = (fog.view().clone(), fog.occupancy.clone());
    for bad in [f64::NAN, f64::INFINITY] {
        let error = fog.insert(&planes, &at(bad, 0.0)).unwrap_err();
        assert_eq!(error, MapError::PoseNotFinite);
    }
    assert_eq!((fog.view().clone(), fog.occupancy.clone()), before);
}

#[test]
fn wild_input_is_survived() {
    let mut fog = Fog::new(FogConfig::default()).unwrap();
    let mut planes = look(&[], &at(0.0, 0.0), camera(0.5, 0.6, 0.0));
    for (i, point) in planes.points_in_robot_m.iter_mut().enumerate() {
        match i % 5 {
            0 => *point = [f32::MAX, -f32::MAX, f32::MAX],
            1 => *point = [f32::INFINITY, 0.0, f32::NAN],
            2 => *point = [0.0, 0.0, 0.5],
            _ => {}
        }
    }
    for x in [0.0, 1e9, -1e18, 0.3] {
        let _ = fog.insert(&planes, &at(x, 0.0)).unwrap();
    }
    let empty = Planes::new(0);
    let _ = fog.insert(&empty, &at(0.0, 0.0)).unwrap();
}

#[test]
fn both_kinds_of_update_map_a_plain_floor_near_by() {
    for update in [Update::PerFrame, Update::PerPoint] {
        let mut fog = Fog::new(FogConfig {
            update,
            ..FogConfig::default()
        })
        .unwrap();
        let pose = at(0.0, 0.0);
        for _ in 0..5 {
            let _ = fog
                .insert(&look(&[], &pose, camera(0.5, 0.8, 0.0)), &pose)
                .unwrap();
        }
        assert!(
            matches!(fog.view().at(0.4, 0.0), Surface::Floor(h) if h.abs() < 1e-5),
            "{update:?}"
        );
    }
}
