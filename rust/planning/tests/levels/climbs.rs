//! Legs that are climbed: where they begin and end, what they cross, what is refused.

use crate::course::{self, Course, FEET, goal, goal_at, plan, planner, refused, way};
use geometry::Map;
use mapping::Surface;
use planning::{AStar, AStarConfig, Path, Planner as _, Refusal};
use stairs::ClimbingConfig;

/// All crossings of a path, in their order.
fn crossings(path: &Path) -> Vec<[f64; 2]> {
    let steps = path.climbs.iter().flat_map(|climb| &climb.steps);
    steps.map(|step| step.crossing_m).collect()
}

/// Changes of height in mm, in their order.
fn rises_mm(path: &Path) -> Vec<i64> {
    let steps = path.climbs.iter().flat_map(|climb| &climb.steps);
    steps
        .map(|step| (step.rise_m * 1e3).round() as i64)
        .collect()
}

#[test]
fn a_staircase_is_one_leg_that_begins_with_the_toes_15_mm_before_it() {
    let course = Course::staircase(4, 0.03, 0.33);
    let path = way(&course, 0.0, &goal_at(1.0 + 3.0 * 0.12 + 0.165, 0.0, 0.12));
    assert_eq!(path.climbs.len(), 1, "{:?}", path.climbs);
    let climb = &path.climbs[0];
    assert_eq!(rises_mm(&path), [30, 30, 30, 30]);
    assert_eq!(climb.to_point - climb.from_point, 4);
    let [x, y] = path.points_m[climb.from_point];
    assert!(
        (x + 0.5 * FEET.length_m - (1.0 - 0.015)).abs() < 1e-6,
        "{x}"
    );
    assert!(y.abs() < 0.05, "{y}");
    for (i, step) in climb.steps.iter().enumerate() {
        assert!((step.crossing_m[0] - (1.0 + 0.12 * i as f64)).abs() < 1e-6);
        assert!(
            step.stair
                .front
                .beyond_m(path.points_m[climb.from_point + i])
                < 0.0
        );
        assert!(
            step.stair
                .front
                .beyond_m(path.points_m[climb.from_point + i + 1])
                > 0.0
        );
    }
    // On the first three treads the heels are on the edge, on the landing a little beyond.
    let heel_m = path.points_m[climb.from_point + 1][0] - 0.5 * FEET.length_m;
    assert!((heel_m - 1.0).abs() < 1e-6, "{heel_m}");
}

#[test]
fn a_staircase_seen_from_above_is_gone_down_with_its_stairs_turned() {
    let course = Course::staircase(4, 0.03, 0.33);
    let start = [1.0 + 3.0 * 0.12 + 0.165, 0.0, 0.12];
    let path = course::way_from(&course, start, 3.0, &goal_at(0.2, 0.0, 0.0));
    assert_eq!(rises_mm(&path), [-30, -30, -30, -30]);
    for step in path.climbs.iter().flat_map(|climb| &climb.steps) {
        assert!(
            libm::cos(step.stair.front.heading_rad()) < -0.99,
            "it faces the other way"
        );
        let before = [step.crossing_m[0] + 0.05, step.crossing_m[1]];
        assert!(step.stair.front.beyond_m(before) < 0.0);
    }
    let climb = &path.climbs[0];
    let [x, _] = path.points_m[climb.from_point];
    // Toes 15 mm over the landing's front edge.
    assert!(
        (x - 0.5 * FEET.length_m - (1.36 - 0.015)).abs() < 1e-6,
        "{x}"
    );
}

#[test]
fn a_sill_across_the_stage_is_crossed_where_the_path_comes() {
    let mut course = Course::stage();
    course.sill(0.8, 0.09, 0.038, 1.0);
    for y in [-0.2, 0.0, 0.2] {
        let path = course::way_from(&course, [0.0, y, 0.0], 0.0, &goal(1.6, y));
        assert_eq!(rises_mm(&path), [38, -38]);
        assert_eq!(path.climbs.len(), 1);
        for crossing in crossings(&path) {
            assert!((crossing[1] - y).abs() < 0.06, "{crossing:?} for {y}");
        }
    }
}

