//! Which edges are fitted, and which fits a stair takes over.

use geometry::{Camera, Point};
use proptest::prelude::*;

use super::*;
use crate::{FittedEdge, Sides};
use testkit::synthetic::{CAMERA, camera_pose};

/// A step of 30 mm whose front was labelled 1 cm too far, and whose edge was fitted between levels that are off.
fn front_fit(off_m: f64) -> Option<EdgeFit> {
    let stair = stair_with(&[(0.5, off_m, 0.003)]);
    let at_m = if stair.front_fit.is_some() { 0.5 } else { 0.51 };
    assert!(stair.front.beyond_m([at_m, 0.0]).abs() < 1e-9);
    stair.front_fit
}

/// A step of 30 mm after edges were fitted at these places, with these errors of the levels and these sigmas, m.
fn stair_with(edges: &[(f64, f64, f64)]) -> Stair<Map> {
    let edge = |x_m: f64, z_m: f64| Edge {
        left: Point::<Map>::new(x_m, 0.2, z_m),
        right: Point::<Map>::new(x_m, -0.2, z_m),
    };
    let camera = Pose::<Map, Camera>::identity();
    let tuning = StairsTuning::default();
    let mut fits = Fits::new(CAMERA, &tuning);
    for &(x_m, off_m, place_sigma_m) in edges {
        let at = edge(x_m, 0.03);
        let heights_m = [off_m, 0.03 + off_m];
        let fitted = FittedEdge {
            edge: at.transformed(&Pose::<Robot, Map>::identity()),
            place_sigma_m,
            heading_sigma_rad: 0.02,
            near_height_m: heights_m[0],
            far_height_m: heights_m[1],
        };
        fits.edges.push(FusedEdge::new(
            &fitted,
            &at,
            heights_m,
            &camera,
            &tuning.edges.fusion,
        ));
    }
    let mut stairs = [Stair {
        front: edge(0.51, 0.03),
        back: edge(0.63, 0.03),
        reference: Point::new(0.57, 0.0, 0.03),
        left_margin_m: 0.0,
        right_margin_m: 0.0,
        support: 300,
        seen_ends: Sides::default(),
        front_fit: None,
        back_fit: None,
        seen_from_m: 0.5,
        steps_ago: 0,
    }];
    fits.apply(&mut stairs, &tuning.edges);
    let [stair] = stairs;
    stair
}

#[test]
fn the_part_ahead_of_an_edge_lies_on_it_around_where_it_is_crossed() {
    for (aside_m, ends_m) in [
        (-0.2, [0.15, -0.15]),
        (0.0, [0.15, -0.15]),
        (0.5, [-0.1, -0.25]),
    ] {
        let at = |y_m: f64| Point::<Robot>::new(0.07, y_m, 0.05);
        let edge = Edge {
            left: at(0.4 - aside_m),
            right: at(-0.4 - aside_m),
        };
        let part = part_ahead(&edge, FitsTuning::default().ahead);
        for (end, y_m) in [part.left, part.right].iter().zip(ends_m) {
            assert!((end.inner - at(y_m).inner).norm() < 1e-12, "{part:?}");
        }
    }
}

#[test]
fn of_two_fits_of_one_edge_the_surer_counts_whichever_came_first() {
    let (near, far) = ((0.5, 0.0, 0.002), (0.53, 0.006, 0.0055));
    for edges in [[near, far], [far, near]] {
        let stair = stair_with(&edges);
        assert!(stair.front.beyond_m([0.5, 0.0]).abs() < 1e-9, "{stair:?}");
        assert!(
            stair
                .front_fit
                .is_some_and(|fit| fit.place_sigma_m < 0.0025)
        );
    }
}

proptest! {
    #[test]
    fn an_edge_that_was_fitted_between_other_levels_is_none_of_a_stairs(
        off_m in 0.0075..0.03f64, low in any::<bool>(),
    ) {
        prop_assert_eq!(front_fit(if low { -off_m } else { off_m }), None);
    }

    #[test]
    fn an_edge_that_was_fitted_between_the_same_levels_is(off_m in -0.0065..0.0065f64) {
        prop_assert!(front_fit(off_m).is_some());
    }
}

