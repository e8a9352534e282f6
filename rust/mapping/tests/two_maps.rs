//! The two maps of 002 on simulated worlds: M7 to M9, M-Q8, M-Q10 and M-Q13, and what goes away.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use std::sync::Arc;

use common::{Block, camera, interior, is_obstacle, look};
use geometry::{Map, Pose, Robot};
use known_map::{KnownMap, KnownMapConfig};
use mapping::{FogConfig, MapError, Surface, TwoMaps, TwoMapsConfig, Update, WorldModel};
use proptest::prelude::*;
use segmentation::Planes;
use volume::Ray;
use volume::octree::{Octree, OctreeConfig};

const VOXEL_M: f64 = 0.04;

fn config(resolution: f64) -> TwoMapsConfig {
    TwoMapsConfig {
        resolution,
        ..TwoMapsConfig::default()
    }
}

fn known(tree: Octree) -> KnownMap {
    KnownMap::new(Arc::new(tree), KnownMapConfig::default()).unwrap()
}

fn maps(resolution: f64, static_map: Option<Octree>) -> TwoMaps {
    let floors = FogConfig::default();
    TwoMaps::new(config(resolution), &floors, static_map.map(known).as_ref()).unwrap()
}

/// A map in which the voxels with their middle in a block are occupied, and those below the ground.
fn told(blocks: &[Block]) -> Octree {
    let mut tree = Octree::new(OctreeConfig::default()).unwrap();
    let ground = Block::new([-1.0, -1.0, -VOXEL_M], [2.0, 1.0, 0.0], true);
    let mut rays = Vec::new();
    for block in blocks.iter().chain([&ground]) {
        let voxels = |axis: usize| {
            let [low, high] = [block.min, block.max].map(|at| (at[axis] / VOXEL_M - 0.5).ceil());
            low as i32..high as i32
        };
        for (x, y) in voxels(0).flat_map(|x| voxels(1).map(move |y| (x, y))) {
            rays.extend(voxels(2).map(|z| Ray {
                end_m: [x, y, z].map(|at| (f64::from(at) + 0.5) * VOXEL_M),
                hit: true,
            }));
        }
    }
    for ray in rays {
        let _beyond = tree.insert(ray.end_m, &[ray], Update::PerPoint).unwrap();
    }
    tree
}

fn at(x_m: f64, y_m: f64, z_m: f64) -> Pose<Map, Robot> {
    Pose::from_yaw(x_m, y_m, z_m, 0.0)
}

/// Looks ahead and down and to both sides until everything in view was seen several times.
fn look_around(maps: &mut TwoMaps, blocks: &[Block], map_from_robot: &Pose<Map, Robot>) {
    for pan in [0.0, 0.4, -0.4] {
        for pitch in [0.0, 0.4, 0.8, 0.0, 0.4, 0.8] {
            let planes = look(blocks, map_from_robot, camera(0.5, pitch, pan));
            let _ = maps.insert(&planes, map_from_robot).unwrap();
        }
    }
}

#[test]
fn no_voxel_of_the_floor_is_occupied_and_tops_of_boxes_are_kept() {
    let box_ = Block::new([0.8, -0.1, 0.0], [1.0, 0.1, 0.05], true);
    for resolution in [0.04, 0.02] {
        let mut maps = maps(resolution, None);
        look_around(&mut maps, &[box_], &at(0.0, 0.0, 0.0));
        let (mut floor, mut occupied) = (0, 0);
        let local = &maps.local;
        for x in 0..100 {
            for y in -50..50 {
                let place = [0.3 + 0.02 * f64::from(x), 0.02 * f64::from(y) + 0.01];
                if place[0] > 0.75 && place[0] < 1.05 && place[1].abs() < 0.15 {
                    continue;
                }
                for z in [-0.01, 0.01] {
                    let seen = local.is_occupied_at([place[0], place[1], z]);
                    floor += u32::from(seen.is_some());
                    occupied += u32::from(seen == Some(true));
                }
            }
        }
        assert!(floor > 5000, "{floor}");
        assert_eq!(occupied, 0, "of {floor}");
        for cell in interior(maps.view(), [0.8, -0.1], [1.0, 0.1]) {
            let [x_m, y_m] = maps.view().lattice.center_of(cell);
            assert_eq!(
                local.is_occupied_at([x_m, y_m, 0.05]),
                Some(true),
                "{cell:?}"
            );
        }
    }
}

