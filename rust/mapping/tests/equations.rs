//! Equations (1) to (11) of 000 on the grids themselves; (6), (7), (12), (13) and the ray are tested beside their code.

mod common;

use common::{Block, camera, look};
use geometry::{Cell, CellArea, Lattice, Map, Pose, Robot};
use mapping::surface::{FloorGrid, LabelledFrame, LabelledPoint};
use mapping::{Clearing, Fog, FogConfig, Surface, Update, WorldModel};
use proptest::prelude::*;
use volume::{OccupancyGrid, Placement, ProbabilityTable, Ray, Size};

const EYE: [f64; 3] = [0.0, 0.0, 0.5];

fn small() -> FogConfig {
    FogConfig {
        cells: 20,
        ..common::paper()
    }
}

fn lattice() -> Lattice {
    Lattice {
        origin_m: [-0.4, -0.4],
        cell_m: 0.04,
    }
}

fn grid() -> OccupancyGrid {
    let placement = Placement {
        lattice: lattice(),
        bottom_m: -0.02,
        layer_m: 0.04,
    };
    let size = Size {
        cols: 20,
        rows: 20,
        layers: 16,
    };
    OccupancyGrid::new(size, placement, ProbabilityTable::new(0.7, 0.7, 0.05, 0.95))
}

fn insert(grid: &mut OccupancyGrid, ends: &[[f64; 3]], update: Update) -> CellArea {
    let rays = ends.iter().map(|&end_m| Ray { end_m, hit: true });
    grid.insert(EYE, rays, update, Clearing::EveryRay)
}

fn frame_of(point: [f64; 3], height: f64) -> LabelledFrame {
    let mut frame = LabelledFrame::default();
    frame.eye_m = EYE;
    frame.points.push(LabelledPoint {
        position_m: point,
        floor_height_m: height,
        hit: true,
        rough: None,
        pixel: 0,
        label: 0,
    });
    frame.locate(&lattice(), [20, 20]);
    frame
}

fn point() -> impl Strategy<Value = [f64; 3]> {
    (-0.5..0.5f64, -0.5..0.5f64, -0.1..0.6f64).prop_map(|(x, y, z)| [x, y, z])
}

fn center(col: i32, row: i32, layer: i32) -> [f64; 3] {
    let [x, y] = lattice().center_of(Cell::new(col, row));
    [x, y, f64::from(layer) * 0.04]
}

/// All centres of voxels.
fn centers() -> impl Iterator<Item = (Cell, [f64; 3])> {
    (0..20 * 20 * 16).map(|i| {
        let (col, row, layer) = (i % 20, i / 20 % 20, i / 400);
        (Cell::new(col, row), center(col, row, layer))
    })
}

#[test]
fn equation_4_a_fresh_map_is_even_and_invalid_inside_and_outside() {
    let grid = grid();
    assert!(centers().all(|(_, at)| grid.probability(at) == 0.5 && !grid.is_occupied(at)));
    for outside in [
        [5.0, 0.0, 0.1],
        [0.0, -5.0, 0.1],
        [0.0, 0.0, -0.03],
        [0.0, 0.0, 0.7],
    ] {
        assert_eq!(grid.probability(outside), 0.5);
    }
    let floor = FloorGrid::new(lattice(), &small());
    assert!((-2..22).all(|i| floor.height(Cell::new(i, i)).is_none()));
}

#[test]
fn equation_3_the_support_of_a_floor_is_the_probability_at_its_height() {
    let mut grid = grid();
    let end = center(12, 9, 1);
    for _ in 0..3 {
        let _ = insert(&mut grid, &[end], Update::PerFrame);
    }
    let [x, y, _] = end;
    for i in 0..=100 {
        let height = -0.1 + 0.008 * f64::from(i) + 0.0001;
        let layer = ((height + 0.02) / 0.04).floor();
        let expected = if (0.0..16.0).contains(&layer) {
            grid.probability([x, y, layer * 0.04])
        } else {
            0.5
        };
        assert_eq!(grid.probability([x, y, height]), expected);
    }
    assert!(grid.probability(end) > 0.9);
}

#[test]
fn equation_7_one_hit_does_not_exceed_the_threshold_and_two_do() {
    let mut grid = grid();
    let end = center(12, 9, 0);
    let _ = insert(&mut grid, &[end], Update::PerFrame);
    assert!((grid.probability(end) - 0.7).abs() < 1e-12 && !grid.is_occupied(end));
    let _ = insert(&mut grid, &[end], Update::PerFrame);
    assert!(grid.is_occupied(end));
}

