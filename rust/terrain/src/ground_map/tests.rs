//! Ground read from cells of 4 cm and edges.

use geometry::{Cell, Grid, Lattice, PlanarPose, Point};
use mapping::{FloorView, Surface};
use proptest::prelude::*;
use stairs::{Edge, Staircase, SureEdge};

use super::*;

const RISE_M: f64 = 0.055;
/// A map of 3.2 m a side with cells of 4 cm, each as high as its middle.
fn view(surface: impl Fn(f64, f64) -> Surface) -> FloorView {
    let lattice = Lattice {
        origin_m: [-1.6, -1.6],
        cell_m: 0.04,
    };
    let mut view = FloorView::new(lattice, Grid::filled(80, 80, Surface::Unknown), 9);
    for cell in view.cells.area().cells() {
        let [x_m, y_m] = lattice.center_of(cell);
        *view.cells.get_mut(cell).unwrap() = surface(x_m, y_m);
    }
    view
}

/// A robot that stands on a floor at the map's origin.
fn soles() -> [SoleOnGround; 2] {
    [0.0425, -0.0425].map(|y_m| SoleOnGround {
        pose: PlanarPose::new(0.0, y_m, 0.0),
        half_m: [0.0525, 0.0375],
        height_m: 0.0,
        slope: [0.0; 2],
    })
}

/// An edge across the x axis, so long and with these levels before and behind it, m.
fn edge(x_m: f64, length_m: f64, heights_m: [f64; 2]) -> SureEdge {
    let end = |y_m: f64| Point::new(x_m, y_m, heights_m[1]);
    SureEdge {
        edge: Edge {
            left: end(0.5 * length_m),
            right: end(-0.5 * length_m),
        },
        heights_m,
    }
}

fn read(view: &FloorView, edges: Vec<SureEdge>) -> HeightMap {
    let mut ground = GroundMap::new(GroundMapConfig::default(), RISE_M);
    let stairs = Staircase {
        edges,
        ..Staircase::default()
    };
    let _ = ground.read(view, &stairs, [0.0; 2]);
    for sole in soles() {
        ground.stand_on(&sole);
    }
    ground.map().clone()
}

fn height_m(map: &HeightMap, x_m: f64, y_m: f64) -> Option<f32> {
    map.height_m(map.lattice.cell_at(x_m, y_m))
}

proptest! {
    #[test]
    fn edges_run_where_the_recognizer_has_them_wherever_cells_lie(first_m in 0.3..0.4f64, tread_m in 0.11..0.25f64, rise_m in 0.015..0.05f64) {
        let true_m = |x_m: f64| rise_m * ((x_m - first_m) / tread_m + 1.0).floor().clamp(0.0, 3.0);
        let view = view(|x_m, _| Surface::Floor(true_m(x_m) as f32));
        let edges = (0..3).map(|step| {
            let heights_m = [step, step + 1].map(|step| rise_m * f64::from(step));
            edge(first_m + f64::from(step) * tread_m, 1.2, heights_m)
        });
        let map = read(&view, edges.collect());
        let cell_m = map.lattice.cell_m;
        for col in 0..map.heights_m().cols() as i32 {
            let [x_m, _] = map.lattice.center_of(Cell::new(col, 0));
            let at_edge = (0..3).any(|step| (x_m - first_m - f64::from(step) * tread_m).abs() < cell_m);
            if (-0.5..1.2).contains(&x_m) && !at_edge {
                let got_m = height_m(&map, x_m, 0.1);
                prop_assert!(got_m.is_some_and(|got_m| (f64::from(got_m) - true_m(x_m)).abs() < 1e-3), "{x_m}: {got_m:?} not {}", true_m(x_m));
            }
        }
    }
}

#[test]
fn where_a_level_ends_is_not_known_without_an_edge() {
    for rise_m in [0.04, 0.12] {
        let view = view(|x_m, _| Surface::Floor(if x_m > 0.41 { rise_m } else { 0.0 }));
        let map = read(&view, Vec::new());
        assert_eq!(height_m(&map, 0.39, 0.0), None);
        assert_eq!(height_m(&map, 0.43, 0.0), None);
        assert_eq!(height_m(&map, 0.3, 0.0), Some(0.0));
        assert_eq!(height_m(&map, 0.6, 0.0), Some(rise_m));
    }
}

#[test]
fn at_the_side_of_a_stair_nothing_is_known() {
    // Its front is at x = 0.4 m and was fitted, its side at y = 0.18 m, inside a row of cells, was not.
    let view = view(|x_m, y_m| Surface::Floor(if x_m > 0.4 && y_m < 0.18 { 0.03 } else { 0.0 }));
    let map = read(&view, vec![edge(0.4, 0.36, [0.0, 0.03])]);
    for x_m in [0.5, 0.6] {
        assert_eq!(height_m(&map, x_m, 0.0), Some(0.03), "{x_m}");
        assert_eq!(height_m(&map, x_m, 0.17), None, "{x_m}");
        assert_eq!(height_m(&map, x_m, 0.26), Some(0.0), "{x_m}");
    }
    assert_eq!(height_m(&map, 0.36, 0.1), Some(0.0));
}

