//! The map of samples in a sparse grid: how many it needs, what they cost, and its view (004, section 36.3.2; H35, H36, H39).

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use std::collections::BTreeSet;

use common::{Block, DEPTH_CAMERA, camera, interior, look_through};
use geometry::{Cell, Map, Pose, Robot, SplitMix64};
use mapping::{ElevationConfig, Points, PointsConfig, Surface, SurfaceSamples, WorldModel};
use segmentation::Planes;

const CELL_M: f64 = 0.04;

fn model() -> Points {
    let config = PointsConfig::default();
    Points::new(config, ElevationConfig::default(), Some(0.58)).unwrap()
}

fn home() -> Pose<Map, Robot> {
    Pose::from_yaw(0.0, 0.0, 0.0, 0.0)
}

fn seen(blocks: &[Block], pitches: &[f64], times: usize) -> Points {
    let mut map = model();
    for _ in 0..times {
        for &pitch in pitches {
            let planes = look_through(DEPTH_CAMERA, blocks, &home(), camera(0.5, pitch, 0.0));
            assert!(map.insert(&planes, &home()).unwrap().used);
        }
    }
    map
}

/// Normal, by twelve uniform ones.
fn normal(random: &mut SplitMix64) -> f64 {
    (0..12).map(|_| random.uniform()).sum::<f64>() - 6.0
}

/// Height of the ground of the scene: a step, a slope, else level at a height that is on no border of cells.
fn truth_m([x, y]: [f64; 2]) -> f64 {
    if y > 1.0 {
        0.013 + 0.3 * (y - 1.0)
    } else if x > 1.02 {
        0.093
    } else {
        0.013
    }
}

/// Points on the ground of 2 m by 2 m, each with noise of 4 mm; and the cells of a 3D grid in which they lie.
fn ground(seed: u64, flat_m: f64) -> (SurfaceSamples, BTreeSet<[i64; 3]>) {
    let mut random = SplitMix64::new(seed);
    let mut samples = SurfaceSamples::new(CELL_M, 3.0, flat_m);
    let mut occupied = BTreeSet::new();
    for _frame in 0..12 {
        for _ in 0..10_000 {
            let at = [2.0 * random.uniform(), 2.0 * random.uniform()];
            let z = truth_m(at) + 0.004 * normal(&mut random);
            let point = [at[0], at[1], z];
            samples.add(point, 0.004 * 0.004, true);
            let _ = occupied.insert(point.map(|at| (at / CELL_M).floor() as i64));
        }
        samples.end_frame();
    }
    (samples, occupied)
}

/// Root mean square of the errors of the heights that columns have, m, but for those that the step runs through.
fn error_m(samples: &SurfaceSamples) -> f64 {
    let (mut sum, mut count) = (0.0, 0);
    samples.spans(3, 0.5, |column, span| {
        let centre = column.map(|at| (f64::from(at) + 0.5) * CELL_M);
        if (centre[0] - 1.02).abs() > CELL_M || centre[1] > 1.0 {
            sum += (f64::from(span.high_m) - truth_m(centre)).powi(2);
            count += 1;
        }
    });
    assert!(count > 2000, "{count}");
    (sum / f64::from(count)).sqrt()
}

#[test]
fn no_less_true_than_a_sample_a_cell_with_two_thirds_of_the_elements_of_the_grid() {
    for seed in 0..10 {
        let (adaptive, occupied) = ground(seed, PointsConfig::default().flat);
        let (each, _) = ground(seed, 0.0);
        let (ours, theirs) = (error_m(&adaptive), error_m(&each));
        assert!(ours <= theirs, "{ours} {theirs}");
        let (few, many) = (adaptive.count(), occupied.len());
        assert!(3 * few <= 2 * many, "{few} {many}");
    }
}