#[test]
fn between_two_cheeks_a_staircase_is_climbed_away_from_both() {
    let mut course = Course::floor();
    for i in 0..4 {
        let x = 0.8 + 0.12 * f64::from(i);
        course.stair(x, 0.12, 0.03 * f64::from(i + 1), 0.8);
    }
    course.paint([1.16, -0.4], [1.96, 0.4], Surface::Floor(0.12));
    let wall = Surface::Obstacle(0.6);
    for y in [-0.48, 0.4] {
        course.paint([0.8, y], [1.96, y + 0.08], wall);
    }
    let goal = goal_at(1.6, 0.0, 0.12);
    for start in [[0.3, 0.5, 0.0], [0.6, 0.24, 0.0]] {
        let path = course::way_from(&course, start, 0.0, &goal);
        assert_eq!(crossings(&path).len(), 4);
        for [_, y] in crossings(&path) {
            assert!(y.abs() < 0.12, "{y}: the cheek begins at 0.4");
        }
    }
    // Where being near costs nothing, it goes as near as it may.
    let config = AStarConfig {
        soft_range: 0.0,
        judge_range: 10.0,
        ..AStarConfig::default()
    };
    let mut near = AStar::new(config, ClimbingConfig::default(), FEET, 0.14).unwrap();
    let path = plan(&mut near, &course, [0.3, 0.5, 0.0], 0.0, &goal)
        .way
        .unwrap();
    assert!(
        crossings(&path)
            .iter()
            .all(|[_, y]| (0.12..0.24).contains(y))
    );
}

#[test]
fn over_ground_that_was_not_seen_no_way_leads_onto_a_sill() {
    for unseen_m in [0.04, 0.08, 0.12, 0.16, 0.2] {
        let mut course = Course::stage();
        course.sill(0.8, 0.09, 0.038, 1.0);
        course.forget([0.8 - unseen_m, -0.5], [0.8, 0.5]);
        let path = way(&course, 0.0, &goal(1.6, 0.0));
        assert_eq!(rises_mm(&path), [38, -38], "{unseen_m}");
    }
}

#[test]
fn a_short_way_around_a_sill_is_preferred_and_a_long_one_is_not() {
    let mut short = Course::floor();
    short.sill(0.8, 0.09, 0.038, 0.5);
    assert!(way(&short, 0.0, &goal(1.6, 0.0)).climbs.is_empty());
    let mut long = Course::floor();
    long.sill(0.8, 0.09, 0.038, 3.4);
    assert_eq!(rises_mm(&way(&long, 0.0, &goal(1.6, 0.0))), [38, -38]);
}

#[test]
fn steps_of_55_and_65_mm_are_refused_with_figures_and_avoided_where_one_can() {
    for (rise_m, mm) in [(0.055, 55), (0.065, 65)] {
        let course = Course::staircase(3, rise_m, 0.33);
        let to = goal_at(1.4, 0.0, 3.0 * rise_m);
        let (refusal, sentence) = refused(&course, 0.0, &to);
        assert_eq!(refusal, Refusal::StepTooHigh);
        assert_eq!(
            sentence,
            format!("the step is {mm} mm high, 50 mm is the limit")
        );
        let path = way(&course, 0.0, &goal(1.0, -0.6));
        assert!(path.climbs.is_empty());
    }
}

#[test]
fn a_limit_that_was_seen_from_afar_is_looked_at_from_near_before_it_is_a_reason() {
    let mut course = Course::staircase(2, 0.091, 0.33);
    for stair in &mut course.stairs.stairs {
        (stair.front_fit, stair.back_fit) = (None, None);
    }
    let to = goal_at(1.2, 0.0, 0.182);
    let (mut planner, mut at) = (planner(), [0.0, 0.0, 0.0]);
    let path = plan(&mut planner, &course, at, 0.0, &to).way.unwrap();
    assert!(path.climbs.is_empty());
    let end = path.points_m.last().unwrap();
    assert!((0.55..0.95).contains(&end[0]), "{end:?}");
    let no_way = loop {
        at[0] += 0.02;
        assert!(at[0] < end[0] + 0.02, "it never makes up its mind");
        if let Err(no_way) = plan(&mut planner, &course, at, 0.0, &to).way {
            break no_way;
        }
    };
    assert!(at[0] > 0.45, "{at:?}");
    assert_eq!(no_way.refusal, Refusal::StepTooHigh);
}

#[test]
fn a_basin_is_entered_from_125_mm_on_and_refused_below() {
    for (depth_m, fits) in [
        (0.08, false),
        (0.10, false),
        (0.12, false),
        (0.13, true),
        (0.15, true),
    ] {
        let mut course = Course::stage();
        course.basin(0.8, depth_m, 0.03);
        let start = [0.0, 0.0, 0.03];
        if fits {
            let path = course::way_from(&course, start, 0.0, &goal(1.6, 0.0));
            assert_eq!(rises_mm(&path), [-30, 30], "{depth_m}");
        } else {
            let (refusal, sentence) = course::refused_from(&course, start, &goal(1.6, 0.0));
            assert_eq!(refusal, Refusal::GapTooShort, "{depth_m}");
            let mm = (depth_m * 1e3).round();
            assert_eq!(
                sentence,
                format!("the basin is {mm} mm deep, 125 mm is needed")
            );
        }
    }
}

