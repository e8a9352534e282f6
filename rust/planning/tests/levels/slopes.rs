//! Slopes: walked over like level floor, whatever their cells' heights differ by; their sides are edges all the same.

use crate::course::{Course, goal_at, plan, planner, way};
use geometry::Cell;
use mapping::Surface;
use planning::Path;

/// 10.8 degrees.
const RISE: f64 = 0.19;
const BEGINS_M: f64 = 0.6;
const TOP_M: f64 = 0.12;
const HALF_WIDTH_M: f64 = 0.5;

/// A slope along `heading_rad` through the origin, up to a platform, that rises so much per metre, `told` to be one or not. Of where it begins the camera has made
/// a level strip.
fn slope(heading_rad: f64, rise: f64, told: bool) -> Course {
    let mut course = Course::floor();
    let (sin, cos) = libm::sincos(heading_rad);
    let cells: Vec<Cell> = course.view.cells.area().cells().collect();
    for cell in cells {
        let [x, y] = course.view.lattice.center_of(cell);
        let (along_m, aside_m) = (cos * x + sin * y, cos * y - sin * x);
        let up_m = along_m - BEGINS_M;
        if up_m <= 0.0 || aside_m.abs() > HALF_WIDTH_M {
            continue;
        }
        let strip = up_m < 0.1;
        let height_m = if strip { 0.016 } else { TOP_M.min(rise * up_m) };
        *course.view.cells.get_mut(cell).unwrap() = Surface::Floor(height_m as f32);
        if told && !strip && height_m < TOP_M {
            let gradient = [rise * cos, rise * sin].map(|rise| rise as f32);
            *course.view.gradients.get_mut(cell).unwrap() = gradient;
        }
    }
    course
}

/// The longest way off the straight line along `heading_rad`, m.
fn off_m(path: &Path, heading_rad: f64) -> f64 {
    let (sin, cos) = libm::sincos(heading_rad);
    let off_m = path.points_m.iter().map(|[x, y]| (cos * y - sin * x).abs());
    off_m.fold(0.0, f64::max)
}

#[test]
fn a_slope_in_any_direction_is_walked_straight_up() {
    for heading_rad in [0.0, 0.4, std::f64::consts::FRAC_PI_4] {
        let (sin, cos) = libm::sincos(heading_rad);
        let goal = goal_at(1.6 * cos, 1.6 * sin, TOP_M);
        let path = way(&slope(heading_rad, RISE, true), heading_rad, &goal);
        assert!(path.climbs.is_empty());
        let last = path.points_m.last().unwrap();
        assert!(geometry::hypot(last[0], last[1]) > 1.4, "{last:?}");
        assert!(off_m(&path, heading_rad) < 0.1, "{heading_rad}");
    }
}

#[test]
fn what_is_not_told_to_be_a_slope_is_no_way_up() {
    let heading_rad = std::f64::consts::FRAC_PI_4;
    let (sin, cos) = libm::sincos(heading_rad);
    let goal = goal_at(1.6 * cos, 1.6 * sin, TOP_M);
    let course = slope(heading_rad, RISE, false);
    let found = plan(&mut planner(), &course, [0.0; 3], heading_rad, &goal);
    let up = |path: &Path| {
        path.points_m
            .last()
            .is_some_and(|at| geometry::hypot(at[0], at[1]) > 1.4)
    };
    assert!(!found.way.is_ok_and(|path| up(&path)));
}

/// A slope of 15 degrees across the whole floor, with a platform behind it.
#[test]
fn a_slope_that_is_too_steep_is_refused_by_its_word_before_it_is_met() {
    let course = slope(0.0, libm::tan(15.0_f64.to_radians()), true);
    let (goal, mut planner) = (goal_at(1.6, 0.0, TOP_M), planner());
    let (mut at, mut calls) = ([0.0; 2], 0);
    let mut nearest_m = f64::INFINITY;
    let no_way = loop {
        calls += 1;
        assert!(calls < 2000, "it looks for ever");
        match plan(&mut planner, &course, [at[0], at[1], 0.0], 0.0, &goal).way {
            Ok(path) => at = path.points_m[2.min(path.points_m.len() - 1)],
            Err(no_way) => break no_way,
        }
        if at[1].abs() < HALF_WIDTH_M {
            nearest_m = nearest_m.min(BEGINS_M - at[0]);
        }
    };
    assert!(nearest_m > 0.0, "{nearest_m}");
    assert_eq!(no_way.refusal.word(), "too_steep");
    assert_eq!(
        no_way.sentence,
        "the slope is 15 degrees steep, 11 degrees is the limit"
    );
}

/// Soles are set level before an edge: on a slope of 9 degrees a robot that went down its side, and had to step back, fell.
#[test]
fn no_step_is_taken_from_a_slope() {
    let climbs = |rise: f64| {
        let mut course = Course::staircase(1, 0.03, 0.33);
        let gradients = course.view.gradients.values_mut();
        gradients.fill([0.0, rise as f32]);
        let found = plan(
            &mut planner(),
            &course,
            [0.0; 3],
            0.0,
            &goal_at(1.165, 0.0, 0.03),
        );
        found.way.map_or(0, |path| path.climbs.len())
    };
    assert_eq!([0.0, 0.04, 0.15].map(climbs), [1, 1, 0]);
}

#[test]
fn its_side_is_an_edge_where_it_is_high() {
    let course = slope(0.0, RISE, true);
    let goal = goal_at(1.1, 0.8, 0.0);
    let path = way(&course, 0.0, &goal);
    for [x, y] in path.points_m {
        let on_it = x > BEGINS_M + 0.3 && y < HALF_WIDTH_M + 0.04;
        assert!(!on_it, "over the side at {x} {y}");
    }
}