#[test]
fn what_is_five_centimetres_high_is_found_and_nothing_else() {
    // Of boxes with a top to step on, and of a thing without.
    for (flat, resolution) in [(true, 0.04), (false, 0.04), (true, 0.02), (false, 0.02)] {
        let low = [
            Block::new([0.8, -0.3, 0.0], [0.92, -0.18, 0.05], flat),
            Block::new([1.2, 0.2, 0.0], [1.3, 0.3, 0.05], flat),
        ];
        let mut maps = maps(resolution, None);
        look_around(&mut maps, &low, &at(0.0, 0.0, 0.0));
        look_around(&mut maps, &low, &at(0.2, 0.0, 0.0));
        let view = maps.view();
        for block in low {
            for cell in interior(
                view,
                [block.min[0], block.min[1]],
                [block.max[0], block.max[1]],
            ) {
                match view.cell(cell) {
                    Surface::Obstacle(_) => {}
                    Surface::Floor(h) => assert!(flat && (h - 0.05).abs() < 1e-3, "{h}"),
                    Surface::Unknown => panic!("{cell:?} is not known"),
                }
            }
        }
        let off = |x: f64, y: f64| {
            low.iter().any(|block| {
                let beside = |a: usize, v: f64| v > block.min[a] - 0.08 && v < block.max[a] + 0.08;
                beside(0, x) && beside(1, y)
            })
        };
        for cell in view.cells.area().cells() {
            let [x, y] = view.lattice.center_of(cell);
            assert!(off(x, y) || !is_obstacle(view.cell(cell)), "at {x} {y}");
        }
    }
}

/// Cells with an obstacle before a wall whose near face is at x = 1.8 m, after looks from a place by a robot that believes to be 3 cm
/// and 1.7 degrees off; static map or not.
fn before_the_wall(static_map: Option<Octree>, blocks: &[Block], truly: [f64; 2]) -> Vec<[f64; 2]> {
    let mut maps = maps(VOXEL_M, static_map);
    let [x_m, y_m] = truly;
    let truth = at(x_m, y_m, 0.0);
    let believed = Pose::from_yaw(x_m - 0.03, y_m, 0.0, 0.03);
    for pitch in [0.2, 0.4, 0.6, 0.2, 0.4, 0.6] {
        let planes = look(blocks, &truth, camera(0.5, pitch, 0.0));
        let _ = maps.insert(&planes, &believed).unwrap();
    }
    let view = maps.view();
    let cells = view.cells.area().cells();
    let places = cells.filter(|cell| is_obstacle(view.cell(*cell)));
    let places = places.map(|cell| view.lattice.center_of(cell));
    places.filter(|place| place[0] < 1.8).collect()
}

#[test]
fn a_wall_that_was_told_does_not_stand_beside_itself_seen_from_afar() {
    let wall = Block::new([1.8, -1.0, 0.0], [1.96, 1.0, 0.5], false);
    let thing = Block::new([1.4, -0.2, 0.0], [1.52, -0.04, 0.2], false);
    let panel = Block::new([1.72, -0.2, 0.0], [1.8, 0.2, 0.4], false);
    let far = [0.0, 0.0];
    assert!(!before_the_wall(None, &[wall], far).is_empty());
    let seen = before_the_wall(Some(told(&[wall])), &[wall, thing], far);
    assert!(!seen.is_empty());
    for [x, y] in seen {
        assert!(
            (1.3..1.6).contains(&x) && (-0.3..0.1).contains(&y),
            "{x} {y}"
        );
    }
    // What is flat against the wall is seen from near by.
    let near = before_the_wall(Some(told(&[wall])), &[wall, panel], [0.9, 0.0]);
    assert!(!near.is_empty());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn what_is_projected_frame_by_frame_is_the_projection_of_both_maps(
        steps in prop::collection::vec((prop::array::uniform3(-0.15..0.15_f64), 0.0..0.9_f64, -0.6..0.6_f64, any::<bool>()), 1..10),
        known in any::<bool>(),
    ) {
        let table = Block::new([0.9, -0.4, 0.7], [1.4, 0.4, 0.74], true);
        let still = [Block::new([0.7, 0.2, 0.0], [0.9, 0.5, 0.3], false), Block::new([0.8, -0.7, 0.0], [1.2, -0.3, 0.12], true), table];
        let visitor = Block::new([0.6, -0.2, 0.0], [0.8, 0.0, 0.5], false);
        let mut maps = maps(0.04, known.then(|| told(&still)));
        let mut robot_m = [0.0; 3];
        for (step, pitch, pan, visited) in steps {
            for a in 0..3 { robot_m[a] += step[a]; }
            let pose = at(robot_m[0], robot_m[1], 0.2 * robot_m[2]);
            let mut blocks = still.to_vec();
            if visited { blocks.push(visitor); }
            let planes = look(&blocks, &pose, camera(0.5, pitch, pan));
            let before = maps.view().clone();
            let insertion = maps.insert(&planes, &pose).unwrap();
            prop_assert_eq!(&maps.projected(), maps.view());
            if before.lattice == maps.view().lattice {
                for cell in before.cells.area().cells().filter(|&cell| !insertion.changed.contains(cell)) {
                    prop_assert_eq!(before.cell(cell), maps.view().cell(cell));
                }
            }
        }
    }
}