#[test]
fn a_tread_has_no_holes_where_cells_were_seen_a_little_off_its_edge() {
    // Cells of one column are as high as the next tread, though the edge runs a little behind them.
    let view = view(|x_m, y_m| {
        let off_m = if (0.0..0.1).contains(&y_m) { 0.04 } else { 0.0 };
        Surface::Floor(if x_m > 0.405 - off_m { 0.03 } else { 0.0 })
    });
    let map = read(&view, vec![edge(0.405, 1.2, [0.0, 0.03])]);
    for x_m in [0.3, 0.34, 0.36, 0.39] {
        assert_eq!(height_m(&map, x_m, 0.05), Some(0.0), "{x_m}");
    }
    assert_eq!(height_m(&map, 0.42, 0.05), Some(0.03));
}

#[test]
fn an_edge_whose_levels_the_map_does_not_have_is_not_believed() {
    let floor = view(|_, _| Surface::Floor(0.0));
    let map = read(&floor, vec![edge(0.5, 0.8, [0.0, 0.06])]);
    assert_eq!(height_m(&map, 0.6, 0.0), Some(0.0));
}

#[test]
fn where_only_the_fit_of_an_edge_ended_the_platform_goes_on() {
    let view = view(|x_m, _| Surface::Floor(if x_m > 0.42 { 0.18 } else { 0.0 }));
    let map = read(&view, vec![edge(0.42, 0.4, [0.0, 0.18])]);
    for y_m in [0.0, 0.21, 0.25, 0.6] {
        assert_eq!(height_m(&map, 0.48, y_m), Some(0.18), "{y_m}");
        assert_eq!(height_m(&map, 0.36, y_m), Some(0.0), "{y_m}");
    }
}

#[test]
fn what_is_missing_in_the_midst_of_a_level_or_looks_like_an_obstacle_of_one_cell_is_crossed() {
    for odd in [Surface::Unknown, Surface::Obstacle(0.3)] {
        let view = view(|x_m, y_m| {
            let here = (x_m - 0.5).abs() < 0.02 && (y_m - 0.5).abs() < 0.02;
            if here { odd } else { Surface::Floor(0.0) }
        });
        let map = read(&view, Vec::new());
        let cell = map.lattice.cell_at(0.5, 0.5);
        assert_eq!((map.height_m(cell), map.blurred_m(cell)), (None, Some(0.0)));
        assert_eq!(height_m(&map, 0.44, 0.5), Some(0.0));
    }
}

#[test]
fn what_is_missing_on_a_tread_is_as_high_as_the_side_of_the_edge_on_which_it_lies() {
    // The edge runs through the cell that was not seen.
    let view = view(|x_m, y_m| {
        let here = (x_m - 0.42).abs() < 0.02 && (y_m - 0.1).abs() < 0.02;
        let height_m = if x_m > 0.41 { 0.03 } else { 0.0 };
        if here {
            Surface::Unknown
        } else {
            Surface::Floor(height_m)
        }
    });
    let map = read(&view, vec![edge(0.41, 1.2, [0.0, 0.03])]);
    assert_eq!(height_m(&map, 0.404, 0.1), Some(0.0));
    assert_eq!(height_m(&map, 0.434, 0.1), Some(0.03));
    let untold = read(&view, Vec::new());
    assert_eq!(height_m(&untold, 0.434, 0.1), None);
}

#[test]
fn a_cell_of_floor_on_another_level_than_all_around_is_a_false_match() {
    let stray = [0.5, 0.3];
    let view = view(|x_m, y_m| {
        let here = (x_m - stray[0]).abs() < 0.03 && (y_m - stray[1]).abs() < 0.03;
        Surface::Floor(if here { 0.03 } else { 0.0 })
    });
    let map = read(&view, Vec::new());
    assert_eq!(height_m(&map, 0.5, 0.3), None);
    for [x_m, y_m] in [[0.45, 0.3], [0.56, 0.3], [0.5, 0.25], [0.5, 0.36]] {
        assert_eq!(height_m(&map, x_m, y_m), Some(0.0), "{x_m} {y_m}");
    }
}

#[test]
fn the_ground_under_a_sole_that_lies_tilted_is_tilted() {
    let rise = 0.1;
    let mut ground = GroundMap::new(GroundMapConfig::default(), RISE_M);
    for surface in [Surface::Unknown, Surface::Floor(0.0)] {
        let view = view(|x_m, _| match surface {
            Surface::Floor(_) => Surface::Floor((rise * x_m) as f32 + 0.003),
            other => other,
        });
        let _ = ground.read(&view, &Staircase::default(), [0.0; 2]);
        let [sole, _] = soles();
        ground.stand_on(&SoleOnGround {
            slope: [rise as f32, 0.0],
            ..sole
        });
        // Where the map has it, that is right, and where it has nothing, what is felt.
        let middle_m = if surface == Surface::Unknown {
            0.0
        } else {
            0.003
        };
        for x_m in [-0.045, -0.005, 0.045] {
            let got_m = f64::from(height_m(ground.map(), x_m, 0.0425).unwrap());
            assert!(
                (got_m - middle_m - rise * x_m).abs() < 1e-3,
                "{x_m}: {got_m}"
            );
        }
    }
}

#[test]
fn nobody_can_step_on_an_obstacle_and_under_the_soles_there_is_ground() {
    let view = view(|x_m, _| {
        if x_m < 0.2 {
            Surface::Unknown
        } else if (0.5..0.7).contains(&x_m) {
            Surface::Obstacle(0.04)
        } else {
            Surface::Floor(0.0)
        }
    });
    let map = read(&view, Vec::new());
    assert!(height_m(&map, 0.6, 0.0).unwrap() > RISE_M as f32);
    assert_eq!(height_m(&map, 0.03, 0.04), Some(0.0));
    assert_eq!(height_m(&map, 0.03, 0.3), None);
}