#[test]
fn a_staircase_that_ends_in_the_air_is_refused() {
    // Three steps of 40 mm and nothing behind them but the floor.
    let course = Course::in_the_air(3, 0.04);
    let mut walled = course;
    walled.wall_in(0.5);
    let (refusal, sentence) = refused(&walled, 0.0, &goal_at(1.8, 0.0, 0.0));
    assert_eq!(refusal, Refusal::Drop, "{sentence}");
    assert_eq!(sentence, "it goes down 120 mm, 50 mm is the limit");
}

#[test]
fn what_lies_behind_the_first_stair_need_not_be_seen() {
    let mut course = Course::staircase(4, 0.03, 0.33);
    course.stairs.stairs.truncate(1);
    course.stairs.stairs[0].back_fit = None;
    course.forget([1.12, -1.0], [2.0, 1.0]);
    let path = way(&course, 0.0, &goal_at(1.6, 0.0, 0.12));
    assert_eq!(rises_mm(&path), [30]);
}

#[test]
fn on_a_tread_in_the_middle_of_a_flight_the_plan_begins_with_a_step() {
    let course = Course::staircase(4, 0.03, 0.33);
    let stands = |i: f64| [1.0 + 0.12 * i + 0.0525, 0.01, 0.03 * (i + 1.0)];
    for i in 0..3 {
        let up = course::way_from(&course, stands(f64::from(i)), 0.0, &goal_at(1.5, 0.0, 0.12));
        assert_eq!(up.climbs[0].from_point, 0);
        assert_eq!(rises_mm(&up).len(), 3 - i as usize);
        let down = course::way_from(
            &course,
            stands(f64::from(i)),
            std::f64::consts::PI,
            &goal(0.2, 0.0),
        );
        assert_eq!(down.climbs[0].from_point, 0);
        assert_eq!(rises_mm(&down).len(), 1 + i as usize);
    }
    // The stair under the robot is not known: the one in front is.
    let mut unknown = course;
    let _ = unknown.stairs.stairs.remove(1);
    unknown.forget([1.12, -0.5], [1.24, 0.5]);
    let path = course::way_from(&unknown, stands(1.0), 0.0, &goal_at(1.5, 0.0, 0.12));
    assert_eq!(
        (path.climbs[0].from_point, rises_mm(&path)),
        (0, vec![30, 30])
    );
}

#[test]
fn from_the_end_of_a_tread_low_steps_are_taken_one_by_one() {
    let course = Course::staircase(4, 0.018, 0.5);
    let end = goal_at(1.5, 0.0, 0.072);
    for beyond_m in [0.05, 0.07, 0.085] {
        let path = course::way_from(&course, [1.0 + beyond_m, 0.0, 0.018], 0.0, &end);
        assert_eq!(rises_mm(&path), [18, 18, 18], "{beyond_m}");
    }
}

#[test]
fn a_path_follows_the_stairs_as_they_are_seen_and_is_planned_anew_when_they_move() {
    let mut planner = planner();
    let mut course = Course::staircase(2, 0.03, 0.33);
    let to = goal_at(1.3, 0.0, 0.06);
    let first = plan(&mut planner, &course, [0.0, 0.0, 0.0], 0.0, &to);
    assert!(first.replanned);
    for stair in &mut course.stairs.stairs {
        course::shift(stair, 0.008, 0.002);
    }
    let second = plan(&mut planner, &course, [0.1, 0.0, 0.0], 0.0, &to);
    assert!(!second.replanned);
    let path = second.way.unwrap();
    assert_eq!(rises_mm(&path), [32, 30]);
    assert!((crossings(&path)[0][0] - 1.008).abs() < 1e-6);
    for stair in &mut course.stairs.stairs {
        course::shift(stair, 0.05, 0.0);
    }
    assert!(plan(&mut planner, &course, [0.1, 0.0, 0.0], 0.0, &to).replanned);
    course.stairs.stairs.clear();
    assert!(plan(&mut planner, &course, [0.1, 0.0, 0.0], 0.0, &to).replanned);
}

