//! A hall that is open behind the robot, with a row of posts across it.

use geometry::{Grid, Lattice, Pose};
use mapping::{FloorView, Surface};
use stairs::{ClimbingConfig, Feet, Staircase};

use crate::{AStar, AStarConfig, Goal, Planner};

const CELL_M: f64 = 0.04;
const RADIUS_M: f64 = 0.14;
const GOAL: Goal = Goal {
    x_m: 3.0,
    y_m: 0.0,
    radius_m: 0.15,
    height_m: None,
};

/// What is seen through a window of 4 m around this x: walls 1.4 m beside the middle from x = -0.6 to 3.6, and posts of 4 cells by 1 at
/// `posts_m` with so many free cells between them.
fn hall(around_m: f64, posts_m: f64, gap: i64) -> FloorView {
    let lattice = Lattice {
        origin_m: [(around_m / CELL_M).round() * CELL_M - 2.0, -2.0],
        cell_m: CELL_M,
    };
    let mut cells = Grid::filled(100, 100, Surface::Floor(0.0));
    for cell in cells.area().cells() {
        let [x_m, y_m] = lattice.center_of(cell);
        let row = (y_m / CELL_M).floor() as i64;
        let wall = (-0.6..3.6).contains(&x_m) && (1.36..1.44).contains(&y_m.abs());
        let post = (x_m - posts_m).abs() < 0.5 * CELL_M && y_m.abs() < 1.36;
        if (wall || post && row.rem_euclid(4 + gap) < 4)
            && let Some(slot) = cells.get_mut(cell)
        {
            *slot = Surface::Obstacle(0.5);
        }
    }
    FloorView::new(lattice, cells, 9)
}

fn planner() -> AStar {
    let feet = Feet {
        length_m: 0.105,
        pair_width_m: 0.16,
        stance_m: 0.085,
    };
    let (config, climbing) = (AStarConfig::default(), ClimbingConfig::default());
    AStar::new(config, climbing, feet, RADIUS_M).unwrap()
}

/// A planner that was in the hall and is behind it now: the posts have left the window.
fn behind(posts_m: f64, gap: i64) -> AStar {
    let mut planner = planner();
    for x_m in [
        0.0, 0.0, -1.0, -1.0, -1.0, -1.0, -1.0, -1.0, -1.0, -1.0, -1.0,
    ] {
        let view = hall(x_m, posts_m, gap);
        let start = Pose::from_yaw(x_m, 0.0, 0.0, 0.0);
        let plan = planner.plan(&view, &Staircase::default(), &start, &GOAL);
        assert!(plan.unwrap().way.is_ok());
    }
    planner
}

#[test]
fn gaps_that_are_too_narrow_at_a_single_row_of_cells_are_closed_and_wide_ones_open() {
    // Free cells of 40 mm: with 8 of them there is room for a circle of 160 mm, with 9 for one of 200; 170 are needed.
    for i in 0..12 {
        let posts_m = 1.3 + CELL_M * f64::from(i);
        let left_m = |gap| behind(posts_m, gap).outside.left_m([1.1, 0.1], &GOAL);
        assert!(left_m(9) < 2.4, "{posts_m}: {}", left_m(9));
        // Back out of the hall, along it and in again.
        assert!(left_m(8) > 7.0, "{posts_m}: {}", left_m(8));
    }
}

#[test]
fn a_wall_beyond_the_window_is_no_way_out() {
    let planner = behind(1.3, 8);
    for at_m in [[0.5, 1.36], [1.02, 1.42], [1.3, 0.0]] {
        assert!(planner.outside.left_m(at_m, &GOAL) > 10.0, "{at_m:?}");
    }
}

/// A window of floor, so many cells a side, with a post of three cells each way in its middle.
fn window(origin_m: [f64; 2], side: usize) -> FloorView {
    let mut cells = Grid::filled(side, side, Surface::Floor(0.0));
    let middle = side as i32 / 2;
    for cell in cells.area().cells() {
        let is_post = (cell.col - middle).abs() <= 1 && (cell.row - middle).abs() <= 1;
        if let Some(slot) = cells.get_mut(cell).filter(|_| is_post) {
            *slot = Surface::Obstacle(0.5);
        }
    }
    FloorView::new(
        Lattice {
            origin_m,
            cell_m: CELL_M,
        },
        cells,
        9,
    )
}

#[test]
fn what_stands_near_is_remembered_however_far_the_robot_has_come() {
    let AStar {
        mut terrain,
        mut rules,
        ..
    } = planner();
    let mut ground = super::ground::GroundOutside::default();
    let far = Goal { x_m: 100.0, ..GOAL };
    let mut moves = 0;
    for step in 0..20 {
        let x_m = 3.0 * f64::from(step);
        let stand = terrain::StandingAt {
            at_m: [x_m, 0.0],
            height_m: 0.0,
            heading_rad: 0.0,
            gradient: [0.0; 2],
        };
        let view = window([x_m - 2.0, -2.0], 100);
        let sight = terrain::Sight {
            view: &view,
            stairs: &Staircase::default(),
            stand,
            goal_m: far.height_m,
        };
        rules.read(&mut terrain, &sight);
        let near_m = crate::tuning::OutsideWindowTuning::default().near;
        moves += usize::from(ground.take_in(&terrain, stand.at_m, near_m));
        // The post of two windows ago stands in the same place.
        let lattice = ground.lattice.unwrap();
        let known = |x_m: f64| {
            let [col, row] = super::cell_at(&lattice, [x_m, 0.02])?;
            Some(ground.blocked[row * super::ground::SIDE + col])
        };
        assert_eq!(known(x_m + 0.02), Some(true), "{x_m}");
        assert!(step < 2 || known(x_m - 5.98) == Some(true), "{x_m}");
        assert_ne!(known(x_m - 0.48), Some(true), "{x_m}");
    }
    assert!((3..=8).contains(&moves), "{moves}");
}

#[test]
fn a_window_larger_than_what_is_remembered_is_planned_in() {
    let mut planner = planner();
    for shift_m in [0.0, 0.04, 0.4] {
        let view = window([-12.0 + shift_m, -12.0], 600);
        let start = Pose::from_yaw(-2.0, 0.0, 0.0, 0.0);
        let plan = planner.plan(&view, &Staircase::default(), &start, &GOAL);
        assert!(plan.unwrap().way.is_ok());
    }
}

#[test]
fn what_was_planned_and_seen_where_the_robot_was_not_is_forgotten() {
    let mut planner = behind(1.3, 8);
    assert!(planner.outside.left_m([1.1, 0.1], &GOAL) > 7.0);
    planner.forget();
    assert!(planner.followed.is_none());
    assert!(planner.outside.left_m([1.1, 0.1], &GOAL) < 2.4);
}
