//! Time to plan on the map's 100x100 window: a new path, and one that is kept.

use criterion::{Criterion, criterion_group, criterion_main};
use geometry::{Grid, Lattice, Pose};
use mapping::{FloorView, Surface};
use planning::{AStar, AStarConfig, Goal, Planner};
use stairs::{ClimbingConfig, Feet, Staircase};

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
    FloorView {
        lattice: Lattice {
            origin_m: [-2.0, -2.0],
            cell_m: 0.04,
        },
        cells,
        sightings: Grid::filled(100, 100, 9),
    }
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
    for (name, view, start) in [("slalom", slalom(), corner), ("doorway", doorway(), middle)] {
        let _ = criterion.bench_function(&format!("a_star 100x100, {name}, new"), |bencher| {
            let mut planner = fresh.clone();
            let mut odd = false;
            bencher.iter(|| {
                // Another radius is another goal: nothing is kept.
                odd = !odd;
                let radius_m = if odd { 0.15 } else { 0.16 };
                planner.plan(
                    &view,
                    &Staircase::default(),
                    &start,
                    &Goal { radius_m, ..goal },
                )
            });
        });
        let _ = criterion.bench_function(&format!("a_star 100x100, {name}, kept"), |bencher| {
            let mut planner = fresh.clone();
            bencher.iter(|| planner.plan(&view, &Staircase::default(), &start, &goal));
        });
    }
}

criterion_group!(benches, plan);
criterion_main!(benches);
