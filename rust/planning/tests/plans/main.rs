//! What the planner promises: clearance, the goal's disc, replanning, and reasons where there is no way.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

mod felt;
mod gaps;
mod head_room;

use geometry::{Cell, Grid, Lattice, Map, PlanarPose, Pose, Robot};
use mapping::{FloorView, Surface};
use planning::{AStar, AStarConfig, Goal, Path, Plan, PlanError, Planner, Refusal, VoronoiConfig};
use proptest::prelude::*;
use stairs::{ClimbingConfig, Feet, Staircase};

const CELL: f64 = 0.04;
const RADIUS: f64 = 0.14;
const FEET: Feet = Feet {
    length_m: 0.105,
    pair_width_m: 0.16,
    stance_m: 0.085,
};
const START: PlanarPose = PlanarPose::new(0.0, 0.0, 0.0);

/// A window of floor, 4 m a side, around the origin.
fn floor() -> FloorView {
    FloorView::new(
        Lattice {
            origin_m: [-2.0, -2.0],
            cell_m: CELL,
        },
        Grid::filled(100, 100, Surface::Floor(0.0)),
        9,
    )
}

/// Sets all cells whose centre lies in the rectangle.
fn paint(view: &mut FloorView, min: [f64; 2], max: [f64; 2], surface: Surface) {
    for cell in view.cells.area().cells() {
        let [x, y] = view.lattice.center_of(cell);
        let inside = x > min[0] && x < max[0] && y > min[1] && y < max[1];
        if let Some(slot) = view.cells.get_mut(cell).filter(|_| inside) {
            *slot = surface;
        }
    }
}

/// A wall across the window at x = 0.8 with a door of some width around y = 0.
fn wall_with_door(width_m: f64) -> FloorView {
    let mut view = floor();
    let wall = Surface::Obstacle(0.5);
    paint(&mut view, [0.8, -2.0], [0.88, -0.5 * width_m], wall);
    paint(&mut view, [0.8, 0.5 * width_m], [0.88, 2.0], wall);
    view
}

fn goal(x_m: f64, y_m: f64) -> Goal {
    Goal {
        x_m,
        y_m,
        radius_m: 0.15,
        height_m: None,
    }
}

fn planner() -> AStar {
    AStar::new(
        AStarConfig::default(),
        ClimbingConfig::default(),
        FEET,
        RADIUS,
    )
    .unwrap()
}

fn plan(planner: &mut AStar, view: &FloorView, start: PlanarPose, goal: &Goal) -> Plan {
    let start = Pose::from_yaw(start.x_m, start.y_m, 0.0, start.yaw_rad);
    planner
        .plan(view, &Staircase::default(), &start, goal)
        .unwrap()
}

fn way(planner: &mut AStar, view: &FloorView, start: PlanarPose, goal: &Goal) -> Path {
    plan(planner, view, start, goal).way.unwrap()
}

fn refused(view: &FloorView, goal: &Goal) -> (Refusal, String) {
    let no_way = plan(&mut planner(), view, START, goal).way.unwrap_err();
    (no_way.refusal, no_way.sentence)
}

fn length_m(path: &Path) -> f64 {
    let step = |p: &[[f64; 2]]| geometry::hypot(p[1][0] - p[0][0], p[1][1] - p[0][1]);
    path.points_m.windows(2).map(step).sum()
}

/// Distance from a place to the nearest blocked cell's centre, by brute force.
fn to_obstacle_m(view: &FloorView, at: [f64; 2]) -> f64 {
    let obstacle = |cell: &Cell| matches!(view.cell(*cell), Surface::Obstacle(_));
    let away = |cell: Cell| {
        let [x, y] = view.lattice.center_of(cell);
        geometry::hypot(x - at[0], y - at[1])
    };
    let cells = view.cells.area().cells().filter(obstacle);
    cells.map(away).fold(f64::INFINITY, f64::min)
}

