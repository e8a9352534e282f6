//! The elevation grid on made terrain: each claim of the handbook's section 36.3.1 (004) that it rests on.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::terrain::{self, Luck};
use common::{Block, DEPTH_CAMERA, HEIGHT, WIDTH, camera, interior, look, look_through};
use geometry::{Cell, Map, Pose, Robot};
use mapping::{CellSizes, Elevation, ElevationConfig, HeightEstimate, Surface, WorldModel};
use segmentation::Planes;

fn here() -> Pose<Map, Robot> {
    Pose::from_yaw(0.0, 0.0, 0.0, 0.0)
}

fn map(config: ElevationConfig) -> Elevation {
    Elevation::new(config).unwrap()
}

/// A map after so many looks at the same picture.
fn seen(config: ElevationConfig, planes: &Planes, frames: usize) -> Elevation {
    let mut map = map(config);
    for _ in 0..frames {
        assert!(map.insert(planes, &here()).unwrap().used);
    }
    map
}

fn estimates(map: &Elevation) -> Vec<([f64; 2], HeightEstimate)> {
    let view = map.view();
    let cells = view.cells.area().cells();
    let known = cells.filter_map(|cell| Some((view.lattice.center_of(cell), map.estimate(cell)?)));
    known.collect()
}

fn root_mean_square(errors: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = errors.fold((0.0, 0), |(sum, count), e| (sum + e * e, count + 1));
    (sum / f64::from(count.max(1))).sqrt()
}

fn height(surface: Surface) -> Option<f64> {
    match surface {
        Surface::Floor(h) | Surface::Obstacle(h) => Some(f64::from(h)),
        Surface::Unknown => None,
    }
}

#[test]
fn noise_free_terrain_is_right_to_a_cell_times_its_slope_over_root_twelve() {
    // H23. A plane of 0.1 and waves of 2 cm.
    let slope = 0.1;
    let planes = terrain::look(
        DEPTH_CAMERA,
        |x, _| slope * x,
        camera(0.6, 0.7, 0.0),
        0.0,
        &mut Luck(1),
    );
    let map = seen(ElevationConfig::default(), &planes, 1);
    let errors = estimates(&map).into_iter();
    let errors = errors.map(|([x, _], e)| f64::from(e.height_m) - slope * x);
    let found = root_mean_square(errors);
    assert!(found <= 0.04 * slope / 12_f64.sqrt(), "{found}");
}

#[test]
fn cells_that_grow_with_the_distance_hold_about_as_many_points_each() {
    // H24. Level ground, from 0.5 m to the end of view; the regular grid beside it.
    let config = ElevationConfig {
        cells: CellSizes::ByRange,
        fill: 0.0,
        clearing: false,
        ..ElevationConfig::default()
    };
    let pose = camera(0.5, 0.45, 0.0);
    let planes = terrain::look(DEPTH_CAMERA, |_, _| 0.0, pose, 0.0, &mut Luck(1));
    let map = seen(config, &planes, 1);
    let mean = |cells: &[(f64, u32)], from: f64, to: f64| {
        let inside = cells
            .iter()
            .filter(|(range_m, _)| (from..to).contains(range_m));
        let (sum, count) = inside.fold((0, 0), |(sum, count), (_, n)| (sum + n, count + 1));
        f64::from(sum) / f64::from(count.max(1))
    };
    let spread = |cells: &[(f64, u32)]| {
        let edges = [0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 3.6];
        let means = edges.windows(2).map(|two| mean(cells, two[0], two[1]));
        let means: Vec<_> = means.filter(|mean| *mean > 0.0).collect();
        let (low, high) = means
            .iter()
            .fold((f64::INFINITY, 0.0_f64), |(low, high), &mean| {
                (low.min(mean), high.max(mean))
            });
        assert_eq!(means.len(), 6);
        high / low
    };
    let by_range: Vec<_> = map.by_range().unwrap().points().collect();
    let mut regular = std::collections::BTreeMap::new();
    for [x, y, _] in planes
        .points_in_robot_m
        .iter()
        .filter(|p| p[0].is_finite() && p[0] < 4.0)
    {
        let cell = map.view().lattice.cell_at(f64::from(*x), f64::from(*y));
        *regular.entry((cell.col, cell.row)).or_insert(0) += 1;
    }
    let range = |&(col, row): &(i32, i32)| {
        let [x, y] = map.view().lattice.center_of(Cell::new(col, row));
        geometry::hypot(x, y)
    };
    let regular: Vec<_> = regular.iter().map(|(cell, &n)| (range(cell), n)).collect();
    let (ours, theirs) = (spread(&by_range), spread(&regular));
    assert!(ours <= 3.0 && theirs > 20.0, "{ours} {theirs}");
}

