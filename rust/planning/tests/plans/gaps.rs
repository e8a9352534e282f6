//! Doors, gaps and goals that are shut in: what is passed, and by which word it is refused.

use geometry::{Goal, PlanarPose};
use mapping::Surface;
use planning::Refusal;

use super::{START, floor, goal, paint, plan, planner, refused, wall_with_door, way};

#[test]
fn a_wide_door_is_passed_in_its_middle_and_a_narrow_one_is_refused_with_figures() {
    let path = way(
        &mut planner(),
        &wall_with_door(0.56),
        START,
        &goal(1.5, 0.0),
    );
    let in_door = path.points_m.iter().filter(|p| p[0] > 0.8 && p[0] < 0.88);
    assert!(in_door.clone().count() > 0);
    for point in in_door {
        assert!(point[1].abs() < 0.06, "{point:?}");
    }
    let (refusal, sentence) = refused(&wall_with_door(0.24), &goal(1.5, 0.0));
    assert_eq!(refusal, Refusal::TooNarrow);
    assert_eq!(sentence, "the widest gap is 0.24 m, 0.34 m are needed");
}

#[test]
fn a_narrow_gap_in_what_was_seen_of_a_wall_is_no_gap() {
    let mut view = wall_with_door(0.24);
    paint(&mut view, [0.8, -0.12], [0.88, 0.12], Surface::Unknown);
    assert_eq!(refused(&view, &goal(1.5, 0.0)).0, Refusal::Blocked);
}

#[test]
fn standing_before_a_narrow_door_does_not_open_it() {
    let view = wall_with_door(0.24);
    for x in [0.5, 0.6, 0.7] {
        let start = PlanarPose::new(x, 0.0, 0.0);
        let plan = plan(&mut planner(), &view, start, &goal(1.5, 0.0));
        assert_eq!(
            plan.way.unwrap_err().refusal,
            Refusal::TooNarrow,
            "from {x}"
        );
    }
}

#[test]
fn boxed_in_is_blocked() {
    let mut view = floor();
    let wall = Surface::Obstacle(0.4);
    paint(&mut view, [-0.7, -0.7], [0.7, 0.7], wall);
    paint(&mut view, [-0.6, -0.6], [0.6, 0.6], Surface::Floor(0.0));
    let (refusal, sentence) = refused(&view, &goal(1.5, 0.0));
    assert_eq!(refusal, Refusal::Blocked);
    assert!(
        sentence.contains("nearer to the goal than 0.9"),
        "{sentence}"
    );
    // A crack that the map has by chance is no gap.
    paint(&mut view, [0.5, 0.0], [0.8, 0.04], Surface::Unknown);
    assert_eq!(refused(&view, &goal(1.5, 0.0)).0, Refusal::Blocked);
}

#[test]
fn a_goal_is_shut_in_where_walls_stand_around_it_and_not_where_they_stand_around_the_robot() {
    let shuts = |around_m: f64, goal_x_m: f64| {
        let mut view = floor();
        let square = |half_m: f64| [[around_m - half_m, -half_m], [around_m + half_m, half_m]];
        let ([from_m, to_m], [inner_from_m, inner_to_m]) = (square(0.7), square(0.6));
        paint(&mut view, from_m, to_m, Surface::Obstacle(0.4));
        paint(&mut view, inner_from_m, inner_to_m, Surface::Unknown);
        let end = goal(goal_x_m, 0.0);
        let no_way = plan(&mut planner(), &view, START, &end).way.unwrap_err();
        assert_eq!(no_way.refusal, Refusal::Blocked);
        no_way.shuts_goal_in
    };
    assert!(shuts(1.0, 1.0), "a room around the goal, never seen inside");
    assert!(!shuts(0.0, 1.5), "the robot is shut in");
}

#[test]
fn a_goal_under_an_obstacle_is_reached_at_the_discs_free_side_or_refused() {
    let mut view = floor();
    paint(&mut view, [1.1, -0.2], [1.5, 0.2], Surface::Obstacle(0.3));
    let disc = Goal {
        radius_m: 0.45,
        ..goal(1.3, 0.0)
    };
    let path = way(&mut planner(), &view, START, &disc);
    let end = path.points_m.last().unwrap();
    assert!(geometry::hypot(end[0] - 1.3, end[1]) <= 0.45);
    let (refusal, sentence) = refused(&view, &goal(1.3, 0.0));
    assert_eq!(refusal, Refusal::Blocked);
    assert!(sentence.contains("0.15 m of the goal"), "{sentence}");
}