#[test]
fn over_open_floor_the_path_is_straight_and_ends_in_the_goals_middle() {
    let path = way(&mut planner(), &floor(), START, &goal(1.5, 0.7));
    assert!(
        (length_m(&path) - geometry::hypot(1.5_f64, 0.7)).abs() < 1e-3,
        "{}",
        length_m(&path)
    );
    assert_eq!(
        (path.points_m[0], *path.points_m.last().unwrap()),
        ([0.0, 0.0], [1.5, 0.7])
    );
    assert!((path.cost_m - length_m(&path)).abs() < 1e-6);
    assert!(path.unknown.iter().all(|&unknown| !unknown));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]
    #[test]
    fn the_path_keeps_clear_of_obstacles(boxes in prop::collection::vec((-1.8..1.8f64, -1.8..1.8f64, 0.09..0.4f64), 0..14)) {
        let mut view = floor();
        for (x, y, size) in boxes {
            // A robot that starts too near to something leaves it first: that has a test of its own.
            let nearest = |low: f64| 0.0_f64.clamp(low, low + size);
            if geometry::hypot(nearest(x), nearest(y)) > 0.3 {
                paint(&mut view, [x, y], [x + size, y + size], Surface::Obstacle(0.3));
            }
        }
        let mut planner = planner();
        let Ok(path) = plan(&mut planner, &view, START, &goal(1.6, 1.2)).way else { return Ok(()) };
        prop_assert_eq!(path.points_m.len(), path.unknown.len());
        prop_assert_eq!(path.points_m.len(), path.clearance_m.len());
        for (pair, clearance) in path.points_m.windows(2).zip(&path.clearance_m) {
            let gap = geometry::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]);
            prop_assert!(gap <= CELL * 1.4143);
            // Clearance is that of the cell's centre.
            prop_assert!(*clearance >= planner.needed_m());
            prop_assert!(to_obstacle_m(&view, pair[0]) >= planner.needed_m() - 0.7072 * CELL);
        }
        let end = path.points_m.last().unwrap();
        prop_assert!(geometry::hypot(end[0] - 1.6, end[1] - 1.2) <= 0.15 + 1e-9);
    }
}

#[test]
fn a_goal_beyond_the_window_is_aimed_for_by_the_border() {
    let mut planner = planner();
    let far = goal(5.0, 0.0);
    let path = way(&mut planner, &floor(), START, &far);
    let end = path.points_m.last().unwrap();
    assert!(end[0] > 1.95 && end[1].abs() < 0.1, "{end:?}");
    // Still far from the border: kept. Near to it: planned anew.
    assert!(!plan(&mut planner, &floor(), PlanarPose::new(0.3, 0.0, 0.0), &far).replanned);
    assert!(
        plan(&mut planner, &floor(), PlanarPose::new(0.6, 0.0, 0.0), &far)
            .way
            .is_ok()
    );
}

#[test]
fn it_replans_only_when_the_path_is_broken_or_left_or_the_goal_changed() {
    let mut planner = planner();
    let mut view = floor();
    let to = goal(1.5, 0.0);
    assert!(plan(&mut planner, &view, START, &to).replanned);
    let on_path = PlanarPose::new(0.3, 0.02, 0.0);
    let kept = plan(&mut planner, &view, on_path, &to);
    assert!(!kept.replanned);
    let rest = kept.way.unwrap();
    assert!(
        (rest.points_m[0][0] - 0.3).abs() < 1e-9,
        "the passed part is cut off"
    );
    assert!((length_m(&rest) - 1.2).abs() < 1e-6);
    paint(&mut view, [0.5, 0.5], [0.7, 0.7], Surface::Obstacle(0.3));
    assert!(
        !plan(&mut planner, &view, on_path, &to).replanned,
        "it stands beside the way"
    );
    paint(&mut view, [0.8, -0.1], [0.9, 0.1], Surface::Obstacle(0.3));
    let around = plan(&mut planner, &view, on_path, &to);
    assert!(around.replanned && around.way.is_ok());
    assert!(!plan(&mut planner, &view, on_path, &to).replanned);
    assert!(
        plan(&mut planner, &view, PlanarPose::new(-0.5, -0.8, 0.0), &to).replanned,
        "strayed"
    );
    assert!(
        plan(
            &mut planner,
            &view,
            PlanarPose::new(-0.5, -0.8, 0.0),
            &goal(1.0, 1.0)
        )
        .replanned
    );
}

#[test]
fn a_way_that_is_much_better_is_taken_once_it_is_seen() {
    // A wall with an unknown part: the way leads around; then the part turns out to be open.
    let mut view = floor();
    paint(&mut view, [0.8, -1.2], [0.88, 2.0], Surface::Obstacle(0.5));
    paint(&mut view, [-0.4, -2.0], [2.0, -0.4], Surface::Unknown);
    let mut planner = planner();
    let first = way(&mut planner, &view, START, &goal(1.5, 0.3));
    assert!(first.unknown.iter().any(|&unknown| unknown));
    paint(&mut view, [-0.4, -2.0], [2.0, -0.4], Surface::Floor(0.0));
    paint(&mut view, [0.7, -0.4], [0.9, 1.0], Surface::Floor(0.0));
    let second = plan(&mut planner, &view, START, &goal(1.5, 0.3));
    assert!(second.replanned);
    assert!(second.way.unwrap().cost_m < 0.8 * first.cost_m);
}

