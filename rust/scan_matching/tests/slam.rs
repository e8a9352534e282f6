//! Scans along a way: local maps, loops, and what bad scans do.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::{block, off, outline, room, walk, way};
use geometry::PlanarPose;
use plan_view::{PlanarBeam, PlanarScan};
use scan_matching::{LocalMapsConfig, LoopsConfig, ScanSlam, ScanSlamConfig, ScanSlamError};

/// A round corridor between an outer and an inner wall, with niches, so that it looks different along it.
fn ring() -> Vec<common::Wall> {
    let mut walls = outline(&[
        [0.0, 0.0],
        [4.0, 0.0],
        [4.0, -0.5],
        [5.2, -0.5],
        [5.2, 0.0],
        [12.0, 0.0],
        [12.0, 3.0],
        [12.7, 3.0],
        [12.7, 4.0],
        [12.0, 4.0],
        [12.0, 9.0],
        [7.5, 9.0],
        [7.5, 9.6],
        [6.1, 9.6],
        [6.1, 9.0],
        [0.0, 9.0],
        [0.0, 6.4],
        [-0.4, 6.4],
        [-0.4, 4.8],
        [0.0, 4.8],
    ]);
    walls.extend(block([2.0, 2.0], [10.0, 7.0]));
    walls
}

/// Once around, and on until what was seen first is seen again.
fn around() -> Vec<PlanarPose> {
    way(
        &[
            [2.0, 1.0],
            [11.0, 1.0],
            [11.0, 8.0],
            [1.0, 8.0],
            [1.0, 1.0],
            [8.0, 1.0],
        ],
        0.1,
    )
}

fn config() -> ScanSlamConfig {
    ScanSlamConfig {
        local_maps: LocalMapsConfig {
            scans: 24,
            ..LocalMapsConfig::default()
        },
        ..ScanSlamConfig::default()
    }
}

fn open_loops() -> ScanSlamConfig {
    ScanSlamConfig {
        loops: LoopsConfig {
            close: false,
            ..LoopsConfig::default()
        },
        ..config()
    }
}

fn slam_of(config: ScanSlamConfig, scans: &[PlanarScan]) -> ScanSlam {
    let mut slam = ScanSlam::new(config).unwrap();
    for scan in scans {
        slam.insert(scan).unwrap();
    }
    slam.finish();
    slam
}

/// Greatest distance of a pose from the true one, m, and in heading, rad, the first pose laid onto the first.
fn worst(slam: &ScanSlam, truth: &[PlanarPose]) -> (f64, f64) {
    let begin = slam.pose(0).unwrap();
    let each = slam.poses().iter().zip(truth);
    let each =
        each.map(|(pose, truth_pose)| off(&begin.relative(pose), &truth[0].relative(truth_pose)));
    each.fold((0.0, 0.0), |most, one| {
        (f64::max(most.0, one.0), f64::max(most.1, one.1))
    })
}

/// Mean distance of the points of a local map from the true walls, m, signed: away from where the robot was first is positive. A loop that does not
/// close shows as two local maps that say otherwise of one wall.
fn bottom_wall_m(slam: &ScanSlam, map: usize) -> Option<f64> {
    let points = slam.dense_m(map);
    let bottom = points
        .iter()
        .filter(|at| (5.6..7.6).contains(&at[0]) && at[1].abs() < 0.4);
    let (sum, count) = bottom.fold((0.0, 0), |(sum, count), at| (sum + at[1], count + 1));
    (count > 50).then(|| sum / f64::from(count))
}

/// H65.
#[test]
fn what_is_dense_moves_with_its_local_map_when_a_loop_closes() {
    let truth = around();
    let scans = walk(&ring(), &truth, [0.05, 0.02, 0.05], 5);
    let apart = |slam: &ScanSlam| {
        let of: Vec<f64> = (0..slam.local_maps().count())
            .filter_map(|map| bottom_wall_m(slam, map))
            .collect();
        assert!(
            of.len() >= 4,
            "the wall is seen on both rounds: {}",
            of.len()
        );
        let [low, high] =
            [f64::min, f64::max].map(|which| of.iter().copied().reduce(which).unwrap());
        high - low
    };
    let before = slam_of(open_loops(), &scans);
    let after = slam_of(config(), &scans);
    assert!(before.closed_loops() == 0 && after.closed_loops() > 5);
    // A centimetre: one cell of a map as fine as that.
    let (open_m, closed_m) = (apart(&before), apart(&after));
    assert!(closed_m <= 0.01, "{open_m} m open, {closed_m} m closed");
    assert!(
        worst(&after, &truth).0 < 0.05,
        "{:?}",
        worst(&after, &truth)
    );
}

#[test]
fn scans_find_back_to_where_odometry_does_not() {
    for seed in 0..2 {
        let truth = around();
        let scans = walk(&ring(), &truth, [0.05, 0.035, 0.05], seed);
        let by_odometry = off(
            &scans.last().unwrap().map_from_sensor,
            truth.last().unwrap(),
        );
        let slam = slam_of(config(), &scans);
        let (far_m, far_rad) = worst(&slam, &truth);
        assert!(
            far_m < 0.1 && far_rad < 0.02 && slam.unmatched() == 0,
            "{far_m} m, {far_rad} rad; odometry {by_odometry:?}"
        );
    }
}

