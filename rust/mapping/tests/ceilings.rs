//! The ceiling map of 000, section VI: the robot passes under what hangs high enough above the floor there.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::{Block, camera, is_obstacle, look};
use geometry::{Map, Pose, Robot};
use mapping::{Fog, FogConfig, HeadRoom, Surface, WorldModel};
use proptest::prelude::*;

/// What the robot needs to walk upright, m.
const HEADROOM_M: f64 = 0.6;
/// A place under the middle of [`bar`], m.
const UNDER: [f64; 2] = [0.82, 0.02];

/// A map that holds what hangs higher than the robot's head.
fn fog(headroom: Option<f64>) -> Fog {
    let config = FogConfig {
        layers: 32,
        headroom,
        ..FogConfig::default()
    };
    Fog::new(config).unwrap()
}

/// Across the way, its underside at this height, m.
fn bar(underside_m: f64) -> Block {
    Block::new(
        [0.8, -0.4, underside_m],
        [0.84, 0.4, underside_m + 0.3],
        false,
    )
}

/// Looks ahead and down until everything in view was seen several times.
fn look_ahead(fog: &mut Fog, blocks: &[Block], map_from_robot: &Pose<Map, Robot>) {
    for _ in 0..3 {
        for pitch in [-0.1, 0.2, 0.6] {
            let planes = look(blocks, map_from_robot, camera(0.5, pitch, 0.0));
            let _ = fog.insert(&planes, map_from_robot).unwrap();
        }
    }
}

fn at(height_m: f64) -> Pose<Map, Robot> {
    Pose::from_yaw(0.0, 0.0, height_m, 0.0)
}

