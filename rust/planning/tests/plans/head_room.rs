//! Ways below what hangs, and around it.

use mapping::{FloorView, HeadRoom, Surface};
use planning::Refusal;

use super::{RADIUS, START, floor, goal, paint, planner, refused, to_obstacle_m, way};

/// Something hangs above all cells whose centre lies in the rectangle, too low for the robot.
fn hang(view: &mut FloorView, min: [f64; 2], max: [f64; 2], floor_m: f32) {
    paint(view, min, max, Surface::Obstacle(0.5));
    for cell in view.cells.area().cells() {
        let [x, y] = view.lattice.center_of(cell);
        let inside = x > min[0] && x < max[0] && y > min[1] && y < max[1];
        if let Some(slot) = view.head.get_mut(cell).filter(|_| inside) {
            *slot = HeadRoom::Low {
                floor_m,
                room_m: 0.54,
            };
        }
    }
}

#[test]
fn where_only_what_hangs_bars_the_way_it_is_too_low_and_else_blocked() {
    for floor_m in [0.0, f32::NAN] {
        let mut view = floor();
        hang(&mut view, [0.8, -2.0], [1.0, 2.0], floor_m);
        let (refusal, sentence) = refused(&view, &goal(1.5, 0.0));
        assert_eq!(refusal, Refusal::TooLow);
        assert!(
            sentence.contains("leaves 0.54 m above the floor"),
            "{sentence}"
        );
        paint(&mut view, [1.2, -2.0], [1.28, 2.0], Surface::Obstacle(0.5));
        assert_eq!(refused(&view, &goal(1.6, 0.0)).0, Refusal::Blocked);
    }
}

/// Noise leaves the upper part of a wall alone in its cells, and nothing was ever seen behind it.
#[test]
fn what_was_never_seen_behind_is_no_way_under_what_hangs() {
    for (seen_to_m, refusal) in [(1.0, Refusal::Blocked), (1.9, Refusal::TooLow)] {
        let mut view = floor();
        paint(&mut view, [1.0, -0.6], [2.2, 0.6], Surface::Unknown);
        paint(
            &mut view,
            [1.0, -0.6],
            [seen_to_m, 0.6],
            Surface::Floor(0.0),
        );
        for side in [-0.6, 0.52] {
            paint(
                &mut view,
                [0.9, side],
                [2.2, side + 0.08],
                Surface::Obstacle(0.5),
            );
        }
        paint(&mut view, [2.12, -0.6], [2.2, 0.6], Surface::Obstacle(0.5));
        hang(&mut view, [0.9, -0.6], [1.0, 0.6], f32::NAN);
        assert_eq!(refused(&view, &goal(1.7, 0.0)).0, refusal);
    }
}

#[test]
fn around_what_hangs_leads_a_way_where_there_is_room() {
    let mut view = floor();
    hang(&mut view, [0.8, -0.6], [1.0, 0.6], 0.0);
    let path = way(&mut planner(), &view, START, &goal(1.6, 0.0));
    let least_m = path.points_m.iter().map(|&at| to_obstacle_m(&view, at));
    assert!(least_m.fold(f64::INFINITY, f64::min) >= RADIUS);
}

#[test]
fn of_two_ways_the_one_whose_room_was_seen_is_taken() {
    let mut view = floor();
    paint(&mut view, [0.7, -0.1], [0.9, 0.1], Surface::Obstacle(0.5));
    for side in [1.0, -1.0] {
        for cell in view.cells.area().cells() {
            let [x, y] = view.lattice.center_of(cell);
            if let Some(slot) = view.head.get_mut(cell) {
                let unseen = x > 0.5 && side * y > 0.0;
                *slot = if unseen {
                    HeadRoom::Unseen
                } else {
                    HeadRoom::Free
                };
            }
        }
        let path = way(&mut planner(), &view, START, &goal(1.6, 0.0));
        let beside = path.points_m.iter().find(|at| at[0] > 0.8).unwrap();
        assert!(side * beside[1] < 0.0, "{beside:?}");
    }
}
