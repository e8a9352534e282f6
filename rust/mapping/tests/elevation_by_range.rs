//! The elevation grid where data thins out and errs more and more with the range: what the handbook's section 36.3.1 (004) says of it.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::heights::{estimates, height, map, root_mean_square, seen};
use common::terrain::{self, Luck};
use common::{DEPTH_CAMERA, camera, look};
use geometry::{Cell, Map, Pose, Robot};
use mapping::{CellSizes, Elevation, ElevationConfig, Surface, WorldModel};
use segmentation::Planes;

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
