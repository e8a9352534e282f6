//! Goals that lie beyond the window.

use crate::course::{Course, goal, goal_at, plan, planner, way};
use mapping::Surface;
use planning::Path;

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