#[test]
fn both_maps_block_and_what_is_seen_does_not_erase_what_was_told() {
    let shelf = Block::new([0.8, 0.2, 0.0], [0.96, 0.4, 0.3], false);
    let basket = Block::new([0.8, -0.4, 0.0], [0.96, -0.2, 0.3], false);
    let mut maps = maps(VOXEL_M, Some(told(&[shelf])));
    let pose = at(0.0, 0.0, 0.0);
    let shown = |maps: &TwoMaps, y_m: f64| maps.view().at(0.82, y_m);
    // The shelf has been carried away, but nobody told the robot.
    for _ in 0..20 {
        look_around(&mut maps, &[basket], &pose);
    }
    assert!(
        maps.local.is_occupied_at([0.82, 0.3, 0.1]) == Some(false),
        "it is seen that nothing is there"
    );
    assert!(is_obstacle(shown(&maps, 0.3)), "and it blocks all the same");
    assert!(is_obstacle(shown(&maps, -0.3)));
    for _ in 0..2 {
        look_around(&mut maps, &[], &pose);
    }
    assert!(
        !is_obstacle(shown(&maps, -0.3)),
        "what was only seen is erased"
    );
    maps.forget();
    let nothing = Planes::new(0);
    let _ = maps.insert(&nothing, &pose).unwrap();
    assert!(is_obstacle(shown(&maps, 0.3)));
}

#[test]
fn where_nothing_was_seen_the_static_map_tells_the_floor() {
    let stairs = (0..4).map(|i| {
        let i = f64::from(i);
        Block::new(
            [0.4 + 0.16 * i, -0.4, 0.04 * i],
            [1.6, 0.4, 0.04 * (i + 1.0)],
            true,
        )
    });
    let box_ = Block::new([-0.8, 0.4, 0.0], [-0.6, 0.6, 0.2], false);
    let blocks: Vec<_> = stairs.chain([box_]).collect();
    let mut maps = maps(VOXEL_M, Some(told(&blocks)));
    let _ = maps.insert(&Planes::new(0), &at(0.0, 0.0, 0.003)).unwrap();
    let view = maps.view();
    assert_eq!(view.at(-0.5, -0.5), Surface::Floor(0.003), "its own level");
    assert_eq!(
        view.at(1.4, 0.0),
        Surface::Floor(0.16),
        "what stairs lead to"
    );
    assert_eq!(view.at(0.64, 0.0), Surface::Floor(0.08));
    assert!(is_obstacle(view.at(-0.7, 0.5)), "what nothing leads to");
    assert_eq!(view.at(2.02, 0.0), Surface::Unknown, "beyond the map");
    assert!(view.sightings.values().iter().all(|&seen| seen == 0));
    let before = view.lattice;
    let _ = maps.insert(&Planes::new(0), &at(1.4, 0.0, 0.16)).unwrap();
    assert_eq!(
        maps.view().lattice,
        before,
        "the window holds the map and stays"
    );
    assert_eq!(maps.view().at(1.5, 0.3), Surface::Floor(0.16));
    assert_eq!(maps.view().at(-0.5, -0.5), Surface::Floor(0.0));
}