#[test]
fn per_frame_a_voxel_changes_once_and_a_hit_wins() {
    let mut grid = grid();
    let near = center(12, 9, 1);
    // The second ray passes the first one's voxel on its way down.
    let beyond: [f64; 3] = std::array::from_fn(|a| EYE[a] + (near[a] - EYE[a]) * 1.08);
    let _ = insert(&mut grid, &[near, near, beyond], Update::PerFrame);
    assert!((grid.probability(near) - 0.7).abs() < 1e-12);
    let mut literal = self::grid();
    let _ = insert(&mut literal, &[near, near, near, beyond], Update::PerPoint);
    assert!(
        (literal.probability(near) - 0.5 - 0.3448).abs() < 1e-3,
        "three hits, one miss"
    );
}

#[test]
fn equation_8_a_floor_without_support_is_forgotten_and_others_stay() {
    let (mut grid, mut floor) = (grid(), FloorGrid::new(lattice(), &small()));
    let (here, there) = (center(12, 9, 1), center(5, 5, 1));
    for _ in 0..2 {
        let _ = insert(&mut grid, &[here, there], Update::PerFrame);
    }
    for at in [here, there] {
        floor.update(&frame_of(at, at[2]), &grid, Update::PerFrame);
    }
    let (lost, kept) = (Cell::new(12, 9), Cell::new(5, 5));
    let before = floor.clone();
    floor.verify(&grid, floor.heights.area());
    assert_eq!(
        floor, before,
        "what is supported stays as it was, bit by bit"
    );
    let beyond = std::array::from_fn(|a| EYE[a] + (here[a] - EYE[a]) * 1.08);
    let touched = insert(&mut grid, &[beyond], Update::PerFrame);
    assert!(
        (grid.probability(here) - 0.7).abs() < 1e-9,
        "falls to the threshold, not below"
    );
    floor.verify(&grid, touched);
    assert_eq!(floor.height(lost), None);
    assert_eq!(floor.height(kept), before.height(kept));
}

#[test]
fn equation_9_an_unsupported_height_is_ignored() {
    let (grid, mut floor) = (grid(), FloorGrid::new(lattice(), &small()));
    let at = center(12, 9, 1);
    floor.update(&frame_of(at, at[2]), &grid, Update::PerFrame);
    assert_eq!(floor.height(Cell::new(12, 9)), None);
}

/// A grid that is occupied at these layers of the cell in column 12 and row 10.
fn supporting(layers: &[i32]) -> OccupancyGrid {
    let mut occupancy = grid();
    for &layer in layers {
        for _ in 0..5 {
            let _ = insert(&mut occupancy, &[center(12, 10, layer)], Update::PerPoint);
        }
    }
    occupancy
}

#[test]
fn equation_9_a_lower_height_seen_from_nearer_puts_right_what_the_occupancy_grid_cannot() {
    let (cell, occupancy) = (Cell::new(12, 10), supporting(&[0, 1, 2]));
    let [x, y] = lattice().center_of(cell);
    let seen = |heights_and_distances: &[(f64, f64)], update: Update| {
        let mut floor = FloorGrid::new(lattice(), &small());
        for &(height, distance) in heights_and_distances {
            let mut frame = frame_of([x, y, height], height);
            frame.eye_m = [x - distance, y, 0.5];
            floor.update(&frame, &occupancy, update);
        }
        (floor.height(cell).unwrap(), floor.sightings(cell))
    };
    let per_frame = |seen_so: &[(f64, f64)]| seen(seen_so, Update::PerFrame);
    // Two treads that ran into each other.
    assert_eq!(per_frame(&[(0.061, 1.1), (0.031, 0.5)]), (0.031, 1));
    // Not from as near as the higher one was seen.
    assert_eq!(per_frame(&[(0.061, 1.1), (0.031, 1.0)]), (0.061, 1));
    assert_eq!(per_frame(&[(0.061, 1.1), (0.061, 0.5), (0.031, 0.5)]).1, 2);
    // A table, and what lies below it.
    assert_eq!(per_frame(&[(0.061, 1.1), (0.01, 0.5)]), (0.061, 1));
    // The paper's own.
    assert_eq!(
        seen(&[(0.061, 1.1), (0.031, 0.5)], Update::PerPoint),
        (0.061, 1)
    );
}