#[test]
fn what_they_take_is_in_proportion_to_what_was_seen_not_to_the_space_around_it() {
    let bytes = |apart_m: f64, places: usize| {
        let mut samples = SurfaceSamples::new(CELL_M, 3.0, 0.004);
        for place in 0..places {
            let x_m = apart_m * place as f64;
            samples.add([x_m, -x_m, 0.5 * x_m], 1e-4, true);
        }
        assert_eq!(samples.count(), places);
        samples.bytes() as f64 / places as f64
    };
    let near = bytes(0.2, 3000);
    assert!((bytes(100.0, 3000) / near - 1.0).abs() < 0.1);
    assert!((bytes(0.2, 3000 * 16) / near - 1.0).abs() < 0.5);
}

#[test]
fn the_order_of_insertion_of_far_places_does_not_matter_to_what_is_known_there() {
    let points: Vec<_> = (0..400)
        .map(|at| [0.3 * f64::from(at), 1.0, 0.02])
        .collect();
    let spans = |points: &mut dyn Iterator<Item = &[f64; 3]>| {
        let mut samples = SurfaceSamples::new(CELL_M, 3.0, 0.004);
        points.for_each(|&point| samples.add(point, 1e-4, true));
        samples.end_frame();
        let mut all = Vec::new();
        samples.spans(1, 0.5, |column, span| {
            all.push((column, span.high_m.to_bits()));
        });
        all.sort_unstable();
        all
    };
    assert_eq!(spans(&mut points.iter()), spans(&mut points.iter().rev()));
}

/// A frame of points in the map frame; no picture.
fn frame(points: &[[f64; 3]]) -> Planes {
    let mut planes = Planes::new(points.len());
    planes.robot_from_camera = camera(0.5, 0.3, 0.0);
    planes.reliable = true;
    for (slot, point) in planes.points_in_robot_m.iter_mut().zip(points) {
        *slot = point.map(|at| at as f32);
    }
    planes
}

#[test]
fn scattered_plants_cost_less_than_a_wall_as_high() {
    for seed in 0..10 {
        let mut random = SplitMix64::new(seed);
        let mut map = model();
        for _ in 0..6 {
            let mut points = Vec::new();
            for _ in 0..6000 {
                points.push([2.0 * random.uniform(), 2.0 * random.uniform() - 1.0, 0.0]);
            }
            for _ in 0..1500 {
                let [u, v, w] = [0; 3].map(|_| random.uniform());
                // A wall that looks towards the robot, and a bush; both 0.3 m high and as wide.
                points.push([1.0 + 0.004 * normal(&mut random), 0.3 + 0.4 * u, 0.3 * v]);
                points.push([0.9 + 0.3 * u, -0.7 + 0.4 * v, 0.3 * w]);
            }
            let _ = map.insert(&frame(&points), &home()).unwrap();
        }
        let costs = |min: [f64; 2], max: [f64; 2]| {
            let cells = interior(map.view(), min, max);
            let costs: Vec<f32> = cells.iter().filter_map(|&cell| map.cost(cell)).collect();
            assert!(costs.len() * 20 >= cells.len() * 19);
            costs
        };
        let wall = costs([0.96, 0.36], [1.04, 0.64]);
        let bush = costs([0.96, -0.64], [1.14, -0.36]);
        let level = costs([0.3, -0.9], [0.7, 0.9]);
        let mean = |costs: &[f32]| costs.iter().sum::<f32>() / costs.len() as f32;
        let least = wall.iter().copied().fold(1.0, f32::min);
        assert!(
            mean(&bush) < 0.7 * mean(&wall),
            "{} {}",
            mean(&bush),
            mean(&wall)
        );
        assert!(least > mean(&bush), "{least}");
        assert!(mean(&level) < 0.1 && mean(&level) < mean(&bush));
    }
}