fn ceiling_m(fog: &Fog) -> Option<f64> {
    let [x, y] = UNDER;
    fog.ceiling_m(fog.view().lattice.cell_at(x, y))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]
    #[test]
    fn a_bar_is_found_to_40_mm_and_passed_under_where_it_is_high_enough(underside_m in 0.2..0.75f64) {
        let mut fog = fog(Some(HEADROOM_M));
        look_ahead(&mut fog, &[bar(underside_m)], &at(0.0));
        let found_m = ceiling_m(&fog).unwrap();
        prop_assert!((found_m - underside_m).abs() <= 0.04, "{} at {}", found_m, underside_m);
        let surface = fog.view().at(UNDER[0], UNDER[1]);
        // In between the layers' height decides.
        if underside_m >= HEADROOM_M + 0.04 {
            prop_assert!(matches!(surface, Surface::Floor(h) if h.abs() < 1e-4), "{:?} at {}", surface, underside_m);
        } else if underside_m < HEADROOM_M {
            prop_assert!(is_obstacle(surface), "{:?} at {}", surface, underside_m);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn on_a_floor_of_any_height_40_mm_more_than_the_robot_needs_are_enough_and_20_mm_less_are_not(floor_m in 0.0..0.12f64) {
        for (more_m, passes) in [(0.04, true), (-0.02, false)] {
            let mut fog = fog(Some(HEADROOM_M));
            let platform = Block::new([0.5, -1.0, 0.0], [2.0, 1.0, floor_m], true);
            look_ahead(&mut fog, &[platform, bar(floor_m + HEADROOM_M + more_m)], &at(0.0));
            let surface = fog.view().at(UNDER[0], UNDER[1]);
            prop_assert!(passes != is_obstacle(surface), "{:?} with {} m more over {} m", surface, more_m, floor_m);
        }
    }
}

/// A post hides the floor below a bar that shows above it.
#[test]
fn what_hangs_high_enough_is_passed_under_where_the_floor_below_was_not_seen_but_that_beside_it_was()
 {
    let post = Block::new([0.5, 0.0, 0.0], [0.54, 0.04, 0.3], false);
    for (underside_m, passes) in [(HEADROOM_M + 0.08, true), (HEADROOM_M - 0.04, false)] {
        let mut fog = fog(Some(HEADROOM_M));
        look_ahead(&mut fog, &[post, bar(underside_m)], &at(0.0));
        let hidden = fog.view().lattice.cell_at(UNDER[0], UNDER[1]);
        assert!(ceiling_m(&fog).is_none(), "its floor is hidden");
        let surface = *fog.view().cells.get(hidden).unwrap();
        assert_eq!(is_obstacle(surface), !passes, "{surface:?}");
        let low = matches!(fog.view().head_at(UNDER[0], UNDER[1]), HeadRoom::Low { .. });
        assert_eq!(low, !passes);
    }
}

/// Looks at the floor alone: the horizon is above the picture.
fn look_down(fog: &mut Fog, blocks: &[Block]) {
    let pose = at(0.0);
    for _ in 0..3 {
        let planes = look(blocks, &pose, camera(0.5, 0.6, 0.0));
        let _ = fog.insert(&planes, &pose).unwrap();
    }
}

#[test]
fn the_room_above_a_floor_is_unseen_until_the_gaze_rises_even_where_nothing_ends_it() {
    let mut fog = fog(Some(HEADROOM_M));
    let head = |fog: &Fog| fog.view().head_at(UNDER[0], UNDER[1]);
    look_down(&mut fog, &[]);
    assert_eq!(head(&fog), HeadRoom::Unseen);
    assert_eq!(
        fog.view().head_at(0.02, 0.02),
        HeadRoom::Free,
        "it stands there"
    );
    look_ahead(&mut fog, &[], &at(0.0));
    assert_eq!(head(&fog), HeadRoom::Free);
}

#[test]
fn what_hangs_too_low_is_an_obstacle_for_the_head_alone_and_what_stands_is_one_for_all() {
    let mut fog = fog(Some(HEADROOM_M));
    let stands = Block::new([0.6, 0.15, 0.0], [0.65, 0.22, 0.8], false);
    look_ahead(&mut fog, &[bar(0.5), stands], &at(0.0));
    let view = fog.view();
    let HeadRoom::Low { floor_m, room_m } = view.head_at(UNDER[0], UNDER[1]) else {
        panic!("{:?}", view.head_at(UNDER[0], UNDER[1]));
    };
    assert!(
        floor_m.abs() < 1e-3 && (room_m - 0.5).abs() <= 0.04,
        "{floor_m} {room_m}"
    );
    assert!(is_obstacle(view.at(UNDER[0], UNDER[1])));
    let open = view.without_ceilings().unwrap();
    assert!(matches!(open.at(UNDER[0], UNDER[1]), Surface::Floor(_)));
    assert!(
        is_obstacle(open.at(0.62, 0.18)),
        "{:?}",
        view.head_at(0.62, 0.18)
    );
    assert!(open.without_ceilings().is_none());
}

#[test]
fn without_a_headroom_nobody_asks_for_room() {
    let mut fog = fog(None);
    look_down(&mut fog, &[]);
    assert!(
        fog.view()
            .head
            .values()
            .iter()
            .all(|head| *head == HeadRoom::Free)
    );
}

#[test]
fn without_a_headroom_whatever_hangs_is_an_obstacle() {
    let mut fog = fog(None);
    look_ahead(&mut fog, &[bar(0.7)], &at(0.0));
    assert!(ceiling_m(&fog).is_some(), "it is mapped all the same");
    assert!(matches!(
        fog.view().at(UNDER[0], UNDER[1]),
        Surface::Obstacle(_)
    ));
}

#[test]
fn the_room_is_measured_from_the_floor_below_not_from_the_robot() {
    // From a landing it sees a bar over the ground before it, and from the ground one over a landing.
    let landing = |behind| {
        let (from, to) = if behind { (0.7, 2.0) } else { (-1.0, 0.3) };
        Block::new([from, -1.0, 0.0], [to, 1.0, 0.12], true)
    };
    for (behind, robot_m, passes) in [(false, 0.12, true), (true, 0.0, false)] {
        let mut fog = fog(Some(HEADROOM_M));
        look_ahead(&mut fog, &[landing(behind), bar(0.66)], &at(robot_m));
        let surface = fog.view().at(UNDER[0], UNDER[1]);
        let free = matches!(surface, Surface::Floor(_));
        assert_eq!(free, passes, "{surface:?} seen from {robot_m} m");
    }
}

#[test]
fn what_stands_under_a_high_ceiling_is_an_obstacle() {
    let stool = Block::new([0.7, -0.2, 0.0], [0.95, 0.2, 0.2], false);
    let mut fog = fog(Some(HEADROOM_M));
    look_ahead(&mut fog, &[], &at(0.0));
    look_ahead(&mut fog, &[stool, bar(0.7)], &at(0.0));
    let surface = fog.view().at(0.78, 0.02);
    assert!(is_obstacle(surface), "{surface:?}");
}

#[test]
fn where_no_floor_was_seen_there_is_no_ceiling_to_pass_under() {
    let mut fog = fog(Some(HEADROOM_M));
    let pose = at(0.0);
    for _ in 0..4 {
        // Level: the floor at the bar is below what the camera sees.
        let planes = look(&[bar(0.66)], &pose, camera(0.5, -0.3, 0.0));
        let _ = fog.insert(&planes, &pose).unwrap();
    }
    assert_eq!(ceiling_m(&fog), None);
    let surface = fog.view().at(UNDER[0], UNDER[1]);
    assert!(is_obstacle(surface), "{surface:?}");
}
