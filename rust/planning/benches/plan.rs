//! Time to plan on the map's 100x100 window: a new path, and one that is kept.

use criterion::{Criterion, criterion_group, criterion_main};
use geometry::{Grid, Lattice, Point, Pose};
use mapping::{FloorView, Surface};
use planning::{AStar, AStarConfig, Goal, Planner};
use stairs::{ClimbingConfig, Edge, Feet, Sides, Stair, Staircase};

/// A slalom of walls from one corner to the other.
fn slalom() -> FloorView {
    let mut cells = Grid::filled(100, 100, Surface::Floor(0.0));
    for cell in cells.area().cells() {
        let gap = if cell.col / 20 % 2 == 0 {
            cell.row > 75
        } else {
            cell.row < 25
        };
        if let Some(slot) = cells.get_mut(cell)
            && cell.col % 20 == 15
            && !gap
        {
            *slot = Surface::Obstacle(0.3);
        }
    }
    FloorView::new(
        Lattice {
            origin_m: [-2.0, -2.0],
            cell_m: 0.04,
        },
        cells,
        9,
    )
}

/// A wall with a door to one side.
fn doorway() -> FloorView {
    let mut view = slalom();
    for cell in view.cells.area().cells() {
        let wall = cell.col == 60 && !(20..34).contains(&cell.row);
        if let Some(slot) = view.cells.get_mut(cell) {
            *slot = if wall {
                Surface::Obstacle(0.5)
            } else {
                Surface::Floor(0.0)
            };
        }
    }
    view
}

/// Four stairs across the window, and what is seen of them.
fn stairs() -> (FloorView, Staircase) {
    let mut view = doorway();
    let mut staircase = Staircase::default();
    for i in 0..4 {
        let (front_m, height_m) = (0.6 + 0.12 * f64::from(i), 0.03 * f64::from(i + 1));
        let edge = |x_m: f64| Edge {
            left: Point::new(x_m, 1.0, height_m),
            right: Point::new(x_m, -1.0, height_m),
        };
        staircase.stairs.push(Stair {
            front: edge(front_m),
            back: edge(front_m + if i == 3 { 1.0 } else { 0.12 }),
            reference: Point::new(front_m + 0.06, 0.0, height_m),
            left_margin_m: 0.0,
            right_margin_m: 0.0,
            support: 500,
            seen_ends: Sides::default(),
            front_fit: None,
            back_fit: None,
            seen_from_m: front_m,
            steps_ago: 0,
        });
    }
    for cell in view.cells.area().cells() {
        let [x, y] = view.lattice.center_of(cell);
        let steps = ((x - 0.6) / 0.12 + 1.0).floor().clamp(0.0, 4.0);
        let surface = if y.abs() < 1.0 {
            Surface::Floor((0.03 * steps) as f32)
        } else {
            Surface::Obstacle(0.5)
        };
        if let Some(slot) = view.cells.get_mut(cell) {
            *slot = surface;
        }
    }
    (view, staircase)
}

fn plan(criterion: &mut Criterion) {
    let goal = Goal {
        x_m: 1.8,
        y_m: 1.8,
        radius_m: 0.15,
        height_m: None,
    };
    let feet = Feet {
        length_m: 0.105,
        pair_width_m: 0.16,
        stance_m: 0.085,
    };
    let Ok(fresh) = AStar::new(
        AStarConfig::default(),
        ClimbingConfig::default(),
        feet,
        0.14,
    ) else {
        return;
    };
    let corner = Pose::from_yaw(-1.8, -1.8, 0.0, 0.0);
    let middle = Pose::identity();
    let ground = Staircase::default();
    let (flight, staircase) = stairs();
    let courses = [
        ("slalom", slalom(), &ground, corner, goal),
        ("doorway", doorway(), &ground, middle, goal),
        (
            "stairs",
            flight,
            &staircase,
            middle,
            Goal {
                y_m: 0.5,
                height_m: Some(0.12),
                ..goal
            },
        ),
    ];
    for (name, view, stairs, start, goal) in courses {
        let _ = criterion.bench_function(&format!("a_star 100x100, {name}, new"), |bencher| {
            let mut planner = fresh.clone();
            let mut odd = false;
            bencher.iter(|| {
                // Another radius is another goal: nothing is kept.
                odd = !odd;
                let radius_m = if odd { 0.15 } else { 0.16 };
                planner.plan(&view, stairs, &start, &Goal { radius_m, ..goal })
            });
        });
        let _ = criterion.bench_function(&format!("a_star 100x100, {name}, kept"), |bencher| {
            let mut planner = fresh.clone();
            bencher.iter(|| planner.plan(&view, stairs, &start, &goal));
        });
    }
}

criterion_group!(benches, plan);
criterion_main!(benches);
