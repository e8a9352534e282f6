//! Noise-free frames: representation, extraction and its limits.

use super::prisms::{Prism, frame};
use super::*;
use crate::Stair;
use crate::frame::view::PlanesView;
use crate::frame::visible::seen_ends;
use crate::stair::level_edge;

pub(super) fn ground() -> Prism {
    Prism::new(&[[-3.0, -3.0], [5.0, -3.0], [5.0, 3.0], [-3.0, 3.0]], 0.0)
}

/// Looks from here with the head turned left and right, up and down.
pub(super) fn swing(prisms: &[Prism], map_from_robot: &Pose<Map, Robot>) -> Recognizer {
    let mut recognizer = Recognizer::new(StairsConfig::default(), CAMERA).unwrap();
    for i in 0..25 {
        let (pan, tilt) = (0.08 * f64::from(i % 9 - 4), 0.62 + 0.15 * f64::from(i / 9));
        let (scan, planes) = frame(prisms, map_from_robot, &camera_pose(pan, tilt));
        let _ = recognizer
            .update(&scan, &planes, map_from_robot, 0)
            .unwrap();
    }
    recognizer
}

fn degrees(a_rad: f64, b_rad: f64) -> f64 {
    geometry::wrap_angle(a_rad - b_rad).to_degrees().abs()
}

/// S11: each step's front is turned by 8 degrees about its middle against the one below.
#[test]
fn edges_of_a_spiral_staircase_are_within_1_cm_and_3_degrees() {
    let (mut middle, mut heading_rad) = ([0.45, 0.0], 0.0_f64);
    let (mut prisms, mut fronts) = (Vec::new(), Vec::new());
    for step in 0..4 {
        let (sin, cos) = heading_rad.sin_cos();
        let at = |ahead: f64, left: f64| {
            [
                middle[0] + ahead * cos - left * sin,
                middle[1] + ahead * sin + left * cos,
            ]
        };
        let corners = [at(0.0, -0.3), at(0.0, 0.3), at(0.9, 0.3), at(0.9, -0.3)];
        prisms.push(Prism::new(&corners, 0.03 * f64::from(step + 1)));
        fronts.push((middle, heading_rad));
        middle = at(0.14, 0.0);
        heading_rad += 0.14;
    }
    prisms.push(ground());
    let recognizer = swing(&prisms, &Pose::identity());
    let stairs = &recognizer.staircase.stairs;
    assert_eq!(stairs.len(), 4);
    for (stair, (middle, heading_rad)) in stairs.iter().zip(&fronts) {
        assert!(stair.front.beyond_m(*middle).abs() < 0.01, "{stair:?}");
        assert!(
            degrees(stair.front.heading_rad(), *heading_rad) < 3.0,
            "{stair:?}"
        );
    }
    for (stair, (middle, heading_rad)) in stairs.iter().zip(&fronts[1..]) {
        assert!(stair.back.beyond_m(*middle).abs() < 0.01, "{stair:?}");
        assert!(degrees(stair.back.heading_rad(), *heading_rad) < 3.0);
    }
}

/// S7 (Fig. 6): four planes, of which the lowest is too narrow.
#[test]
fn of_four_steps_the_one_of_5_cm_is_no_stair() {
    let step = |from_m: f64, top_m: f64| {
        Prism::new(
            &[[from_m, -0.4], [2.0, -0.4], [2.0, 0.4], [from_m, 0.4]],
            top_m,
        )
    };
    let prisms = [
        step(0.35, 0.03),
        step(0.40, 0.06),
        step(0.52, 0.09),
        step(0.64, 0.12),
        ground(),
    ];
    let recognizer = swing(&prisms, &Pose::identity());
    let heights: Vec<_> = recognizer
        .staircase
        .stairs
        .iter()
        .map(Stair::height_m)
        .collect();
    assert_eq!(heights.len(), 3, "{heights:?}");
    for (found_m, height_m) in heights.iter().zip([0.06, 0.09, 0.12]) {
        assert!((found_m - height_m).abs() < 0.003);
    }
}

/// S10: a stair of 0.8 m from 0.4 m away; no view shows more than half of it.
#[test]
fn a_head_swing_finds_nine_tenths_of_an_edge_and_no_more_than_2_cm_too_much() {
    let prisms = [
        Prism::new(&[[0.45, -0.4], [0.6, -0.4], [0.6, 0.4], [0.45, 0.4]], 0.03),
        Prism::new(&[[0.6, -0.4], [1.2, -0.4], [1.2, 0.4], [0.6, 0.4]], 0.06),
        ground(),
    ];
    let mut recognizer = Recognizer::new(StairsConfig::default(), CAMERA).unwrap();
    for i in 0..40 {
        let camera = camera_pose(0.8 * (f64::from(i) / 6.0).sin(), 0.75);
        let (scan, planes) = frame(&prisms, &Pose::identity(), &camera);
        let _ = recognizer
            .update(&scan, &planes, &Pose::identity(), 0)
            .unwrap();
    }
    let first = &recognizer.staircase.stairs[0];
    for edge in [&first.front, &first.back] {
        assert!(
            (0.72..0.82).contains(&edge.length_m()),
            "{}",
            edge.length_m()
        );
    }
}

