//! A door that was seen open, then shut, then not at all.

use super::*;

const DOOR_M: [f64; 2] = [0.5, 0.02];
const BELIEVED_S: f64 = 20.0;

/// A view all of whose cells are floor that was seen so often, but for the door's.
fn view(door: Surface, sightings: u16) -> FloorView {
    let lattice = Lattice {
        origin_m: [-2.0, -2.0],
        cell_m: 0.04,
    };
    let cells = Grid::filled(100, 100, Surface::Floor(0.0));
    let mut view = FloorView::new(lattice, cells, sightings);
    let cell = lattice.cell_at(DOOR_M[0], DOOR_M[1]);
    view.set(cell, door, sightings);
    view
}

/// A frame of that time, s, with points of these heights at the door, m.
fn frame(time_s: f64, heights_m: &[f32]) -> Planes {
    let [x, y] = DOOR_M.map(|at| at as f32);
    let points = heights_m.iter().map(|&z| [x, y, z]).collect();
    Planes {
        exposure_ns: (time_s * 1e9) as u64,
        ..Planes::of_points(points, Pose::identity())
    }
}

fn places() -> ChangingPlaces {
    let config = ChangingConfig {
        believed: BELIEVED_S,
        ..ChangingConfig::default()
    };
    ChangingPlaces::new(config, 0.6)
}

/// What is shown at the door where the model has this.
fn shown(places: &ChangingPlaces, model: &FloorView) -> (Surface, HeadRoom) {
    let mut view = model.clone();
    places.show(&mut view);
    (
        view.at(DOOR_M[0], DOOR_M[1]),
        view.head_at(DOOR_M[0], DOOR_M[1]),
    )
}

const SHUT: Surface = Surface::Obstacle(0.8);

/// A door that was seen open and then shut, at 1 s.
fn shut() -> ChangingPlaces {
    let mut places = places();
    places.see(
        &view(Surface::Floor(0.0), 9),
        &frame(0.0, &[]),
        &Pose::identity(),
    );
    places.see(&view(SHUT, 9), &frame(1.0, &[0.3, 0.4]), &Pose::identity());
    places
}

/// Nothing of it is in view at that time, s.
fn away(places: &mut ChangingPlaces, time_s: f64) {
    places.see(&view(SHUT, 9), &frame(time_s, &[]), &Pose::identity());
}

#[test]
fn without_a_time_nothing_is_remembered() {
    assert!(!ChangingPlaces::new(ChangingConfig::default(), 0.6).is_on());
    assert!(places().is_on());
}

#[test]
fn what_was_seen_shut_is_believed_for_a_while_and_then_unknown() {
    let mut places = shut();
    for (time_s, expected) in [
        (1.0 + BELIEVED_S, SHUT),
        (1.2 + BELIEVED_S, Surface::Unknown),
    ] {
        away(&mut places, time_s);
        assert_eq!(shown(&places, &view(SHUT, 9)).0, expected);
        assert_eq!(places.doubts(&view(SHUT, 9)), expected == Surface::Unknown);
    }
}

#[test]
fn what_is_found_shut_again_is_believed_for_twice_as_long() {
    let mut places = shut();
    away(&mut places, 30.0);
    places.see(&view(SHUT, 9), &frame(31.0, &[0.3, 0.4]), &Pose::identity());
    for (time_s, expected) in [
        (31.0 + 1.9 * BELIEVED_S, SHUT),
        (31.0 + 2.1 * BELIEVED_S, Surface::Unknown),
    ] {
        away(&mut places, time_s);
        assert_eq!(shown(&places, &view(SHUT, 9)).0, expected);
    }
}

#[test]
fn what_never_was_floor_stays_blocked_for_ever() {
    let mut places = places();
    places.see(&view(SHUT, 0), &frame(0.0, &[0.3, 0.4]), &Pose::identity());
    away(&mut places, 1e4);
    assert_eq!(shown(&places, &view(SHUT, 0)).0, SHUT);
}

#[test]
fn where_the_floor_is_seen_again_only_the_room_above_it_is_not_known() {
    let mut places = shut();
    for look in 0..4u16 {
        assert_eq!(shown(&places, &view(SHUT, 9)).0, SHUT);
        let (time_s, seen) = (2.0 + 0.1 * f64::from(look), 10 + look);
        places.see(
            &view(SHUT, seen),
            &frame(time_s, &[0.0, 0.0]),
            &Pose::identity(),
        );
    }
    let found = shown(&places, &view(SHUT, 13));
    assert_eq!(found, (Surface::Floor(0.0), HeadRoom::Unseen));
    // Somebody stands there now.
    places.see(&view(SHUT, 14), &frame(3.0, &[0.3, 0.4]), &Pose::identity());
    assert_eq!(shown(&places, &view(SHUT, 14)).0, SHUT);
}

#[test]
fn what_hangs_above_the_robot_or_lies_on_the_floor_does_not_block() {
    for heights_m in [[0.7, 0.8], [0.0, 0.02]] {
        let mut places = shut();
        away(&mut places, 25.0);
        places.see(&view(SHUT, 9), &frame(26.0, &heights_m), &Pose::identity());
        assert_eq!(shown(&places, &view(SHUT, 9)).0, Surface::Unknown);
    }
}

#[test]
fn what_is_remembered_stays_where_it_is_when_the_window_moves() {
    let mut places = shut();
    let mut moved = view(SHUT, 9);
    let mut lattice = moved.lattice;
    lattice.origin_m[0] += 5.0 * lattice.cell_m;
    moved.shift(5, 0, lattice);
    places.see(&moved, &frame(30.0, &[]), &Pose::identity());
    assert_eq!(shown(&places, &moved).0, Surface::Unknown);
}

#[test]
fn what_was_seen_shut_is_doubted_with_the_next_goal_until_it_is_seen_shut_again() {
    let mut places = shut();
    places.doubt();
    away(&mut places, 2.0);
    assert_eq!(shown(&places, &view(SHUT, 9)).0, Surface::Unknown);
    places.see(&view(SHUT, 9), &frame(3.0, &[0.3, 0.4]), &Pose::identity());
    assert_eq!(shown(&places, &view(SHUT, 9)).0, SHUT);
}