#[test]
fn sampling_cells_anew_where_the_robot_moves_costs_what_is_said() {
    let ground = |x: f64, y: f64| 0.03 * libm::sin(6.0 * x) * libm::cos(5.0 * y);
    let config = ElevationConfig {
        cells: CellSizes::ByRange,
        ..ElevationConfig::default()
    };
    let planes = terrain::look(
        DEPTH_CAMERA,
        ground,
        camera(0.5, 0.5, 0.0),
        0.0,
        &mut Luck(1),
    );
    let mut map = seen(config, &planes, 1);
    assert_eq!(map.by_range().unwrap().resampling_error_m(), 0.0);
    // A step further, with nothing new to see.
    let blind = Planes::of_points(vec![], planes.robot_from_camera);
    let pose = Pose::<Map, Robot>::from_yaw(0.05, 0.0, 0.0, 0.0);
    let _ = map.insert(&blind, &pose).unwrap();
    let said = map.by_range().unwrap().resampling_error_m();
    assert!(said > 1e-4 && said < 0.01, "{said}");
    let errors = map.view().cells.area().cells().filter_map(|cell| {
        let [x, y] = map.view().lattice.center_of(cell);
        let near = geometry::hypot(x, y) < 1.5 && geometry::hypot(x, y) > 0.4;
        Some(height(map.view().cell(cell)).filter(|_| near)? - ground(x, y))
    });
    let found = root_mean_square(errors);
    assert!(found < 3.0 * said + 0.004, "{found} {said}");
}

#[test]
fn a_gap_is_filled_as_well_as_its_neighbours_were_measured_and_a_step_stays_where_it_is() {
    // H25. Every fourth column and every third row of the picture is lost, and a step of 60 mm runs across.
    let ground = |x: f64, _: f64| if x > 0.82 { 0.06 } else { 0.0 };
    let mut planes = terrain::look(
        common::CAMERA,
        ground,
        camera(0.6, 0.6, 0.0),
        0.0,
        &mut Luck(1),
    );
    for (index, point) in planes.points_in_robot_m.iter_mut().enumerate() {
        if !(index % WIDTH).is_multiple_of(4) || !(index / WIDTH).is_multiple_of(2) {
            *point = [f32::NAN; 3];
        }
    }
    let without = seen(
        ElevationConfig {
            fill: 0.0,
            ..ElevationConfig::default()
        },
        &planes,
        3,
    );
    let with = seen(ElevationConfig::default(), &planes, 3);
    let truth = |cell: Cell| with.view().lattice.center_of(cell);
    let (mut measured, mut filled, mut beyond) = (vec![], vec![], 0);
    for cell in with.view().cells.area().cells() {
        let Some(found) = height(with.view().cell(cell)) else {
            continue;
        };
        let [x, y] = truth(cell);
        if geometry::hypot(x, y) <= 0.2 {
            continue; // underfoot
        }
        let error = found - ground(x, y);
        let at_edge = (x - 0.82).abs() <= 0.04;
        match without.estimate(cell) {
            Some(_) if !at_edge => measured.push(error),
            None if !at_edge => filled.push(error),
            _ => {}
        }
        beyond += usize::from(!at_edge && error.abs() > 0.02);
    }
    assert!(filled.len() > 40, "{}", filled.len());
    let (of_measured, of_filled) = (
        root_mean_square(measured.into_iter()),
        root_mean_square(filled.into_iter()),
    );
    assert!(
        of_filled <= 2.0 * of_measured + 1e-4,
        "{of_filled} {of_measured}"
    );
    assert_eq!(beyond, 0);
}

#[test]
fn a_shadow_stays_unknown_and_sight_lines_bound_it_from_above() {
    // H26. A box that hides half a metre of floor, from several places.
    let mut luck = Luck(3);
    for (at, size, top) in [
        (0.7, 0.1, 0.2),
        (0.6, 0.3, 0.12),
        (0.9, 0.06, 0.3),
        (0.8, 0.2, 0.25),
    ] {
        let hidden = [Block::new([at, -0.15, 0.0], [at + size, 0.15, top], true)];
        let planes = look_through(DEPTH_CAMERA, &hidden, &here(), camera(0.6, 0.5, 0.0));
        let map = seen(ElevationConfig::default(), &planes, 5);
        let end = (at + size) * 0.6 / (0.6 - top);
        let inside = interior(
            map.view(),
            [at + size + 0.02, -0.1],
            [(end - 0.06).min(1.9), 0.1],
        );
        for cell in inside {
            assert_eq!(
                map.view().cell(cell),
                Surface::Unknown,
                "{cell:?} behind {at}"
            );
            assert!(map.bound_m(cell).unwrap() >= 0.0);
        }
    }
    // On hills the bound is never below the ground.
    let hills = |x: f64, y: f64| 0.06 * (libm::sin(7.0 * x) * libm::cos(5.0 * y + 1.0));
    let planes = terrain::look(DEPTH_CAMERA, hills, camera(0.6, 0.35, 0.0), 0.0, &mut luck);
    let map = seen(ElevationConfig::default(), &planes, 1);
    let view = map.view();
    let (mut bounded, mut unseen) = (0, 0);
    for cell in view.cells.area().cells() {
        if let Some(bound_m) = map.bound_m(cell) {
            let [x, y] = view.lattice.center_of(cell);
            assert!(
                f64::from(bound_m) >= hills(x, y) - 1e-3,
                "{bound_m} at {x} {y}"
            );
            bounded += 1;
            unseen += usize::from(map.estimate(cell).is_none());
        }
    }
    assert!(bounded > 200 && unseen > 100, "{bounded} {unseen}");
}

