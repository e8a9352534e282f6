//! Scans laid onto the lines of all of them.

use geometry::{PlanarPose, SplitMix64, wrap_angle};
use plan_view::{
    AlignmentConfig, LineAlignment, LineFinder, LineFinderConfig, PlanarBeam, PlanarScan,
};

/// A room with a pillar in a corner: corners of its walls, m.
const ROOM_M: [[f64; 2]; 6] = [
    [-2.0, -1.5],
    [2.0, -1.5],
    [2.0, 1.0],
    [1.2, 1.0],
    [1.2, 1.6],
    [-2.0, 1.6],
];

fn range_m(pose: &PlanarPose, bearing_rad: f64) -> f64 {
    let (sin, cos) = libm::sincos(pose.yaw_rad + bearing_rad);
    let walls = (0..ROOM_M.len()).map(|at| [ROOM_M[at], ROOM_M[(at + 1) % ROOM_M.len()]]);
    walls
        .filter_map(|[from, to]| {
            let along = [to[0] - from[0], to[1] - from[1]];
            let off = [from[0] - pose.x_m, from[1] - pose.y_m];
            let across = cos * along[1] - sin * along[0];
            let range = (off[0] * along[1] - off[1] * along[0]) / across;
            let part = (off[0] * sin - off[1] * cos) / across;
            (range > 0.0 && (0.0..=1.0).contains(&part)).then_some(range)
        })
        .fold(f64::INFINITY, f64::min)
}

fn normal(numbers: &mut SplitMix64) -> f64 {
    (0..12).map(|_| numbers.uniform()).sum::<f64>() - 6.0
}

/// Scans from true poses, those poses, and the same scans from poses that are a little off.
fn scans(seed: u64) -> (Vec<PlanarPose>, Vec<PlanarScan>) {
    let mut numbers = SplitMix64::new(seed);
    (0..40)
        .map(|_| {
            let [x, y, yaw] = [0, 1, 2].map(|_| 2.0 * numbers.uniform() - 1.0);
            let truth = PlanarPose::new(1.2 * x, 0.8 * y, 3.0 * yaw);
            let beam = |step: i32, numbers: &mut SplitMix64| {
                let bearing = 0.035 * f64::from(step);
                PlanarBeam::new(
                    bearing,
                    Some(range_m(&truth, bearing) + 0.005 * normal(numbers)),
                )
            };
            let beams = (-90..90).map(|step| beam(step, &mut numbers)).collect();
            let [x, y, yaw] = [0.02, 0.02, 0.01].map(|sigma| sigma * normal(&mut numbers));
            let off = PlanarPose::new(
                truth.x_m + x,
                truth.y_m + y,
                wrap_angle(truth.yaw_rad + yaw),
            );
            (
                truth,
                PlanarScan {
                    map_from_sensor: off,
                    beams,
                },
            )
        })
        .unzip()
}

/// How far poses are off, m and rad, but for a shift and a turn that all have in common: root of the mean squares.
fn off(poses: &[PlanarPose], truth: &[PlanarPose]) -> (f64, f64) {
    let count = poses.len() as f64;
    let each: Vec<_> = poses
        .iter()
        .zip(truth)
        .map(|(one, other)| {
            [
                one.x_m - other.x_m,
                one.y_m - other.y_m,
                wrap_angle(one.yaw_rad - other.yaw_rad),
            ]
        })
        .collect();
    let mean = [0, 1, 2].map(|axis| each.iter().map(|off| off[axis]).sum::<f64>() / count);
    let square = |axis: usize| {
        each.iter()
            .map(|off| (off[axis] - mean[axis]).powi(2))
            .sum::<f64>()
            / count
    };
    ((square(0) + square(1)).sqrt(), square(2).sqrt())
}

#[test]
fn scans_whose_poses_are_a_little_off_are_laid_onto_the_walls() {
    let config = LineFinderConfig {
        sigma: 0.04, // with what the poses are off
        ..LineFinderConfig::default()
    };
    let finder = LineFinder::new(config).unwrap();
    let alignment = LineAlignment::new(AlignmentConfig {
        rounds: 3,
        ..AlignmentConfig::default()
    })
    .unwrap();
    for seed in 0..4 {
        let (truth, scans) = scans(seed);
        let given: Vec<_> = scans.iter().map(|scan| scan.map_from_sensor).collect();
        let (_, poses) = alignment.find(&finder, &scans).unwrap();
        let (before, after) = (off(&given, &truth), off(&poses, &truth));
        assert!(
            after.0 < 0.5 * before.0 && after.1 < 0.6 * before.1,
            "{before:?} {after:?}"
        );
    }
}

#[test]
fn a_scan_that_lies_on_the_lines_and_one_that_sees_nothing_stay_where_they_are() {
    let alignment = LineAlignment::new(AlignmentConfig::default()).unwrap();
    let (truth, mut scans) = scans(9);
    let walls = (0..ROOM_M.len()).map(|at| [ROOM_M[at], ROOM_M[(at + 1) % ROOM_M.len()]]);
    let lines: Vec<_> = walls.filter_map(plan_view::PlanarLine::fit).collect();
    scans[0].map_from_sensor = truth[0];
    let stays = alignment.align(&scans[0], &truth[0], &lines);
    assert!(stays.distance_m(&truth[0]) < 2e-3 && (stays.yaw_rad - truth[0].yaw_rad).abs() < 2e-3);
    scans[0].beams = vec![
        PlanarBeam::new(0.0, None),
        PlanarBeam::new(0.1, Some(f64::NAN)),
    ];
    for (scan, lines) in [(&scans[0], &lines[..]), (&scans[1], &[])] {
        let given = scan.map_from_sensor;
        let stays = alignment.align(scan, &given, lines);
        assert!(stays.distance_m(&given) < 1e-12 && (stays.yaw_rad - given.yaw_rad).abs() < 1e-12);
    }
}
