//! A scan matched to a local map.

mod common;

use std::f64::consts::PI;

use common::{off, outline, room, scan};
use geometry::{PlanarPose, SplitMix64};
use nalgebra::{Matrix3, Vector3};
use plan_view::PlanarBeam;
use proptest::prelude::*;
use scan_matching::{FieldMaxima, LikelihoodField, ScanMatch, ScanMatchConfig, ScanMatcher};

/// Half of what is searched: x, y, m, and heading, rad.
const HALF: [f64; 3] = [0.5, 0.5, 0.35];

fn known(sigma: [f64; 3]) -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::from(sigma.map(|sigma| sigma * sigma)))
}

fn field_of(
    matcher: &ScanMatcher,
    walls: &[common::Wall],
    poses: &[PlanarPose],
    noise_m: f64,
) -> LikelihoodField {
    let mut field = LikelihoodField::new(matcher.config());
    let mut numbers = SplitMix64::new(7);
    for pose in poses {
        let beams = scan(walls, pose, (180, PI), noise_m, &mut numbers);
        matcher.insert(&mut field, &matcher.points_m(&beams), pose);
    }
    field
}

fn found(
    matcher: &ScanMatcher,
    field: &LikelihoodField,
    maxima: Option<&FieldMaxima>,
    beams: &[PlanarBeam],
    before: &PlanarPose,
) -> Option<ScanMatch> {
    let spread = known([0.3, 0.3, 0.2]);
    let points = matcher.points_m(beams);
    matcher.find((field, maxima), &points, (before, &spread), HALF, 0.3)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn a_scan_from_anywhere_in_the_window_comes_back_to_where_it_was_taken(
        x in -0.45..0.45f64, y in -0.45..0.45f64, yaw in -0.3..0.3f64, at in -PI..PI, seed in 0..1000u64,
    ) {
        let matcher = ScanMatcher::new(ScanMatchConfig::default()).unwrap();
        let poses: Vec<_> = (0..8)
            .map(|step| PlanarPose::new(0.05 * f64::from(step), 0.1, at + 0.1 * f64::from(step)))
            .collect();
        let field = field_of(&matcher, &room(), &poses, 0.0);
        let truth = PlanarPose::new(0.23, 0.04, at + 0.31);
        let beams = scan(&room(), &truth, (180, PI), 0.0, &mut SplitMix64::new(seed));
        let before = truth.compose(&PlanarPose::new(x, y, yaw));
        let maxima = FieldMaxima::new(&field, 2);
        let quick = found(&matcher, &field, Some(&maxima), &beams, &before).unwrap();
        let (far_m, far_rad) = off(&quick.pose, &truth);
        prop_assert!(far_m < 5e-3 && far_rad.to_degrees() < 0.1, "{far_m} m, {} degrees", far_rad.to_degrees());
        // What the bounds leave out is no better: without them every cell is looked at.
        let whole = found(&matcher, &field, None, &beams, &before).unwrap();
        prop_assert_eq!(quick.pose, whole.pose);
    }
}

#[test]
fn a_scan_is_placed_as_well_as_its_covariance_says() {
    let matcher = ScanMatcher::new(ScanMatchConfig {
        sigma: 0.02,
        together: 1.0,
        ..ScanMatchConfig::default()
    })
    .unwrap();
    let poses: Vec<_> = (0..20)
        .map(|step| PlanarPose::new(0.05 * f64::from(step) - 0.5, 0.1, 0.0))
        .collect();
    let field = field_of(&matcher, &room(), &poses, 0.02);
    let truth = PlanarPose::new(0.1, 0.15, 0.2);
    let mut squares = 0.0;
    let count = 40;
    for seed in 0..count {
        let beams = scan(&room(), &truth, (180, PI), 0.02, &mut SplitMix64::new(seed));
        let matched = found(&matcher, &field, None, &beams, &truth).unwrap();
        let away = truth.relative(&matched.pose);
        let away = Vector3::new(
            matched.pose.x_m - truth.x_m,
            matched.pose.y_m - truth.y_m,
            away.yaw_rad,
        );
        squares += away.dot(&(matched.covariance.try_inverse().unwrap() * away));
    }
    let mean = squares / (3 * count) as f64;
    assert!(
        (0.5..3.0).contains(&mean),
        "{mean} for each of three numbers"
    );
}

#[test]
fn along_a_corridor_that_looks_alike_everywhere_nothing_is_known() {
    let matcher = ScanMatcher::new(ScanMatchConfig::default()).unwrap();
    let walls = outline(&[[-60.0, -1.0], [60.0, -1.0], [60.0, 1.0], [-60.0, 1.0]]);
    let poses: Vec<_> = (0..20)
        .map(|step| PlanarPose::new(0.1 * f64::from(step), 0.0, 0.0))
        .collect();
    let field = field_of(&matcher, &walls, &poses, 0.01);
    let beams = scan(
        &walls,
        &PlanarPose::new(1.0, 0.1, 0.05),
        (180, PI),
        0.01,
        &mut SplitMix64::new(3),
    );
    let before = PlanarPose::new(1.2, 0.0, 0.0);
    let matched = found(&matcher, &field, None, &beams, &before).unwrap();
    let sigma = [0, 1, 2].map(|axis| matched.covariance[(axis, axis)].sqrt());
    // Along it, where odometry said, and as sure as that was; across it and of the heading, as the walls say.
    assert!(
        sigma[0] > 0.1 && sigma[1] < 0.02 && sigma[2] < 0.01,
        "{sigma:?}"
    );
    assert!((matched.pose.x_m - before.x_m).abs() < 0.1 && (matched.pose.y_m - 0.1).abs() < 0.01);
}

#[test]
fn a_scan_that_fits_nowhere_in_the_window_is_not_matched() {
    let matcher = ScanMatcher::new(ScanMatchConfig::default()).unwrap();
    let field = field_of(&matcher, &room(), &[PlanarPose::default()], 0.0);
    let elsewhere = PlanarPose::new(30.0, 0.0, 0.0);
    let beams = scan(
        &room(),
        &PlanarPose::default(),
        (180, PI),
        0.0,
        &mut SplitMix64::new(1),
    );
    assert!(found(&matcher, &field, None, &beams, &elsewhere).is_none());
    assert!(found(&matcher, &field, None, &[], &PlanarPose::default()).is_none());
    let empty = LikelihoodField::new(matcher.config());
    assert!(found(&matcher, &empty, None, &beams, &PlanarPose::default()).is_none());
}

#[test]
fn what_is_no_range_and_what_is_too_far_is_left_out_in_any_order() {
    let matcher = ScanMatcher::new(ScanMatchConfig::default()).unwrap();
    let beams = [
        PlanarBeam::new(0.5, Some(2.0)),
        PlanarBeam::new(-0.5, Some(1.0)),
        PlanarBeam::new(0.1, None),
        PlanarBeam::new(0.2, Some(f64::NAN)),
        PlanarBeam::new(0.3, Some(f64::INFINITY)),
        PlanarBeam::new(f64::NAN, Some(1.0)),
        PlanarBeam::new(0.4, Some(0.0)),
        PlanarBeam::new(0.6, Some(-1.0)),
        PlanarBeam::new(0.7, Some(99.0)),
    ];
    let points = matcher.points_m(&beams);
    assert_eq!(points.len(), 2);
    assert!(points[0][1] < 0.0 && points[1][1] > 0.0);
}