#[test]
fn the_pyramid_closes_gaps_far_away_and_keeps_what_is_near() {
    // H27. A coarse camera on rough ground, its points further apart than the cells beyond 1.5 m.
    let ground = |x: f64, y: f64| 0.02 * libm::sin(9.0 * x) * libm::sin(8.0 * y);
    let base = ElevationConfig {
        fill: 0.0,
        cell: 0.02,
        window: 200,
        ..ElevationConfig::default()
    };
    let planes = terrain::look(
        common::CAMERA,
        ground,
        camera(0.6, 0.3, 0.0),
        0.0,
        &mut Luck(1),
    );
    let flat = seen(base.clone(), &planes, 1);
    let pyramid = seen(ElevationConfig { pyramid: 4, ..base }, &planes, 1);
    let gaps = |map: &Elevation| {
        let far = |[x, y]: [f64; 2]| (1.2..1.9).contains(&x) && y.abs() < 0.35 * x;
        let cells = map.view().cells.area().cells();
        let cells: Vec<_> = cells
            .filter(|&cell| far(map.view().lattice.center_of(cell)))
            .collect();
        let unknown = cells
            .iter()
            .filter(|&&cell| map.view().cell(cell) == Surface::Unknown)
            .count();
        unknown as f64 / cells.len() as f64
    };
    let (without, with) = (gaps(&flat), gaps(&pyramid));
    assert!(without > 0.5 && with <= without / 5.0, "{without} {with}");
    for cell in flat.view().cells.area().cells() {
        if flat.estimate(cell).is_some() {
            assert_eq!(flat.estimate(cell), pyramid.estimate(cell));
        }
    }
}

/// The camera's tilt is wrong by so much, rad, anew in each frame, while the robot comes nearer: the heights that the two maps know in the
/// end, and the squared innovations of a cell of the first one, in units of what it expects.
fn come_nearer(tilt: f64, luck: &mut Luck, maps: &mut [Elevation; 2]) -> Vec<f64> {
    let mut squared = vec![];
    for step in 0..12 {
        let pose = Pose::<Map, Robot>::from_yaw(0.1 * f64::from(step), 0.0, 0.0, 0.0);
        let error = tilt * luck.normal();
        let mut planes = look(&[], &pose, camera(0.5, 0.5, 0.0));
        for point in &mut planes.points_in_robot_m {
            let [x, _, z] = *point;
            point[2] = z + error as f32 * (x * x + 0.25).sqrt();
        }
        let cell = maps[0].view().lattice.cell_at(1.62, 0.02);
        if let Some(before) = maps[0].estimate(cell) {
            let range_m = geometry::hypot(1.62 - 0.1 * f64::from(step), 0.5);
            let sigma = 0.001 + tilt * range_m;
            let expected = f64::from(before.variance_m2) + sigma * sigma;
            squared.push((error * range_m - f64::from(before.height_m)).powi(2) / expected);
        }
        for map in &mut *maps {
            assert!(map.insert(&planes, &pose).unwrap().used);
        }
    }
    squared
}