#[test]
fn a_step_is_an_edge_within_a_cell_and_no_cell_has_a_height_in_between() {
    let step = [Block::new([0.70, -0.6, 0.0], [1.2, 0.6, 0.04], true)];
    let map = seen(&step, &[0.6, 0.4, 0.2], 4);
    let view = map.view();
    for cell in interior(view, [0.4, -0.2], [1.1, 0.2]) {
        let [x, y] = view.lattice.center_of(cell);
        let Surface::Floor(height_m) = view.cell(cell) else {
            panic!("{:?} at {x} {y}", view.cell(cell))
        };
        let level = if height_m > 0.02 { 0.04 } else { 0.0 };
        assert!((height_m - level).abs() < 0.005, "{height_m} at {x} {y}");
        if (x - 0.70).abs() > view.lattice.cell_m {
            assert_eq!(level > 0.0, x > 0.70, "{height_m} at {x} {y}");
        }
    }
}

#[test]
fn a_wall_is_an_obstacle_and_the_floor_before_it_is_not() {
    let wall = [Block::new([1.0, -0.6, 0.0], [1.1, 0.6, 0.4], false)];
    let map = seen(&wall, &[0.5, 0.2], 4);
    let view = map.view();
    for cell in interior(view, [0.5, -0.3], [0.92, 0.3]) {
        assert!(
            matches!(view.cell(cell), Surface::Floor(h) if h.abs() < 0.005),
            "{:?}",
            view.cell(cell)
        );
    }
    for row in -6..6 {
        let cell = view.lattice.cell_at(1.01, CELL_M * (f64::from(row) + 0.5));
        assert!(
            matches!(view.cell(cell), Surface::Obstacle(h) if (h - 0.4).abs() < CELL_M as f32),
            "{:?}",
            view.cell(cell)
        );
    }
}

#[test]
fn the_road_below_a_bridge_is_free_and_so_is_the_deck() {
    let bridge = [
        Block::new([0.8, -1.2, 0.65], [1.4, 1.2, 0.7], true),
        Block::new([0.8, 0.6, 0.0], [1.4, 1.2, 0.65], false),
        Block::new([0.8, -1.2, 0.0], [1.4, -0.6, 0.65], false),
    ];
    let mut map = seen(&bridge, &[0.6, 0.25, -0.1, -0.35], 4);
    let floors = |map: &Points, height_m: f32| {
        let cells = interior(map.view(), [0.9, -0.3], [1.3, 0.3]);
        let floor = |cell: &&Cell| matches!(map.view().cell(**cell), Surface::Floor(h) if (h - height_m).abs() < 0.02);
        cells.iter().filter(floor).count() as f64 / cells.len() as f64
    };
    let road = floors(&map, 0.0);
    assert!(road > 0.95, "{road}");
    let above = Pose::<Map, Robot>::from_yaw(1.1, -1.0, 0.7, 1.571);
    for pitch in [0.9, 0.7, 0.5, 0.9, 0.7, 0.5] {
        let planes = look_through(DEPTH_CAMERA, &bridge, &above, camera(0.45, pitch, 0.0));
        let _ = map.insert(&planes, &above).unwrap();
    }
    let deck = floors(&map, 0.7);
    assert!(deck > 0.95, "{deck}");
}

#[test]
fn a_box_that_is_removed_leaves_nothing() {
    let there = [Block::new([0.7, -0.1, 0.0], [0.8, 0.1, 0.2], true)];
    let mut map = seen(&there, &[0.15], 6);
    for _ in 0..12 {
        let planes = look_through(DEPTH_CAMERA, &[], &home(), camera(0.5, 0.15, 0.0));
        let _ = map.insert(&planes, &home()).unwrap();
    }
    for cell in interior(map.view(), [0.7, -0.1], [0.8, 0.1]) {
        assert!(
            map.things(cell).iter().all(|one| one.high_m < 0.05),
            "{:?}",
            map.things(cell)
        );
    }
}

#[test]
fn without_a_robot_the_room_that_counts_must_be_given() {
    let made = Points::new(PointsConfig::default(), ElevationConfig::default(), None);
    let said = made.unwrap_err().to_string();
    assert!(
        said.starts_with("navigation.points.headroom must be given where there is no robot"),
        "{said}"
    );
}