#[test]
fn ground_beyond_a_sill_is_a_stair_and_the_ground_before_it_is_not() {
    let sill = Prism::new(&[[0.4, -0.8], [0.49, -0.8], [0.49, 0.8], [0.4, 0.8]], 0.038);
    let before = Prism::new(&[[-1.0, -0.8], [0.4, -0.8], [0.4, 0.8], [-1.0, 0.8]], 0.0);
    let beyond = Prism::new(&[[0.49, -0.8], [2.0, -0.8], [2.0, 0.8], [0.49, 0.8]], 0.0);
    let recognizer = swing(&[sill, before, beyond], &Pose::identity());
    let stairs = &recognizer.staircase.stairs;
    assert_eq!(stairs.len(), 2);
    let places = [(0.038, 0.4), (0.0, 0.49)];
    for (stair, (height_m, front_m)) in stairs.iter().zip(places) {
        assert!((stair.height_m() - height_m).abs() < 0.003);
        assert!(stair.front.beyond_m([front_m, 0.0]).abs() < 0.01);
    }
}

#[test]
fn stairs_down_from_a_narrow_landing_are_found_though_the_floor_lies_around_them() {
    let tread = |i: i32| {
        let (from_m, to_m) = (0.4 + 0.12 * f64::from(i), 0.52 + 0.12 * f64::from(i));
        Prism::new(
            &[[from_m, -0.2], [to_m, -0.2], [to_m, 0.2], [from_m, 0.2]],
            0.09 - 0.03 * f64::from(i),
        )
    };
    let landing = Prism::new(&[[-0.6, -0.2], [0.4, -0.2], [0.4, 0.2], [-0.6, 0.2]], 0.12);
    let prisms = [tread(0), tread(1), tread(2), landing, ground()];
    let recognizer = swing(&prisms, &Pose::from_yaw(0.0, 0.0, 0.12, 0.0));
    let ahead: Vec<_> = recognizer
        .staircase
        .stairs
        .iter()
        .filter(|stair| stair.front.heading_rad().abs() < 0.5)
        .collect();
    assert_eq!(ahead.len(), 4, "{ahead:?}");
    for (i, stair) in ahead.iter().enumerate() {
        assert!((stair.height_m() - (0.09 - 0.03 * i as f64)).abs() < 0.003);
        assert!(
            stair.front.beyond_m([0.4 + 0.12 * i as f64, 0.0]).abs() < 0.015,
            "{stair:?}"
        );
    }
}

/// A robot at the upper end of stairs looks steeply down: of the first tread the picture may show a triangle.
#[test]
fn a_corner_that_the_picture_cuts_off_a_tread_is_not_where_it_ends() {
    let prism = |x_m: [f64; 2], half_m: f64, top_m: f64| {
        let [from, to] = x_m;
        let corners = [[from, -half_m], [to, -half_m], [to, half_m], [from, half_m]];
        Prism::new(&corners, top_m)
    };
    let prisms = [
        prism([-1.0, 0.08], 0.45, 0.0),
        prism([0.08, 0.2], 0.165, -0.03),
        prism([0.2, 0.32], 0.165, -0.06),
        prism([-3.0, 4.0], 3.0, -0.12),
    ];
    let right_end = |front: [[f64; 2]; 2], back: [[f64; 2]; 2], pan_rad: f64| {
        let (_, planes) = frame(&prisms, &Pose::identity(), &camera_pose(pan_rad, 1.0));
        let config = StairsConfig::default();
        let view = PlanesView::new(&planes, CAMERA, &config.tuning.view);
        let edge = |[right, left]: [[f64; 2]; 2]| level_edge([right.into(), left.into()], -0.03);
        let (front, back) = (edge(front), edge(back));
        let stair = Stair::seen(front, back, front.middle(), 200);
        seen_ends(&stair, [false, true], &view, &config).right
    };
    let back = [[0.2, -0.165], [0.2, 0.165]];
    assert_eq!(right_end([[0.08, -0.165], [0.08, 0.165]], back, -0.3), 200);
    let cut = [[0.19, -0.03], [0.09, 0.16]];
    assert_eq!(right_end(cut, [[0.2, -0.025], [0.2, 0.165]], 0.3), 0);
}