#[test]
fn with_tilt_noise_a_sigma_that_grows_with_range_is_consistent_and_beats_a_constant_one() {
    // H30.
    let tilt = 0.01;
    let linear = ElevationConfig {
        sigma: 0.001,
        sigma_per_metre: tilt,
        gate: 1e6,
        clearing: false,
        match_gate: 0.0,
        min_pairs: 1_000_000,
        fill: 0.0,
        ..ElevationConfig::default()
    };
    let constant = ElevationConfig {
        sigma: tilt,
        sigma_per_metre: 0.0,
        ..linear.clone()
    };
    let (mut errors, mut squared) = ([vec![], vec![]], vec![]);
    for seed in 0..20 {
        let mut maps = [map(linear.clone()), map(constant.clone())];
        squared.extend(come_nearer(tilt, &mut Luck(seed), &mut maps));
        for (errors, map) in errors.iter_mut().zip(&maps) {
            errors.extend(estimates(map).iter().map(|(_, e)| f64::from(e.height_m)));
        }
    }
    let mean = squared.iter().sum::<f64>() / squared.len() as f64;
    // Twice what 95 % of the means of so many squares of a normal variable are within: frames of one walk are not independent.
    let spread = 1.96 * (2.0 / squared.len() as f64).sqrt();
    assert!(
        (mean - 1.0).abs() < 2.0 * spread,
        "{mean} of {}",
        squared.len()
    );
    let [by_range, constant] = errors.map(|errors| root_mean_square(errors.into_iter()));
    assert!(by_range < constant, "{by_range} {constant}");
}

#[test]
fn a_steps_edge_lies_within_a_cell_and_no_cell_has_a_height_in_between() {
    // With the noise of a stereo camera, from several distances.
    for (seed, edge) in [(1, 0.51), (2, 0.6), (3, 0.73), (4, 0.88)] {
        let rise = 0.04;
        let ground = move |x: f64, _: f64| if x > edge { rise } else { 0.0 };
        let mut luck = Luck(seed);
        let mut map = map(ElevationConfig::default());
        for _ in 0..10 {
            let planes = terrain::look(
                common::CAMERA,
                ground,
                camera(0.5, 0.6, 0.0),
                0.12,
                &mut luck,
            );
            assert!(map.insert(&planes, &here()).unwrap().used);
        }
        let view = map.view();
        let (mut between, mut cells) = (0, 0);
        for cell in view.cells.area().cells() {
            let [x, y] = view.lattice.center_of(cell);
            let near = (0.35..1.1).contains(&x) && y.abs() < 0.2;
            if let Some(h) = height(view.cell(cell)).filter(|_| near) {
                let right = (h - ground(x, y)).abs() < 0.012;
                let beside = (x - edge).abs() <= view.lattice.cell_m;
                assert!(right || beside, "{h} at {x}, {y}; edge {edge}");
                cells += 1;
                between += usize::from((0.012..rise - 0.012).contains(&h));
            }
        }
        assert!(cells > 100);
        assert_eq!(between, 0, "edge {edge}");
    }
}

#[test]
fn a_box_that_is_removed_is_taken_back_where_sight_lines_pass_below_its_top_and_stays_without_clearing()
 {
    let there = [Block::new([0.7, -0.1, 0.0], [0.8, 0.1, 0.2], true)];
    for clearing in [true, false] {
        let mut map = map(ElevationConfig {
            clearing,
            ..ElevationConfig::default()
        });
        for (blocks, frames) in [(&there[..], 6), (&[][..], 12)] {
            for _ in 0..frames {
                // What lies below the box is not seen: the camera looks over it.
                let planes = look(blocks, &here(), camera(0.5, 0.15, 0.0));
                let _ = map.insert(&planes, &here()).unwrap();
            }
        }
        let inside = interior(map.view(), [0.7, -0.1], [0.8, 0.1]);
        let stale = inside
            .iter()
            .filter(|&&cell| height(map.view().cell(cell)).is_some_and(|h| h > 0.05));
        assert_eq!(stale.count() == 0, clearing);
    }
}

#[test]
fn the_underpass_of_a_bridge_is_blocked() {
    // H34, Fig. 36.11b: a deck 70 cm above the road.
    let bridge = [Block::new([0.8, -0.8, 0.7], [1.4, 0.8, 0.75], true)];
    let mut map = map(ElevationConfig::default());
    for pitch in [0.5, 0.2, -0.1, -0.3] {
        let planes = look(&bridge, &here(), camera(0.45, pitch, 0.0));
        let _ = map.insert(&planes, &here()).unwrap();
    }
    let below = interior(map.view(), [0.85, -0.2], [1.3, 0.2]);
    let blocked = below
        .iter()
        .filter(|&&cell| height(map.view().cell(cell)).is_some_and(|h| h > 0.5));
    assert!(blocked.count() * 2 > below.len());
}

#[test]
fn a_pose_that_is_no_number_changes_nothing() {
    let planes = look(&[], &here(), camera(0.5, 0.6, 0.0));
    let mut map = seen(ElevationConfig::default(), &planes, 2);
    let before = map.view().clone();
    let nowhere = Pose::<Map, Robot>::from_yaw(f64::NAN, 0.0, 0.0, 0.0);
    assert!(map.insert(&planes, &nowhere).is_err());
    assert_eq!(map.view(), &before);
    assert_eq!(planes.points_in_robot_m.len(), WIDTH * HEIGHT);
}