#[test]
fn a_turn_of_which_odometry_knows_nothing_is_found_out() {
    // A larger hall: near walls would draw a scan to themselves from any heading.
    let walls: Vec<common::Wall> = ring()
        .iter()
        .map(|wall| wall.map(|at| at.map(|m| 2.5 * m)))
        .collect();
    let plain = way(&[[5.0, 2.5], [11.0, 2.5]], 0.1);
    for turned_rad in [-0.3, -0.25, 0.25, 0.3] {
        // As if somebody took the robot and turned it after 40 scans.
        let turn = plain[40].compose(&PlanarPose::new(0.0, 0.0, turned_rad));
        let mut truth = plain.clone();
        for pose in &mut truth[41..] {
            *pose = turn.compose(&plain[40].relative(pose));
        }
        let told = walk(&walls, &plain, [0.05, 0.02, 0.05], 4);
        let mut scans = walk(&walls, &truth, [0.0; 3], 4);
        for (scan, told) in scans.iter_mut().zip(told) {
            scan.map_from_sensor = told.map_from_sensor;
        }
        let slam = slam_of(open_loops(), &scans);
        let (_, far_rad) = worst(&slam, &truth);
        assert!(
            far_rad < 0.03 && slam.unmatched() == 0,
            "{turned_rad}: {far_rad} rad"
        );
    }
}

#[test]
fn the_same_scans_give_the_same_poses_to_the_bit() {
    let scans = walk(&ring(), &around()[..90], [0.05, 0.02, 0.05], 1);
    let [one, other] = [0, 1].map(|_| slam_of(config(), &scans));
    assert_eq!(one.poses(), other.poses());
}

/// Two rooms that are the same, 14 m apart along a corridor of which every metre looks like the next.
#[test]
fn rooms_that_look_alike_are_not_taken_for_each_other() {
    let mut corners = vec![[-1.0, -1.0], [19.0, -1.0], [19.0, 1.0]];
    for x in [14.0, 0.0] {
        corners.extend([
            [x + 2.5, 1.0],
            [x + 2.5, 3.5],
            [x + 1.8, 3.5],
            [x + 1.8, 5.0],
            [x - 0.5, 5.0],
            [x - 0.5, 1.0],
        ]);
    }
    corners.push([-1.0, 1.0]);
    let walls = outline(&corners);
    let into = |x: f64| [[x + 1.0, 0.0], [x + 1.0, 3.0], [x + 1.0, 0.1]];
    let mut corners = into(0.0).to_vec();
    corners.extend(into(14.0));
    let truth = way(&corners, 0.1);
    for seed in 0..2 {
        let scans = walk(&walls, &truth, [0.02, 0.02, 0.05], seed);
        let slam = slam_of(config(), &scans);
        for link in slam.graph().links.iter().filter(|link| link.is_loop) {
            let first = slam.local_maps().nth(link.map).unwrap().0.scans[0];
            let true_pose = truth[first].relative(&truth[link.scan]);
            let wrong_m = true_pose.distance_m(&link.local_from_sensor);
            assert!(
                wrong_m < 0.5,
                "scan {} is {wrong_m} m off in map {}",
                link.scan,
                link.map
            );
        }
        let (far_m, far_rad) = worst(&slam, &truth);
        assert!(far_m < 1.0 && far_rad < 0.05, "{far_m} m, {far_rad} rad");
    }
}

#[test]
fn scans_without_a_point_with_ranges_that_are_none_and_of_other_sizes_are_taken_in() {
    let truth = way(&[[-1.0, 0.0], [1.0, 0.0]], 0.1);
    let mut scans = walk(&room(), &truth, [0.02, 0.01, 0.05], 2);
    scans[5].beams.clear();
    scans[6].beams = vec![PlanarBeam::new(0.0, None); 12];
    for beam in &mut scans[8].beams {
        beam.range_m = Some(f64::NAN);
    }
    scans[10].beams = scans[10].beams.iter().step_by(4).copied().collect();
    scans[11].beams.truncate(70);
    let slam = slam_of(config(), &scans);
    assert_eq!((slam.poses().len(), slam.unmatched()), (truth.len(), 3));
    assert!(worst(&slam, &truth).0 < 0.03, "{:?}", worst(&slam, &truth));
}

#[test]
fn without_a_scan_there_is_nothing_and_with_one_the_robot_is_where_odometry_says() {
    let mut slam = slam_of(config(), &[]);
    assert!(slam.poses().is_empty() && slam.local_maps().count() == 0);
    let map_from_sensor = PlanarPose::new(3.0, 4.0, 0.5);
    slam.insert(&PlanarScan {
        map_from_sensor,
        beams: Vec::new(),
    })
    .unwrap();
    slam.finish();
    assert_eq!(slam.poses(), [map_from_sensor]);
}

#[test]
fn odometry_that_is_no_number_and_one_local_map_too_many_are_refused_and_change_nothing() {
    let mut scans = walk(&room(), &way(&[[-1.0, 0.0], [1.0, 0.0]], 0.1), [0.0; 3], 2);
    let mut slam = slam_of(config(), &scans[..3]);
    scans[3].map_from_sensor.yaw_rad = f64::NAN;
    assert_eq!(slam.insert(&scans[3]), Err(ScanSlamError::PoseNotFinite));
    slam.insert(&scans[4]).unwrap();
    assert_eq!(slam.poses().len(), 4);
    let mut few = ScanSlam::new(ScanSlamConfig {
        local_maps: LocalMapsConfig {
            scans: 4,
            most: 2,
            ..LocalMapsConfig::default()
        },
        ..ScanSlamConfig::default()
    })
    .unwrap();
    for scan in &scans[4..8] {
        few.insert(scan).unwrap();
    }
    let refused = few.insert(&scans[8]).unwrap_err();
    assert!(refused.to_string().contains("plan_view.local_maps.most"));
}