#[test]
fn an_edge_whose_middle_is_out_of_view_is_looked_for_behind_the_stair_before_it_or_ahead() {
    let mut planes = Planes::new(CAMERA.width * CAMERA.height);
    planes.robot_from_camera = camera_pose(0.0, 1.0);
    let tuning = StairsTuning::default();
    let view = PlanesView::new(&planes, CAMERA, &tuning.view);
    let stair = |[front_m, back_m]: [f64; 2], ends_m: [f64; 2], z_m| {
        let edge = |x_m: f64| {
            let [right, left] = ends_m.map(|y_m| Point::<Robot>::new(x_m, y_m, z_m));
            Edge { left, right }
        };
        let (front, back) = (edge(front_m), edge(back_m));
        Stair::seen(front, back, front.middle(), 100).transformed(&Pose::identity())
    };
    let tread = stair([0.05, 0.2], [-0.16, 0.16], 0.0);
    let floor = |ends_m| stair([0.2, 2.0], ends_m, -0.03);
    let ends_m = |floor: &Stair<Map>, before| {
        let guess = guess(floor, before, &view, &Pose::identity(), &tuning.edges.fits);
        assert!(guess.beyond_m([0.2, 0.0]).abs() < 1e-9);
        [guess.right, guess.left].map(|end| end.inner.y)
    };
    let near = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) < 1e-9;
    assert!(near(
        ends_m(&floor([-1.4, 0.2]), Some(&tread)),
        [-0.16, 0.16]
    ));
    assert!(near(ends_m(&floor([-1.4, 0.2]), None), [-0.15, 0.15]));
    assert!(near(ends_m(&floor([-0.3, 0.3]), Some(&tread)), [-0.3, 0.3]));
}

/// Floor on both sides of a staircase whose sides the robot sees nearer than the steps.
#[test]
fn of_steps_ahead_and_the_sides_of_the_stairs_the_steps_are_fitted() {
    let mut planes = Planes::new(CAMERA.width * CAMERA.height);
    planes.robot_from_camera = camera_pose(0.0, 0.8);
    let tuning = StairsTuning::default();
    let view = PlanesView::new(&planes, CAMERA, &tuning.view);
    let stair = |right: [f64; 2], left: [f64; 2], deep: [f64; 2], z_m: f64| {
        let edge = |by: f64| Edge {
            left: Point::<Robot>::new(left[0] + by * deep[0], left[1] + by * deep[1], z_m),
            right: Point::<Robot>::new(right[0] + by * deep[0], right[1] + by * deep[1], z_m),
        };
        let mut seen = Stair::seen(edge(0.0), edge(1.0), edge(0.5).middle(), 100);
        seen.seen_ends.front = 100;
        seen.transformed(&Pose::identity())
    };
    let step = |x_m: f64, z_m| stair([x_m, -0.15], [x_m, 0.15], [0.11, 0.0], z_m);
    let stairs = [
        stair([0.3, -0.15], [0.9, -0.15], [0.0, -0.5], -0.03),
        step(0.5, 0.03),
        stair([0.9, 0.15], [0.3, 0.15], [0.0, 0.5], -0.03),
        step(0.61, 0.06),
    ];
    let here = Pose::identity();
    let none = |_: &Stair<Map>| None;
    let mut wanted = wanted(&stairs, &view, &here, none, &StairsConfig::default());
    assert_eq!(wanted.len(), stairs.len());
    wanted.sort_by(|a, b| a.ahead_m.total_cmp(&b.ahead_m));
    let heights_m = wanted
        .iter()
        .take(tuning.edges.fits.fitted)
        .map(|edge| edge.heights_m[1]);
    assert_eq!(heights_m.collect::<Vec<_>>(), [0.03, 0.06]);
}