#[test]
fn unknown_ground_is_walked_at_a_price_and_said() {
    let mut view = floor();
    paint(&mut view, [0.4, -0.4], [0.9, 0.4], Surface::Unknown);
    let around = way(&mut planner(), &view, START, &goal(1.4, 0.0));
    assert!(
        around.unknown.iter().all(|&unknown| !unknown),
        "a short way round is preferred"
    );
    paint(&mut view, [0.4, -2.0], [0.9, 2.0], Surface::Unknown);
    let across = way(&mut planner(), &view, START, &goal(1.4, 0.0));
    assert!(across.unknown.iter().any(|&unknown| unknown));
    assert!((across.cost_m - 1.9).abs() < 0.1, "{}", across.cost_m);
}

#[test]
fn the_robot_may_leave_a_place_too_near_to_an_obstacle() {
    let mut view = floor();
    paint(&mut view, [0.1, -0.3], [0.3, 0.3], Surface::Obstacle(0.3));
    let mut planner = planner();
    let path = way(&mut planner, &view, START, &goal(1.4, 0.0));
    for (point, &clearance) in path.points_m.iter().zip(&path.clearance_m) {
        assert!(clearance >= planner.needed_m() || geometry::hypot(point[0], point[1]) < 0.33);
        assert!(clearance > 0.06, "{point:?} {clearance}");
    }
}

#[test]
fn a_difference_that_is_floor_is_walked_over() {
    let mut view = floor();
    paint(&mut view, [0.8, -2.0], [2.0, 2.0], Surface::Floor(0.008));
    let path = way(&mut planner(), &view, START, &goal(1.5, 0.0));
    assert!((length_m(&path) - 1.5).abs() < 0.01);
    let upstairs = Goal {
        height_m: Some(0.12),
        ..goal(1.5, 0.0)
    };
    let (refusal, sentence) = refused(&view, &upstairs);
    assert_eq!(refusal, Refusal::Blocked);
    assert_eq!(
        sentence,
        "no floor within 0.15 m of the goal lies 0.12 m high"
    );
}

#[test]
fn what_is_no_number_is_refused() {
    let mut planner = planner();
    let bad = Pose::<Map, Robot>::from_yaw(f64::NAN, 0.0, 0.0, 0.0);
    let error = planner
        .plan(&floor(), &Staircase::default(), &bad, &goal(1.0, 0.0))
        .unwrap_err();
    assert_eq!(error, PlanError::NotFinite("the start"));
    let error = planner
        .plan(
            &floor(),
            &Staircase::default(),
            &Pose::identity(),
            &goal(f64::INFINITY, 0.0),
        )
        .unwrap_err();
    assert_eq!(error, PlanError::NotFinite("the goal"));
    let away = Pose::from_yaw(50.0, 0.0, 0.0, 0.0);
    let lost = planner
        .plan(&floor(), &Staircase::default(), &away, &goal(1.0, 0.0))
        .unwrap();
    assert_eq!(lost.way.unwrap_err().refusal, Refusal::NoPath);
}

/// Where a path is across a corridor from one row of obstacles to another, m from its middle, away from its ends.
fn off_middle_m(path: &Path, middle_m: f64) -> f64 {
    let inner = path
        .points_m
        .iter()
        .filter(|at| (0.6..1.2).contains(&at[0]));
    inner.map(|at| (at[1] - middle_m).abs()).fold(0.0, f64::max)
}

#[test]
fn along_the_diagram_the_way_keeps_to_the_middle_of_a_corridor() {
    let mut view = floor();
    paint(&mut view, [-0.2, 0.4], [1.4, 0.6], Surface::Obstacle(0.5));
    paint(&mut view, [-0.2, -0.9], [1.4, -0.7], Surface::Obstacle(0.5));
    let goal = goal(1.7, 0.1);
    let short = way(&mut planner(), &view, START, &goal);
    let mut planner = planner().along_voronoi(VoronoiConfig::default()).unwrap();
    let roomy = way(&mut planner, &view, START, &goal);
    assert!(off_middle_m(&short, -0.15) > 0.12);
    assert!(
        off_middle_m(&roomy, -0.15) < CELL + 1e-9,
        "{:?}",
        roomy.points_m
    );
}

proptest! {
    #[test]
    fn along_the_diagram_there_is_a_way_where_there_is_one(
        boxes in prop::collection::vec((-1.9..1.5f64, -1.9..1.5f64, 0.05..0.6f64, 0.05..0.6f64), 0..14),
    ) {
        let mut view = floor();
        for (x, y, w, h) in boxes {
            if x > 0.2 || y > 0.2 || x + w < -0.2 || y + h < -0.2 {
                paint(&mut view, [x, y], [x + w, y + h], Surface::Obstacle(0.5));
            }
        }
        let goal = goal(1.6, 1.6);
        let any = plan(&mut planner(), &view, START, &goal).way;
        let mut planner = planner().along_voronoi(VoronoiConfig::default()).unwrap();
        let roomy = plan(&mut planner, &view, START, &goal).way;
        prop_assert_eq!(any.is_ok(), roomy.is_ok());
    }
}