#[test]
fn a_higher_floor_in_a_cell_has_none_of_the_sightings_of_the_one_below() {
    let (cell, occupancy) = (Cell::new(12, 10), supporting(&[0, 2]));
    let [x, y] = lattice().center_of(cell);
    for update in [Update::PerFrame, Update::PerPoint] {
        let mut floor = FloorGrid::new(lattice(), &small());
        let mut sightings_of = |height: f64| {
            let mut frame = frame_of([x, y, height], height);
            frame.eye_m = [x - 0.5, y, 0.5];
            floor.update(&frame, &occupancy, update);
            floor.sightings(cell)
        };
        let found = [0.0, 0.0, 0.0, 0.07, 0.07, 0.0].map(&mut sightings_of);
        assert_eq!(found, [1, 2, 3, 1, 2, 2], "{update:?}");
    }
}

#[test]
fn floor_seen_from_beyond_the_sure_range_is_kept_but_counts_as_no_sighting() {
    let (cell, occupancy) = (Cell::new(12, 10), supporting(&[0]));
    let [x, y] = lattice().center_of(cell);
    let mut floor = FloorGrid::new(lattice(), &small());
    let mut sightings_from = |distance: f64| {
        let mut frame = frame_of([x, y, 0.0], 0.0);
        frame.eye_m = [x - distance, y, 0.5];
        floor.update(&frame, &occupancy, Update::PerFrame);
        assert_eq!(floor.height(cell), Some(0.0));
        floor.sightings(cell)
    };
    assert_eq!([1.3, 1.1, 1.3, 1.1].map(&mut sightings_from), [0, 1, 1, 2]);
}

#[test]
fn equation_9_is_applied_once_a_cell_and_frame() {
    let (mut grid, mut floor) = (grid(), FloorGrid::new(lattice(), &small()));
    let at = center(12, 9, 1);
    for _ in 0..2 {
        let _ = insert(&mut grid, &[at], Update::PerFrame);
    }
    floor.update(&frame_of(at, 0.040), &grid, Update::PerFrame);
    let mut frame = frame_of(at, 0.050);
    frame.points = vec![frame.points[0]; 50];
    frame.locate(&lattice(), [20, 20]);
    floor.update(&frame, &grid, Update::PerFrame);
    let height = floor.height(Cell::new(12, 9)).unwrap();
    assert!((height - 0.041).abs() < 1e-6, "{height}");
    assert_eq!(floor.sightings(Cell::new(12, 9)), 2);
}