#[test]
fn steps_taken_are_cut_off_the_path() {
    let mut planner = planner();
    let course = Course::staircase(4, 0.03, 0.33);
    let to = goal_at(1.52, 0.0, 0.12);
    let path = plan(&mut planner, &course, [0.6, 0.0, 0.0], 0.0, &to)
        .way
        .unwrap();
    let climb = path.climbs[0].clone();
    for (i, &[x, y]) in path.points_m[climb.from_point..climb.to_point]
        .iter()
        .enumerate()
    {
        let at = [x + 0.004, y - 0.003, 0.03 * i as f64];
        let plan = plan(&mut planner, &course, at, 0.0, &to);
        assert!(!plan.replanned, "after {i} steps");
        let rest = plan.way.unwrap();
        assert_eq!(rises_mm(&rest).len(), 4 - i);
        assert!(rest.climbs[0].from_point <= 1, "after {i} steps");
    }
}

#[test]
fn a_goal_on_the_platform_is_no_goal_below_it() {
    let course = Course::staircase(4, 0.03, 0.33);
    // The disc holds floor beside the landing as well.
    let mut to = goal_at(1.52, 0.0, 0.12);
    to.radius_m = 0.3;
    assert_eq!(rises_mm(&way(&course, 0.0, &to)).len(), 4);
    let mut any = goal(1.52, 0.35);
    any.radius_m = 0.15;
    assert!(way(&course, 0.0, &any).climbs.is_empty());
}

#[test]
fn the_obstacle_field_does_not_hold_treads() {
    let mut planner = planner();
    let course = Course::staircase(4, 0.03, 0.33);
    let _ = plan(&mut planner, &course, [0.0; 3], 0.0, &goal(0.5, 0.0));
    let field = planner.distance_field_m().unwrap();
    assert!(field.iter().all(|&distance_m| distance_m > 10.0));
}

#[test]
fn after_the_last_step_the_robot_walks_on_over_the_landing() {
    let course = Course::staircase(4, 0.03, 0.33);
    let path = course::way_from(
        &course,
        [1.36 + 0.0675, 0.0, 0.12],
        0.0,
        &goal_at(1.52, 0.0, 0.12),
    );
    assert!(path.climbs.is_empty());
    assert!(path.points_m.iter().all(|point| point[1].abs() < 0.05));
}

#[test]
fn a_turning_staircase_is_climbed_square_to_each_edge() {
    let mut course = Course::floor();
    let mut foot = geometry::Pose::<Map, Map>::from_yaw(1.0, 0.0, 0.0, 0.0);
    for i in 0..4 {
        let depth_m = if i == 3 { 0.33 } else { 0.15 };
        let step = course::stair(0.0, depth_m, 0.03 * f64::from(i + 1), 0.45);
        let step = step.transformed(&foot);
        let next = step.back.middle().inner;
        foot = geometry::Pose::from_yaw(next.x, next.y, 0.0, 0.1 * f64::from(i + 1));
        course.stairs.stairs.push(step);
    }
    let landing = course.stairs.stairs[3].reference.inner;
    let path = way(&course, 0.0, &goal_at(landing.x, landing.y, 0.12));
    assert_eq!(rises_mm(&path), [30, 30, 30, 30]);
    let steps = path.climbs.iter().flat_map(|climb| &climb.steps);
    for (i, step) in steps.enumerate() {
        assert!((step.stair.front.heading_rad() - 0.1 * i as f64).abs() < 1e-9);
        let middle = step.stair.front.middle().inner;
        assert!(
            geometry::hypot(step.crossing_m[0] - middle.x, step.crossing_m[1] - middle.y) < 0.07
        );
    }
}

/// On a tread the feet move aside a centimetre at a time.
#[test]
fn from_tread_to_tread_a_way_leads_straight_on_as_soon_as_the_next_edge_is_seen_to_reach_there() {
    let mut course = Course::staircase(3, 0.03, 0.68);
    let whole = course.stairs.stairs[1];
    let part = &mut course.stairs.stairs[1];
    (part.front.left.inner.y, part.back.left.inner.y) = (0.0, 0.0);
    course.forget([1.12, 0.0], [1.6, 0.34]);
    let (mut planner, to) = (planner(), goal_at(1.4, 0.0, 0.09));
    let aside = plan(&mut planner, &course, [0.0; 3], 0.0, &to).way.unwrap();
    assert!(crossings(&aside)[1][1] < -0.1, "{aside:?}");
    course.stairs.stairs[1] = whole;
    let path = plan(&mut planner, &course, [0.0; 3], 0.0, &to).way.unwrap();
    for crossing in crossings(&path) {
        assert!(
            (crossing[1] - crossings(&aside)[0][1]).abs() < 1e-6,
            "{crossing:?}"
        );
    }
}
