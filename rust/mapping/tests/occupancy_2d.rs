//! The occupancy grid of a plane, fed by depth images: what it can represent, and what it takes for an obstacle (004, section 36.2.1).

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::{Block, camera, look};
use geometry::{Map, Pose, Robot};
use mapping::{DepthSliceConfig, Occupancy2d, Surface, WorldModel};
use plan_view::OccupancyConfig;

fn map() -> Occupancy2d {
    let (config, slice) = (OccupancyConfig::default(), DepthSliceConfig::default());
    Occupancy2d::new(config, slice, Some(0.6)).unwrap()
}

/// Looks along x from some places, and down and up from each.
fn see(model: &mut Occupancy2d, blocks: &[Block]) {
    for step in 0..5 {
        let pose = Pose::<Map, Robot>::from_yaw(0.03 * f64::from(step), 0.0, 0.0, 0.0);
        for pitch in [0.7, 0.35] {
            let planes = look(blocks, &pose, camera(0.5, pitch, 0.0));
            assert!(model.insert(&planes, &pose).unwrap().used);
        }
    }
}

fn at(model: &Occupancy2d, x: f64, y: f64) -> Surface {
    model.view().at(x, y)
}

#[test]
fn floor_is_free_what_stands_on_it_an_obstacle_and_what_is_behind_unknown() {
    let mut model = map();
    see(
        &mut model,
        &[Block::new([0.9, -0.2, 0.0], [1.1, 0.2, 0.4], false)],
    );
    assert_eq!(at(&model, 0.7, 0.02), Surface::Floor(0.0));
    assert!(matches!(at(&model, 0.9, 0.02), Surface::Obstacle(_)));
    assert_eq!(at(&model, 1.5, 0.02), Surface::Unknown);
    assert_eq!(at(&model, 0.02, 0.02), Surface::Floor(0.0)); // where it stands
    assert!(
        model
            .occupied()
            .iter()
            .all(|voxel| voxel.centre_m[2] < 0.62)
    );
}

#[test]
fn a_step_is_an_obstacle_though_its_top_is_a_floor_to_others() {
    let mut model = map();
    see(
        &mut model,
        &[Block::new([0.9, -0.6, 0.0], [1.6, 0.6, 0.03], true)],
    );
    assert!(matches!(at(&model, 0.9, 0.02), Surface::Obstacle(_)));
    assert!(
        matches!(at(&model, 1.3, 0.02), Surface::Obstacle(_)),
        "its top, too: a goal there is refused"
    );
    assert_eq!(at(&model, 0.7, 0.02), Surface::Floor(0.0));
}

#[test]
fn a_hole_is_an_obstacle_too() {
    // All but the hole lies on a slab.
    let slab = |min: [f64; 2], max: [f64; 2]| {
        Block::new([min[0], min[1], -0.2], [max[0], max[1], 0.0], true)
    };
    let ground = Block::new([-1.0, -2.0, -0.4], [4.0, 2.0, -0.2], true);
    let blocks = [
        slab([-1.0, -2.0], [0.9, 2.0]),
        slab([1.3, -2.0], [4.0, 2.0]),
        ground,
    ];
    let mut model = map();
    for step in 0..5 {
        let pose = Pose::<Map, Robot>::from_yaw(0.03 * f64::from(step), 0.0, 0.0, 0.0);
        let mut planes = look(&blocks, &pose, camera(0.5, 0.5, 0.0));
        // The scene's own ground hides the hole; what is seen in it lies 0.2 m lower on the same ray.
        for (point, height) in planes
            .points_in_robot_m
            .iter_mut()
            .zip(&mut planes.floor_height_m)
        {
            let x = f64::from(point[0]) + 0.03 * f64::from(step);
            if (0.9..1.2).contains(&x) && *height == 0.0 {
                point[2] = -0.2;
                *height = -0.2;
            }
        }
        let _ = model.insert(&planes, &pose).unwrap();
    }
    assert!(matches!(at(&model, 0.9, 0.02), Surface::Obstacle(_)));
}

#[test]
fn what_hangs_above_the_head_is_passed_below_and_what_hangs_lower_is_not() {
    for (under, blocked) in [(0.65, false), (0.3, true)] {
        let mut model = map();
        let beam = Block::new([0.9, -0.5, under], [1.0, 0.5, under + 0.1], false);
        for pitch in [0.6, 0.2, -0.2] {
            let pose = Pose::<Map, Robot>::from_yaw(0.0, 0.0, 0.0, 0.0);
            for _ in 0..2 {
                let planes = look(&[beam], &pose, camera(0.5, pitch, 0.0));
                let _ = model.insert(&planes, &pose).unwrap();
            }
        }
        let there = matches!(at(&model, 0.9, 0.02), Surface::Obstacle(_));
        assert_eq!(there, blocked, "{:?}", at(&model, 0.9, 0.02));
    }
}

#[test]
fn what_was_taken_away_is_free_within_a_second() {
    let mut model = map();
    let there = Block::new([0.9, -0.2, 0.0], [1.1, 0.2, 0.4], false);
    let pose = Pose::<Map, Robot>::from_yaw(0.0, 0.0, 0.0, 0.0);
    for _ in 0..50 {
        let planes = look(&[there], &pose, camera(0.5, 0.5, 0.0));
        let _ = model.insert(&planes, &pose).unwrap();
    }
    assert!(matches!(at(&model, 0.9, 0.02), Surface::Obstacle(_)));
    let mut frames = 0;
    while !matches!(at(&model, 0.9, 0.02), Surface::Floor(_)) {
        let planes = look(&[], &pose, camera(0.5, 0.5, 0.0));
        let _ = model.insert(&planes, &pose).unwrap();
        frames += 1;
        assert!(frames <= 12, "12 frames are a second");
    }
}

#[test]
fn without_a_robot_the_height_of_the_slice_must_be_given() {
    let (config, slice) = (OccupancyConfig::default(), DepthSliceConfig::default());
    let said = Occupancy2d::new(config, slice, None)
        .err()
        .unwrap()
        .to_string();
    assert_eq!(
        said,
        "navigation.depth_slice.high must be given where there is no robot, got nothing"
    );
}