proptest! {
    #[test]
    fn equation_10_is_the_highest_occupied_voxel(ends in prop::collection::vec(point(), 1..60), per_point in any::<bool>()) {
        let update = if per_point { Update::PerPoint } else { Update::PerFrame };
        let mut grid = grid();
        for _ in 0..3 { let _ = insert(&mut grid, &ends, update); }
        let mut highest = std::collections::BTreeMap::new();
        for (cell, at) in centers() {
            prop_assert!((0.0..=1.0).contains(&grid.probability(at)));
            prop_assert_eq!(grid.is_occupied(at), grid.probability(at) > 0.7 + 1e-9);
            if grid.is_occupied(at) { let _ = highest.insert(cell, at[2]); }
        }
        for (cell, _) in centers() {
            match (grid.obstacle_height_at(cell.row as usize * 20 + cell.col as usize), highest.get(&cell)) {
                (None, None) => {}
                (Some(found), Some(&wanted)) => prop_assert!((found - wanted).abs() < 1e-9),
                other => prop_assert!(false, "{:?}", other),
            }
        }
    }

    #[test]
    fn what_hangs_above_a_height_is_the_lowest_occupied_voxel_there(
        ends in prop::collection::vec(point(), 1..60), height in -0.1..0.6f64,
    ) {
        let mut grid = grid();
        for _ in 0..3 { let _ = insert(&mut grid, &ends, Update::PerFrame); }
        let mut lowest = std::collections::BTreeMap::new();
        for (cell, at) in centers().filter(|&(_, at)| grid.is_occupied(at) && at[2] > height) {
            let _ = lowest.entry(cell).and_modify(|low: &mut f64| *low = low.min(at[2])).or_insert(at[2]);
        }
        for (cell, _) in centers() {
            match (grid.lowest_above_m(cell, height), lowest.get(&cell)) {
                (None, None) => {}
                (Some(found), Some(&wanted)) => prop_assert!((found - wanted).abs() < 1e-9),
                other => prop_assert!(false, "{:?}", other),
            }
        }
    }

    #[test]
    fn only_the_affected_area_changes_and_it_is_no_larger_than_needed(ends in prop::collection::vec(point(), 1..20)) {
        let mut grid = grid();
        let area = insert(&mut grid, &ends, Update::PerFrame);
        let mut needed = CellArea::EMPTY;
        for (cell, at) in centers() {
            if grid.probability(at) != 0.5 {
                prop_assert!(area.contains(cell));
                needed.include(cell);
            }
        }
        prop_assert_eq!(area, needed);
    }

    #[test]
    fn the_order_of_a_frames_rays_is_irrelevant(ends in prop::collection::vec(point(), 1..40)) {
        let (mut forth, mut back) = (grid(), grid());
        let _ = insert(&mut forth, &ends, Update::PerFrame);
        let reversed: Vec<_> = ends.into_iter().rev().collect();
        let _ = insert(&mut back, &reversed, Update::PerFrame);
        prop_assert_eq!(forth, back);
    }

    #[test]
    fn shifting_moves_every_voxel_and_what_comes_in_is_even(
        ends in prop::collection::vec(point(), 1..20), by in (-6..7i32, -6..7i32, -5..6i32),
    ) {
        let mut grid = grid();
        for _ in 0..2 { let _ = insert(&mut grid, &ends, Update::PerFrame); }
        let before = grid.clone();
        grid.shift(by.0, by.1, by.2);
        let origin = grid.placement.lattice.origin_m;
        let bottom = grid.placement.bottom_m;
        for (cell, at) in centers() {
            // The same place of the map, before and after; 0.5 where it was outside before.
            let layer = ((at[2] + 0.02) / 0.04).floor();
            let place = [
                origin[0] + (f64::from(cell.col) + 0.5) * 0.04,
                origin[1] + (f64::from(cell.row) + 0.5) * 0.04,
                bottom + (layer + 0.5) * 0.04,
            ];
            prop_assert_eq!(grid.probability(place), before.probability(place));
            prop_assert_eq!(grid.is_occupied(place), before.is_occupied(place));
        }
    }

    #[test]
    fn equation_11_in_the_affected_area_equals_all_over(steps in prop::collection::vec(
        (-0.2..0.2f64, -0.2..0.2f64, -0.05..0.05f64, -1.0..1.0f64, 0.2..0.9f64, -0.8..0.8f64), 1..12,
    ), headroom in prop::option::of(0.1..0.5f64)) {
        let blocks = [
            Block::new([0.4, -0.2, 0.0], [0.6, 0.1, 0.06], true),
            Block::new([0.5, 0.3, 0.0], [0.6, 0.5, 0.3], false),
            Block::new([-0.7, -0.3, 0.3], [-0.5, 0.5, 0.5], false),
        ];
        let config = FogConfig { cells: 50, max_range: 1.5, headroom, ..FogConfig::default() };
        let mut fog = Fog::new(config).unwrap();
        let (mut x, mut y, mut z, mut yaw) = (0.0, 0.0, 0.0, 0.0);
        for (dx, dy, dz, turn, pitch, pan) in steps {
            (x, y, z, yaw) = (x + dx, y + dy, z + dz, yaw + turn);
            let pose = Pose::<Map, Robot>::from_yaw(x, y, z, yaw);
            let before = fog.view().clone();
            let insertion = fog.insert(&look(&blocks, &pose, camera(0.5, pitch, pan)), &pose).unwrap();
            let (view, ceilings) = (fog.view(), fog.ceilings().unwrap());
            for cell in view.cells.area().cells() {
                let surface = view.cell(cell);
                prop_assert_eq!(surface, fog.surface(cell));
                prop_assert_eq!(view.sightings.get(cell).copied(), Some(fog.floor.sightings(cell)));
                let ceiling_m = ceilings.get(cell).copied().unwrap();
                prop_assert_eq!((!ceiling_m.is_nan()).then_some(ceiling_m), fog.ceiling_m(cell).map(|m| m as f32));
                match surface {
                    Surface::Floor(h) | Surface::Obstacle(h) => prop_assert!(h.is_finite()),
                    Surface::Unknown => {}
                }
                prop_assert!(insertion.changed.contains(cell) || before.cell(cell) == surface);
            }
        }
    }
}
