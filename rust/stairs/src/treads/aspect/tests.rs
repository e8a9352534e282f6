//! Which side of a tread is its front, from where the robot stands.

use proptest::prelude::*;

use super::*;
use crate::treads::border::Weights;

/// An edge that was seen, from its right to its left end.
fn border(right: [f64; 2], left: [f64; 2], weight: f64) -> Border {
    let weights = Weights {
        all: weight,
        edge: weight,
        left: weight,
        right: weight,
    };
    Border::new([&right.into(), &left.into()], weights)
}

const CORNERS: [[f64; 2]; 4] = [[1.0, -0.25], [3.0, -0.25], [3.0, 0.25], [1.0, 0.25]];

fn hull() -> Outline {
    Outline::hull(&CORNERS.map(Point2::from)).unwrap()
}

/// A landing that looks from its long side saw, then others from its front, with these weights in all.
fn landing(from_the_side: f64, from_the_front: f64) -> Aspects {
    const LOOKS: usize = 5;
    let [near_right, far_right, far_left, near_left] = CORNERS;
    let side = from_the_side / LOOKS as f64;
    let front = from_the_front / LOOKS as f64;
    let looks = [
        Aspects::new(
            border(near_left, far_left, side),
            border(near_right, far_right, side),
        ),
        Aspects::new(
            border(near_right, near_left, front),
            border(far_right, far_left, front),
        ),
    ];
    let tuning = StairsTuning::default();
    let mut aspects = looks[0].clone();
    for _ in 1..LOOKS {
        aspects.add(&looks[0], &tuning);
    }
    for _ in 0..LOOKS {
        aspects.add(&looks[1], &tuning);
    }
    aspects
}

/// Where one goes who crosses the front.
fn ahead(aspects: &mut Aspects, [x, y]: [f64; 2]) -> [i32; 2] {
    let tuning = StairsTuning::default();
    let _ = aspects.face(&hull(), &Point2::new(x, y), &tuning);
    let across = aspects.present().front.across(&tuning);
    [across.x.round() as i32, across.y.round() as i32]
}

#[test]
fn the_front_is_the_side_that_the_robot_stands_before_and_on_the_tread_it_stays() {
    let mut aspects = landing(900.0, 300.0);
    assert_eq!(ahead(&mut aspects, [2.0, 0.6]), [0, -1]);
    assert_eq!(ahead(&mut aspects, [0.8, 0.0]), [1, 0]);
    assert_eq!(ahead(&mut aspects, [2.0, 0.1]), [1, 0]);
    assert_eq!(ahead(&mut aspects, [3.3, 0.0]), [-1, 0]);
    assert_eq!(ahead(&mut aspects, [2.0, -0.6]), [0, 1]);
}

#[test]
fn a_skewed_look_is_no_side() {
    assert_eq!(ahead(&mut landing(900.0, 90.0), [0.8, 0.0]), [0, -1]);
    assert_eq!(ahead(&mut landing(90.0, 900.0), [2.0, 0.6]), [1, 0]);
}

/// The left end of a tread across the way, seen while the head turns away from it: its front is cut off by the picture's border.
fn cut_off(front_seen: f64, back: Border) -> Aspects {
    let weights = Weights {
        all: 500.0,
        edge: front_seen,
        left: 500.0,
        right: 0.0,
    };
    let ends = [[1.2, 0.0], [0.9, 0.25]].map(Point2::from);
    Aspects::new(Border::new([&ends[0], &ends[1]], weights), back)
}

/// The tread itself, after a step.
fn remembered() -> Aspects {
    let mut aspects = Aspects::new(
        border([1.0, -0.25], [1.0, 0.25], 1000.0),
        border([3.0, -0.25], [3.0, 0.25], 1000.0),
    );
    aspects.0[0].sightings = 2.0;
    aspects
}

#[test]
fn a_look_whose_front_is_cut_off_runs_as_its_back_does() {
    let tuning = StairsTuning::default();
    let mut aspects = remembered();
    for _ in 0..8 {
        aspects.add(
            &cut_off(0.0, border([3.0, 0.1], [3.0, 0.25], 60.0)),
            &tuning,
        );
    }
    assert_eq!(aspects.0.len(), 1);
    assert_eq!(ahead(&mut aspects, [0.5, 0.0]), [1, 0]);
    let [right, left] = aspects
        .present()
        .front
        .ends(&hull(), -1.0, &tuning)
        .unwrap();
    assert!((right.x - 1.0).abs() < 1e-9 && (left.x - 1.0).abs() < 1e-9);
}

#[test]
fn a_few_skewed_looks_in_a_row_are_no_side() {
    let tuning = StairsTuning::default();
    let mut aspects = remembered();
    let skewed = || cut_off(500.0, border([3.2, 0.0], [2.9, 0.25], 60.0));
    let turned = |aspects: &mut Aspects| {
        let _ = aspects.face(&hull(), &Point2::new(0.5, -0.6), &tuning);
        aspects.present().front.across(&tuning).y > 0.5
    };
    for _ in 0..3 {
        aspects.add(&skewed(), &tuning);
        assert!(!turned(&mut aspects));
    }
    aspects.add(&skewed(), &tuning);
    assert!(turned(&mut aspects), "what is seen again and again is one");
}

#[test]
fn where_only_the_view_ended_is_no_side_however_often() {
    let tuning = StairsTuning::default();
    let mut aspects = remembered();
    for _ in 0..20 {
        aspects.add(&cut_off(0.0, border([3.2, 0.0], [2.9, 0.25], 5.0)), &tuning);
    }
    let _ = aspects.face(&hull(), &Point2::new(0.5, -0.6), &tuning);
    assert!(aspects.present().front.across(&tuning).x > 0.99);
}

proptest! {
    /// Whatever was seen first: the robot stands before its front, and no side is farther from it.
    #[test]
    fn no_other_side_is_much_farther_in_front_of_the_robot(
        x in -1.0..5.0f64, y in -2.0..2.0f64, side in 1.0..4.0f64,
    ) {
        let mut aspects = landing(side * 100.0, 200.0);
        let [x_ahead, y_ahead] = ahead(&mut aspects, [x, y]);
        let outside_m = |across: [i32; 2]| match across {
            [1, 0] => 1.0 - x,
            [-1, 0] => x - 3.0,
            [0, 1] => -0.25 - y,
            _ => y - 0.25,
        };
        let sides = SidesTuning::default();
        let most_m = [[1, 0], [-1, 0], [0, 1], [0, -1]].map(outside_m);
        let most_m = most_m.into_iter().fold(f64::MIN, f64::max);
        prop_assert!(most_m <= sides.outside || outside_m([x_ahead, y_ahead]) > most_m - sides.farther);
    }
}
