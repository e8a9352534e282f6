//! Goals that are told without a height: the level is the one that their middle is seen to lie on.

use mapping::Surface;
use planning::{Goal, Planner as _};

use crate::course::{Course, goal, goal_at, plan, planner, way, way_from};

/// On the floor beside the landing, m.
const BESIDE: [f64; 3] = [1.2, -0.85, 0.0];

/// Two steps up to a landing of which the near part is seen; nothing else is seen around the goal on it.
fn landing() -> (Course, Goal) {
    let mut course = Course::floor();
    course.forget([1.4, -2.0], [2.0, 2.0]);
    course.stair(1.0, 0.15, 0.04, 0.5);
    course.stair(1.15, 0.75, 0.08, 0.5);
    // Wide enough that unseen ground beside the landing lies in it.
    let wide = Goal {
        radius_m: 0.45,
        ..goal(1.6, 0.0)
    };
    (course, wide)
}

#[test]
fn a_goal_whose_middle_is_seen_on_a_landing_is_climbed_to_and_not_hoped_for_beside_it() {
    let (course, wide) = landing();
    // Beside the landing the way to unseen ground is much shorter.
    let path = way_from(&course, BESIDE, 0.0, &wide);
    let steps: usize = path.climbs.iter().map(|climb| climb.steps.len()).sum();
    assert_eq!(steps, 2, "{:?}", path.points_m);
}

#[test]
fn the_level_that_was_seen_holds_while_it_is_out_of_sight_and_until_the_middle_is_seen_elsewhere() {
    let (mut course, wide) = landing();
    let mut planner = planner();
    let mut climbs = |course: &Course| {
        let path = plan(&mut planner, course, [0.0; 3], 0.0, &wide)
            .way
            .unwrap();
        path.climbs.len()
    };
    assert!(climbs(&course) > 0);
    course.forget([1.5, -0.2], [1.7, 0.2]);
    assert!(climbs(&course) > 0);
    let floor = Surface::Floor(0.0);
    course.stairs.stairs.clear();
    course.paint([0.9, -0.5], [2.0, 0.5], floor);
    assert_eq!(climbs(&course), 0);
}

#[test]
fn where_no_way_leads_up_any_place_in_the_disc_will_do() {
    let mut course = Course::floor();
    course.paint([1.3, -0.2], [1.7, 0.2], Surface::Floor(0.3));
    let table = Goal {
        radius_m: 0.5,
        ..goal(1.5, 0.0)
    };
    let mut planner = planner();
    let mut at = [0.0; 3];
    // It looks for a way up from all around before.
    for _ in 0..200 {
        let path = plan(&mut planner, &course, at, 0.0, &table).way.unwrap();
        let &[x, y] = path.points_m.last().unwrap();
        if geometry::hypot(x - table.x_m, y - table.y_m) <= table.radius_m {
            return;
        }
        at = [x, y, 0.0];
    }
    panic!("it never went beside the table");
}

#[test]
fn a_height_that_is_told_is_kept() {
    let (course, wide) = landing();
    let below = Goal {
        height_m: Some(0.0),
        ..wide
    };
    assert!(way(&course, 0.0, &below).climbs.is_empty());
    let above = goal_at(1.6, 0.0, 0.08);
    assert!(!way(&course, 0.0, &above).climbs.is_empty());
    let mut planner = planner();
    let start = geometry::Pose::from_yaw(0.0, 0.0, 0.0, 0.0);
    let plan = planner.plan(&course.view, &course.stairs, &start, &above);
    assert!(plan.is_ok_and(|plan| plan.way.is_ok()));
}
