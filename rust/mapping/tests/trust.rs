//! Where the map does not take what it is told for what it seems: floor behind walls, and obstacles that are none.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::{Block, camera, is_obstacle, look};
use geometry::{Map, Plane, Point, Pose};
use mapping::{Fog, FogConfig, Surface, WorldModel};
use nalgebra::Vector3;
use segmentation::{PlaneRegion, Planes};

/// A wall across the robot's way, and a lid before it on the left.
const WALL: Block = Block {
    min: [0.8, -0.6, 0.0],
    max: [0.85, 0.6, 0.6],
    flat: false,
};
const LID: Block = Block {
    min: [0.6, 0.1, 0.0],
    max: [0.8, 0.3, 0.2],
    flat: true,
};

/// How many cells behind the wall's face a map takes for floor, by more than the first frames, that is told of a strip of the wall at
/// the lid's height that it is the lid.
fn floors_behind_the_wall(config: FogConfig) -> usize {
    let mut fog = Fog::new(config).unwrap();
    let pose = Pose::<Map, _>::identity();
    for pitch in [0.3, 0.5, 0.7].into_iter().cycle().take(15) {
        let mut planes = look(&[WALL, LID], &pose, camera(0.5, pitch, 0.0));
        let lid_m = LID.max[2] as f32;
        for (point, height_m) in planes
            .points_in_robot_m
            .iter()
            .zip(&mut planes.floor_height_m)
        {
            if height_m.is_nan() && (point[2] - lid_m).abs() < 0.03 {
                *height_m = lid_m;
            }
        }
        let _ = fog.insert(&planes, &pose).unwrap();
    }
    let view = fog.view();
    // Of what only borders on the view there may be no more than the strip.
    let behind = |[x_m, y_m]: [f64; 2]| x_m > WALL.min[0] + 0.02 && x_m < 1.2 && y_m.abs() < 0.3;
    view.cells
        .area()
        .cells()
        .filter(|&cell| behind(view.lattice.center_of(cell)))
        .filter(|&cell| {
            matches!(view.cell(cell), Surface::Floor(_)) && fog.floor.sightings(cell) > 2
        })
        .count()
}

#[test]
fn a_strip_of_a_wall_that_passes_for_a_lid_makes_no_floor_behind_the_wall() {
    assert_eq!(floors_behind_the_wall(FogConfig::default()), 0);
    let without = FogConfig {
        shadow: 0.0,
        ..FogConfig::default()
    };
    assert!(floors_behind_the_wall(without) > 5);
}

/// Looks at ground, a tread of 60 mm behind it, and between them a strip 4 cm deep whose pixels belong to no surface; what is seen in
/// that strip lies at `strip_m`. Then what the map has there.
fn strip_between_floors(strip_m: f64, config: FogConfig) -> Surface {
    let blocks = [
        Block::new([0.52, -0.5, 0.0], [0.56, 0.5, strip_m], false),
        Block::new([0.56, -0.5, 0.0], [0.9, 0.5, 0.06], true),
    ];
    let mut fog = Fog::new(config).unwrap();
    let pose = Pose::<Map, _>::identity();
    for _ in 0..5 {
        let _ = fog
            .insert(&look(&blocks, &pose, camera(0.5, 0.7, 0.0)), &pose)
            .unwrap();
    }
    fog.view().at(0.54, 0.02)
}

#[test]
fn without_a_floor_of_its_own_a_cell_is_an_obstacle_where_it_stands_out_of_the_floor_beside_it() {
    let by_the_paper = FogConfig {
        floor_beside: 0.0,
        ..FogConfig::default()
    };
    assert_eq!(
        strip_between_floors(0.04, FogConfig::default()),
        Surface::Unknown
    );
    for (strip_m, config) in [
        (0.04, by_the_paper),
        (0.12, FogConfig::default()),
        (0.3, FogConfig::default()),
    ] {
        let found = strip_between_floors(strip_m, config);
        assert!(is_obstacle(found), "{strip_m}: {found:?}");
    }
}

#[test]
fn floor_in_a_shadow_still_clears_the_way_to_it() {
    let pose = Pose::<Map, _>::identity();
    let mut fog = Fog::new(FogConfig::default()).unwrap();
    let eye = camera(0.5, 0.6, 0.0);
    let see = |fog: &mut Fog, planes: &Planes| {
        let _ = fog.insert(planes, &pose).unwrap();
    };
    for _ in 0..10 {
        see(&mut fog, &look(&[WALL], &pose, eye));
    }
    let there = |fog: &Fog| fog.view().at(0.82, 0.02);
    assert!(is_obstacle(there(&fog)));
    for _ in 0..12 {
        see(&mut fog, &look(&[], &pose, eye));
    }
    assert!(
        matches!(there(&fog), Surface::Floor(_)),
        "{:?}",
        there(&fog)
    );
}

/// Looks at a level block of which every `smooth_every`-th frame finds the top as smooth as the ground, and the others twice as
/// rough; then what the map has in its middle.
fn block_that_is_smooth_every(smooth_every: usize, config: FogConfig) -> Surface {
    let block = Block::new([0.45, -0.2, 0.0], [0.75, 0.2, 0.1], true);
    let mut fog = Fog::new(config).unwrap();
    let pose = Pose::<Map, _>::identity();
    for frame in 0..20 {
        let mut planes = look(&[block], &pose, camera(0.5, 0.7, 0.0));
        for (label, height_m) in planes.labels.iter_mut().zip(&planes.floor_height_m) {
            *label = u16::from(*height_m > 0.05);
        }
        planes.regions.push(PlaneRegion {
            support: 1000,
            mean: Point::new(0.6, 0.0, 0.1),
            plane: Plane {
                normal: Vector3::z_axis(),
                distance_m: 0.1,
            },
            boundary: None,
            floor_height_m: Some(0.1),
            roughness: Some(if frame % smooth_every == 0 { 1.0 } else { 2.0 }),
        });
        let _ = fog.insert(&planes, &pose).unwrap();
    }
    fog.view().at(0.6, 0.02)
}

#[test]
fn what_most_frames_find_rough_is_an_obstacle_though_it_is_level() {
    let found = block_that_is_smooth_every(4, FogConfig::default());
    assert!(is_obstacle(found), "{found:?}");
    let without = FogConfig {
        rough: None,
        ..FogConfig::default()
    };
    for (smooth_every, config) in [(1, FogConfig::default()), (4, without)] {
        let found = block_that_is_smooth_every(smooth_every, config);
        assert!(matches!(found, Surface::Floor(_)), "{found:?}");
    }
}
