//! The world as a mesh: what is ground, over and under a bridge, and what is gone (004, section 36.3.3).

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::heights::here;
use common::{Block, DEPTH_CAMERA, camera, interior, is_obstacle, look_through, terrain};
use geometry::{Map, Pose, Robot};
use mapping::{ElevationConfig, FloorView, MeshConfig, MeshMap, Surface, WorldModel};
use segmentation::Planes;

const ROBOT_M: f64 = 0.58;
const DECK_M: [f64; 2] = [0.65, 0.70];

fn model() -> MeshMap {
    let config = MeshConfig::default();
    MeshMap::new(config, ElevationConfig::default(), Some(ROBOT_M)).unwrap()
}

/// Of the cells of a rectangle, the share that is floor within 2 cm of a height.
fn floor_share(view: &FloorView, min: [f64; 2], max: [f64; 2], height_m: f64) -> f64 {
    let cells = interior(view, min, max);
    let is_floor = |surface: Surface| match surface {
        Surface::Floor(h) => (f64::from(h) - height_m).abs() < 0.02,
        Surface::Obstacle(_) | Surface::Unknown => false,
    };
    let floor = cells.iter().filter(|&&cell| is_floor(view.cell(cell)));
    floor.count() as f64 / cells.len() as f64
}

fn see(model: &mut MeshMap, blocks: &[Block], pose: &Pose<Map, Robot>, pitch: f64, pan: f64) {
    let planes = look_through(DEPTH_CAMERA, blocks, pose, camera(0.45, pitch, pan));
    assert!(model.insert(&planes, pose).unwrap().used);
}

#[test]
fn over_and_under_a_bridge_there_is_a_way() {
    let [under, top] = DECK_M;
    let bridge = [
        Block::new([0.8, -1.2, under], [1.4, 1.2, top], true),
        Block::new([0.8, 0.6, 0.0], [1.4, 1.2, under], false),
        Block::new([0.8, -1.2, 0.0], [1.4, -0.6, under], false),
    ];
    let from_the_road = |model: &mut MeshMap| {
        for step in 0..3 {
            let pose = Pose::<Map, Robot>::from_yaw(-0.4 + 0.15 * f64::from(step), 0.0, 0.0, 0.0);
            for pitch in [0.6, 0.25, -0.1, -0.35] {
                see(model, &bridge, &pose, pitch, 0.0);
            }
        }
    };
    let mut map = model();
    from_the_road(&mut map);
    let road = floor_share(map.view(), [0.84, -0.3], [1.36, 0.3], 0.0);
    assert!(road > 0.95, "{road}");
    for step in 0..6 {
        let along = -1.0 + 0.08 * f64::from(step);
        let pose = Pose::<Map, Robot>::from_yaw(1.1, along, top, 1.571);
        for pan in [-0.6, 0.0, 0.6] {
            see(&mut map, &bridge, &pose, 0.7, pan);
        }
    }
    let deck = floor_share(map.view(), [0.9, -0.3], [1.3, 0.3], top);
    assert!(deck > 0.95, "{deck}");
    from_the_road(&mut map);
    let road = floor_share(map.view(), [0.84, -0.3], [1.36, 0.3], 0.0);
    assert!(road > 0.95, "{road}");
}

#[test]
fn a_sill_has_its_height_and_its_edge_within_a_cell_and_no_height_between() {
    let sill = [Block::new([0.6, -0.6, 0.0], [0.8, 0.6, 0.038], true)];
    let mut map = model();
    for _ in 0..5 {
        for pitch in [0.9, 0.6, 0.4] {
            see(&mut map, &sill, &here(), pitch, 0.0);
        }
    }
    let view = map.view();
    assert!(floor_share(view, [0.6, -0.2], [0.8, 0.2], 0.038) > 0.95);
    let cell_m = view.lattice.cell_m;
    for cell in interior(view, [0.4, -0.2], [0.75, 0.2]) {
        let x_m = view.lattice.center_of(cell)[0];
        let Surface::Floor(height_m) = view.cell(cell) else {
            panic!("{:?} at {x_m}", view.cell(cell));
        };
        let off = |truth: f64| (f64::from(height_m) - truth).abs() < 0.006;
        let near_edge = (x_m - 0.6).abs() <= cell_m;
        let truth = if x_m < 0.6 { 0.0 } else { 0.038 };
        assert!(
            off(truth) || (near_edge && off(0.038 - truth)),
            "{height_m} at {x_m}"
        );
    }
}

#[test]
fn a_box_is_in_the_way_until_it_is_removed() {
    let there = [Block::new([0.7, -0.1, 0.0], [0.8, 0.1, 0.2], true)];
    let mut map = model();
    for (blocks, frames) in [(&there[..], 6), (&[][..], 12)] {
        for _ in 0..frames {
            see(&mut map, blocks, &here(), 0.4, 0.0);
        }
        // All around its edge: from above a box is floor.
        let cells = interior(map.view(), [0.64, -0.16], [0.84, 0.16]);
        let in_the_way = cells
            .iter()
            .filter(|&&cell| is_obstacle(map.view().cell(cell)));
        let count = in_the_way.count();
        assert!(
            if blocks.is_empty() {
                count == 0
            } else {
                count >= 5
            },
            "{count} of {blocks:?}"
        );
    }
    assert!(floor_share(map.view(), [0.7, -0.1], [0.8, 0.1], 0.0) > 0.9);
}

#[test]
fn a_slope_is_ground_with_a_gradient_and_its_heights_are_true() {
    let height = |x: f64, _: f64| (0.3 * (x - 0.4)).clamp(0.0, 0.2);
    let mut luck = terrain::Luck(4);
    let mut map = model();
    for _ in 0..6 {
        let planes = terrain::look(DEPTH_CAMERA, height, camera(0.5, 0.6, 0.0), 0.2, &mut luck);
        assert!(map.insert(&planes, &here()).unwrap().used);
    }
    let view = map.view();
    for cell in interior(view, [0.6, -0.2], [0.9, 0.2]) {
        let [x, y] = view.lattice.center_of(cell);
        let Surface::Floor(found_m) = view.cell(cell) else {
            panic!("{:?} at {x}, {y}", view.cell(cell));
        };
        assert!(
            (f64::from(found_m) - height(x, y)).abs() < 0.015,
            "{found_m} at {x}"
        );
    }
    let [rise, aside] = view.gradient_at(0.75, 0.0);
    assert!(
        (rise - 0.3).abs() < 0.08 && aside.abs() < 0.08,
        "{rise} {aside}"
    );
}

#[test]
fn a_cloud_without_a_picture_gives_ground_as_well() {
    let blocks = [Block::new([0.7, -0.2, 0.0], [0.9, 0.2, 0.03], true)];
    let mut planes = look_through(DEPTH_CAMERA, &blocks, &here(), camera(0.5, 0.6, 0.0));
    planes = Planes::of_points(planes.points_in_robot_m, planes.robot_from_camera);
    let mut map = model();
    assert!(map.insert(&planes, &here()).unwrap().used);
    assert!(floor_share(map.view(), [0.7, -0.1], [0.9, 0.1], 0.03) > 0.9);
    assert!(map.surface().unwrap().triangles.len() > 100);
}