#[test]
fn a_pose_that_cannot_be_changes_nothing() {
    let mut maps = maps(VOXEL_M, None);
    let pose = at(0.0, 0.0, 0.0);
    let planes = look(&[], &pose, camera(0.5, 0.6, 0.0));
    let _ = maps.insert(&planes, &pose).unwrap();
    let before = (maps.view().clone(), maps.local.clone());
    for bad in [f64::NAN, f64::INFINITY] {
        let error = maps.insert(&planes, &at(bad, 0.0, 0.0)).unwrap_err();
        assert_eq!(error, MapError::PoseNotFinite);
    }
    let error = maps.insert(&planes, &at(1e9, 0.0, 0.0)).unwrap_err();
    assert!(matches!(error, MapError::Failed(_)));
    assert_eq!((maps.view().clone(), maps.local.clone()), before);
}

/// What takes seconds: not in the fast part of the tests.
mod slow {
    use super::*;

    #[test]
    fn a_deck_is_passed_under_and_walked_on_where_it_is_high_enough() {
        for (underside_m, known, seen, passes) in [
            (0.70, true, false, true),
            (0.65, true, false, true),
            (0.50, true, false, false),
            (0.70, false, true, true),
            (0.65, false, true, true),
            (0.50, false, true, false),
            (0.70, true, true, true),
            (0.50, true, true, false),
        ] {
            for resolution in [0.04, 0.02] {
                let deck = Block::new(
                    [0.6, -0.8, underside_m],
                    [1.4, 0.8, underside_m + 0.06],
                    true,
                );
                let mut maps = maps(resolution, known.then(|| told(&[deck])));
                let below = at(0.0, 0.0, 0.0);
                if seen {
                    look_around(&mut maps, &[deck], &below);
                    look_around(&mut maps, &[deck], &at(0.3, 0.0, 0.0));
                } else {
                    let _ = maps.insert(&Planes::new(0), &below).unwrap();
                }
                let case = format!("{underside_m} m, told {known}, seen {seen}, {resolution}");
                // Only the rim is seen from below.
                let surface = maps.view().at(if seen { 0.62 } else { 0.82 }, 0.02);
                if passes {
                    assert!(
                        matches!(surface, Surface::Floor(h) if h.abs() < 0.01),
                        "{surface:?}: {case}"
                    );
                } else {
                    assert!(is_obstacle(surface), "{surface:?}: {case}");
                }
                let above = at(0.8, 0.0, underside_m + 0.06);
                look_around(&mut maps, &[deck], &above);
                let surface = maps.view().at(1.22, 0.02);
                let top = (underside_m + 0.06) as f32;
                assert!(
                    matches!(surface, Surface::Floor(h) if (h - top).abs() < 0.03),
                    "{surface:?} on top: {case}"
                );
            }
        }
    }
}

#[test]
fn a_static_map_that_would_be_cut_into_too_many_voxels_is_refused() {
    // One leaf at the root, of a kilometre: solid throughout.
    let bytes = b"# Octomap OcTree file\nid OcTree\nsize 1\nres 0.02\ndata\n";
    let bytes = [&bytes[..], &2.0_f32.to_le_bytes(), &[0]].concat();
    let whole = Octree::from_bytes("whole.ot", &bytes).unwrap();
    let floors = FogConfig::default();
    let refused = TwoMaps::new(config(0.04), &floors, Some(&known(whole)));
    let said = refused.unwrap_err().to_string();
    let allowed = "navigation.octree.resolution must be so coarse that the static map has";
    assert!(said.starts_with(allowed), "{said}");
}

#[test]
fn with_a_window_as_large_as_there_is_a_static_map_is_looked_at_around_the_robot() {
    let floors = FogConfig {
        cells: 1990,
        layers: 2,
        layers_below: 1,
        ..FogConfig::default()
    };
    let told = known(told(&[]));
    let maps = TwoMaps::new(config(VOXEL_M), &floors, Some(&told)).unwrap();
    assert_eq!(maps.view().cells.cols(), 1990);
}
