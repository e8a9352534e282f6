//! What a foot met and nobody saw: a way around it, or the word for it.

use mapping::{FeltPlace, FloorView, Surface};
use planning::Refusal;

use super::{START, floor, goal, paint, plan, planner, way};

/// The floor with a place at which a foot that walked along x met something.
fn met() -> FloorView {
    let mut view = floor();
    view.felt.push(FeltPlace {
        at_m: [0.5, 0.02],
        heading_rad: 0.0,
        top_m: 0.015,
        ground_m: 0.0,
        half_width_m: 0.04,
        thing: 0,
    });
    view
}

#[test]
fn a_way_leads_around_what_a_foot_met() {
    let view = met();
    let path = way(&mut planner(), &view, START, &goal(1.2, 0.0));
    let nearest_m = path
        .points_m
        .iter()
        .map(|&[x, y]| geometry::hypot(x - 0.5, y - 0.02));
    assert!(nearest_m.fold(f64::INFINITY, f64::min) > 0.14);
    assert!(path.cost_m > 1.2);
}

#[test]
fn where_only_what_a_foot_met_bars_the_way_the_refusal_says_what_and_where() {
    let mut view = met();
    for side_m in [[-2.0, -0.22], [0.22, 2.0]] {
        paint(
            &mut view,
            [-2.0, side_m[0]],
            [2.0, side_m[1]],
            Surface::Obstacle(0.5),
        );
    }
    let no_way = plan(&mut planner(), &view, START, &goal(1.2, 0.0))
        .way
        .unwrap_err();
    assert_eq!(no_way.refusal, Refusal::Blocked);
    assert!(
        no_way
            .sentence
            .starts_with("a foot met something at (0.50, 0.02) that is 15 mm high or more"),
        "{}",
        no_way.sentence
    );
    view.felt.clear();
    assert!(
        plan(&mut planner(), &view, START, &goal(1.2, 0.0))
            .way
            .is_ok()
    );
}
