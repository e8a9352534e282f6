//! Goals that lie beyond the window.

use crate::course::{Course, goal, goal_at, plan, planner, way};
use geometry::Cell;
use mapping::Surface;
use planning::{Goal, Path, PathEnd};

#[test]
fn a_way_up_that_may_go_on_is_not_given_up_for_known_ground_that_leads_away() {
    let mut course = Course::staircase(1, 0.03, 1.0);
    course.wall_in(0.5);
    course.stairs.stairs[0].back_fit = None;
    course.stairs.stairs[0].seen_ends.back = 0;
    course.forget([1.33, -0.5], [2.0, 0.5]);
    // The border behind the robot is reached over known ground, 12 m before the goal. Ahead half a metre is unseen.
    let path = way(&course, 0.0, &goal_at(10.0, 0.0, 0.0));
    let end = path.points_m.last().unwrap();
    assert!(end[0] > 1.0, "{end:?}");
}

#[test]
fn the_end_of_what_is_seen_of_a_level_is_looked_at_rather_than_gone_back_from() {
    let mut course = Course::floor();
    course.forget([-2.0, -2.0], [2.0, 2.0]);
    course.paint([-2.0, -2.0], [2.0, -1.2], Surface::Floor(0.0));
    // A deck that goes on as far as the window behind the robot, and that was seen up to a metre ahead.
    course.paint([-2.0, -0.5], [1.0, 0.5], Surface::Floor(0.3));
    let start = [0.0, 0.0, 0.3];
    let ahead = plan(&mut planner(), &course, start, 0.0, &goal_at(4.0, 0.0, 0.3));
    let ahead = ahead.way.unwrap();
    assert_eq!(ahead.end, PathEnd::Look);
    assert!(ahead.points_m.last().unwrap()[0] > 0.5);
    let behind = plan(
        &mut planner(),
        &course,
        start,
        0.0,
        &goal_at(-4.0, 0.0, 0.3),
    );
    assert_eq!(behind.way.unwrap().end, PathEnd::Border);
}

#[test]
fn a_shorter_way_is_taken_though_the_window_has_moved_on_and_its_border_is_further_away() {
    let mut planner = planner();
    let mut course = Course::floor();
    let wall = Surface::Obstacle(0.5);
    course.paint([0.4, -2.0], [0.48, 0.6], wall);
    course.forget([0.3, 0.6], [0.6, 2.0]);
    let far = goal(6.0, 0.0);
    let around = plan(&mut planner, &course, [0.0; 3], 0.0, &far);
    let highest_m = |path: &Path| path.points_m.iter().map(|p| p[1]).fold(0.0, f64::max);
    assert!(highest_m(&around.way.unwrap()) > 0.6);
    course.paint([0.3, -2.0], [0.6, 2.0], Surface::Floor(0.0));
    course.view.lattice.origin_m[0] += 0.8;
    let through = plan(&mut planner, &course, [0.0; 3], 0.0, &far);
    let through = through.way.unwrap();
    assert!(highest_m(&through) < 0.1, "{:?}", through.points_m);
}

/// Walls, as rectangles: a blind alley, 5 m deep, open to the left, with the goal behind its end.
const ALLEY: [[[f64; 2]; 2]; 3] = [
    [[-1.0, -0.7], [4.0, -0.6]],
    [[-1.0, 0.6], [4.0, 0.7]],
    [[4.0, -0.7], [4.1, 0.7]],
];

/// What is seen of them through a window around the robot. What is outside is not remembered.
fn seen_from(at_m: [f64; 2], walls: &[[[f64; 2]; 2]]) -> Course {
    let mut course = Course::floor();
    let cell_m = course.view.lattice.cell_m;
    course.view.lattice.origin_m = at_m.map(|m| (m / cell_m).round() * cell_m - 2.0);
    for [low, high] in walls {
        course.paint(*low, *high, Surface::Obstacle(0.5));
    }
    course
}

/// Metres walked until the goal is reached, 200 at most, by one who plans anew every 10 cm.
fn walked_m(walls: &[[[f64; 2]; 2]], goal: &Goal) -> f64 {
    const STRIDE_M: f64 = 0.1;
    let mut planner = planner();
    let (mut at, mut walked_m) = ([0.0, 0.0], 0.0);
    while walked_m < 200.0 && geometry::hypot(goal.x_m - at[0], goal.y_m - at[1]) > goal.radius_m {
        let course = seen_from(at, walls);
        let here = course.view.cell(Cell::new(50, 50));
        assert!(matches!(here, Surface::Floor(_)), "in a wall at {at:?}");
        let plan = plan(&mut planner, &course, [at[0], at[1], 0.0], 0.0, goal);
        let path = plan.way.unwrap();
        let ahead =
            |point: &&[f64; 2]| geometry::hypot(point[0] - at[0], point[1] - at[1]) >= STRIDE_M;
        let next = path.points_m.iter().find(ahead);
        at = *next.or(path.points_m.last()).unwrap();
        walked_m += STRIDE_M;
    }
    walked_m
}

#[test]
fn the_way_out_of_a_blind_alley_that_is_larger_than_the_window_is_found() {
    let behind = goal(5.2, 0.0);
    let straight_m = walked_m(&[], &behind);
    assert!(straight_m < 6.0, "{straight_m}");
    // In, out and around are 13 m.
    let out_m = walked_m(&ALLEY, &behind);
    assert!(out_m < 20.0, "{out_m}");
}

/// A wall that ends 3.6 m ahead and has a gap behind, 0.6 m wide; the goal is on the other side of it.
const LONG_WALL: [[[f64; 2]; 2]; 2] = [[[-0.9, 0.5], [3.6, 0.6]], [[-6.0, 0.5], [-1.5, 0.6]]];

#[test]
fn a_goal_that_comes_in_sight_behind_a_long_wall_is_not_walked_back_for() {
    // Past the gap and on along the wall: when the goal comes into the window, the wall's end is still outside, and the gap is the
    // one way that lies in it.
    let behind = goal(2.9, 1.2);
    let mut planner = planner();
    let mut at = [0.0, 0.0];
    let mut turned_back_m = 0.0_f64;
    for _ in 0..120 {
        let course = seen_from(at, &LONG_WALL);
        let plan = plan(&mut planner, &course, [at[0], at[1], 0.0], 0.0, &behind);
        let path = plan.way.unwrap();
        let ahead = |point: &&[f64; 2]| geometry::hypot(point[0] - at[0], point[1] - at[1]) >= 0.1;
        let next = *path
            .points_m
            .iter()
            .find(ahead)
            .or(path.points_m.last())
            .unwrap();
        turned_back_m += (at[0] - next[0]).max(0.0);
        at = next;
    }
    assert!(
        geometry::hypot(at[0] - behind.x_m, at[1] - behind.y_m) <= behind.radius_m,
        "{at:?}"
    );
    assert!(turned_back_m < 1.5, "{turned_back_m}");
}

#[test]
fn a_goal_on_another_level_outside_of_the_window_is_gone_towards_up_to_the_border() {
    // Of the border nothing was seen yet: that is no reason to stop there.
    let mut course = Course::floor();
    course.forget([1.6, -2.0], [2.0, 2.0]);
    let path = way(&course, 0.0, &goal_at(3.5, 0.0, 0.08));
    assert_eq!(path.end, PathEnd::Border);
}
