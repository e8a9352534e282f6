//! The elevation grid on made terrain: each claim of the handbook's section 36.3.1 (004) that it rests on.

mod common;

use common::heights::{estimates, height, here, map, root_mean_square, seen};
use common::terrain::{self, Luck};
use common::{Block, DEPTH_CAMERA, HEIGHT, WIDTH, camera, interior, look, look_through};
use geometry::{Cell, Map, Pose, Robot};
use mapping::{ElevationConfig, Surface, WorldModel};

#[test]
fn noise_free_terrain_is_right_to_a_cell_times_its_slope_over_root_twelve() {
    // H23. A plane of 0.1 and waves of 2 cm.
    let slope = 0.1;
    let planes = terrain::look(
        DEPTH_CAMERA,
        |x, _| slope * x,
        camera(0.6, 0.7, 0.0),
        0.0,
        &mut Luck(1),
    );
    let map = seen(ElevationConfig::default(), &planes, 1);
    let errors = estimates(&map).into_iter();
    let errors = errors.map(|([x, _], e)| f64::from(e.height_m) - slope * x);
    let found = root_mean_square(errors);
    assert!(found <= 0.04 * slope / 12_f64.sqrt(), "{found}");
}

#[test]
fn a_gap_is_filled_as_well_as_its_neighbours_were_measured_and_a_step_stays_where_it_is() {
    // H25. Every fourth column and every third row of the picture is lost, and a step of 60 mm runs across.
    let ground = |x: f64, _: f64| if x > 0.82 { 0.06 } else { 0.0 };
    let mut planes = terrain::look(
        common::CAMERA,
        ground,
        camera(0.6, 0.6, 0.0),
        0.0,
        &mut Luck(1),
    );
    for (index, point) in planes.points_in_robot_m.iter_mut().enumerate() {
        if !(index % WIDTH).is_multiple_of(4) || !(index / WIDTH).is_multiple_of(2) {
            *point = [f32::NAN; 3];
        }
    }
    let without = seen(
        ElevationConfig {
            fill: 0.0,
            ..ElevationConfig::default()
        },
        &planes,
        3,
    );
    let with = seen(ElevationConfig::default(), &planes, 3);
    let truth = |cell: Cell| with.view().lattice.center_of(cell);
    let (mut measured, mut filled, mut beyond) = (vec![], vec![], 0);
    for cell in with.view().cells.area().cells() {
        let Some(found) = height(with.view().cell(cell)) else {
            continue;
        };
        let [x, y] = truth(cell);
        if geometry::hypot(x, y) <= 0.2 {
            continue; // underfoot
        }
        let error = found - ground(x, y);
        let at_edge = (x - 0.82).abs() <= 0.04;
        match without.estimate(cell) {
            Some(_) if !at_edge => measured.push(error),
            None if !at_edge => filled.push(error),
            _ => {}
        }
        beyond += usize::from(!at_edge && error.abs() > 0.02);
    }
    assert!(filled.len() > 40, "{}", filled.len());
    let (of_measured, of_filled) = (
        root_mean_square(measured.into_iter()),
        root_mean_square(filled.into_iter()),
    );
    assert!(
        of_filled <= 2.0 * of_measured + 1e-4,
        "{of_filled} {of_measured}"
    );
    assert_eq!(beyond, 0);
}

#[test]
fn a_shadow_stays_unknown_and_sight_lines_bound_it_from_above() {
    // H26. A box that hides half a metre of floor, from several places.
    let mut luck = Luck(3);
    for (at, size, top) in [
        (0.7, 0.1, 0.2),
        (0.6, 0.3, 0.12),
        (0.9, 0.06, 0.3),
        (0.8, 0.2, 0.25),
    ] {
        let hidden = [Block::new([at, -0.15, 0.0], [at + size, 0.15, top], true)];
        let planes = look_through(DEPTH_CAMERA, &hidden, &here(), camera(0.6, 0.5, 0.0));
        let map = seen(ElevationConfig::default(), &planes, 5);
        let end = (at + size) * 0.6 / (0.6 - top);
        let inside = interior(
            map.view(),
            [at + size + 0.02, -0.1],
            [(end - 0.06).min(1.9), 0.1],
        );
        for cell in inside {
            assert_eq!(
                map.view().cell(cell),
                Surface::Unknown,
                "{cell:?} behind {at}"
            );
            assert!(map.bound_m(cell).unwrap() >= 0.0);
        }
    }
    // On hills the bound is never below the ground.
    let hills = |x: f64, y: f64| 0.06 * (libm::sin(7.0 * x) * libm::cos(5.0 * y + 1.0));
    let planes = terrain::look(DEPTH_CAMERA, hills, camera(0.6, 0.35, 0.0), 0.0, &mut luck);
    let map = seen(ElevationConfig::default(), &planes, 1);
    let view = map.view();
    let (mut bounded, mut unseen) = (0, 0);
    for cell in view.cells.area().cells() {
        if let Some(bound_m) = map.bound_m(cell) {
            let [x, y] = view.lattice.center_of(cell);
            assert!(
                f64::from(bound_m) >= hills(x, y) - 1e-3,
                "{bound_m} at {x} {y}"
            );
            bounded += 1;
            unseen += usize::from(map.estimate(cell).is_none());
        }
    }
    assert!(bounded > 200 && unseen > 100, "{bounded} {unseen}");
}

#[test]
fn a_steps_edge_lies_within_a_cell_and_no_cell_has_a_height_in_between() {
    // With the noise of a stereo camera, from several distances.
    for (seed, edge) in [(1, 0.51), (2, 0.6), (3, 0.73), (4, 0.88)] {
        let rise = 0.04;
        let ground = move |x: f64, _: f64| if x > edge { rise } else { 0.0 };
        let mut luck = Luck(seed);
        let mut map = map(ElevationConfig::default());
        for _ in 0..10 {
            let planes = terrain::look(
                common::CAMERA,
                ground,
                camera(0.5, 0.6, 0.0),
                0.12,
                &mut luck,
            );
            assert!(map.insert(&planes, &here()).unwrap().used);
        }
        let view = map.view();
        let (mut between, mut cells) = (0, 0);
        for cell in view.cells.area().cells() {
            let [x, y] = view.lattice.center_of(cell);
            let near = (0.35..1.1).contains(&x) && y.abs() < 0.2;
            if let Some(h) = height(view.cell(cell)).filter(|_| near) {
                let right = (h - ground(x, y)).abs() < 0.012;
                let beside = (x - edge).abs() <= view.lattice.cell_m;
                assert!(right || beside, "{h} at {x}, {y}; edge {edge}");
                cells += 1;
                between += usize::from((0.012..rise - 0.012).contains(&h));
            }
        }
        assert!(cells > 100);
        assert_eq!(between, 0, "edge {edge}");
    }
}

#[test]
fn a_box_that_is_removed_is_taken_back_where_sight_lines_pass_below_its_top_and_stays_without_clearing()
 {
    let there = [Block::new([0.7, -0.1, 0.0], [0.8, 0.1, 0.2], true)];
    for clearing in [true, false] {
        let mut map = map(ElevationConfig {
            clearing,
            ..ElevationConfig::default()
        });
        for (blocks, frames) in [(&there[..], 6), (&[][..], 12)] {
            for _ in 0..frames {
                // What lies below the box is not seen: the camera looks over it.
                let planes = look(blocks, &here(), camera(0.5, 0.15, 0.0));
                let _ = map.insert(&planes, &here()).unwrap();
            }
        }
        let inside = interior(map.view(), [0.7, -0.1], [0.8, 0.1]);
        let stale = inside
            .iter()
            .filter(|&&cell| height(map.view().cell(cell)).is_some_and(|h| h > 0.05));
        assert_eq!(stale.count() == 0, clearing);
    }
}

#[test]
fn the_underpass_of_a_bridge_is_blocked() {
    // H34, Fig. 36.11b: a deck 70 cm above the road.
    let bridge = [Block::new([0.8, -0.8, 0.7], [1.4, 0.8, 0.75], true)];
    let mut map = map(ElevationConfig::default());
    for pitch in [0.5, 0.2, -0.1, -0.3] {
        let planes = look(&bridge, &here(), camera(0.45, pitch, 0.0));
        let _ = map.insert(&planes, &here()).unwrap();
    }
    let below = interior(map.view(), [0.85, -0.2], [1.3, 0.2]);
    let blocked = below
        .iter()
        .filter(|&&cell| height(map.view().cell(cell)).is_some_and(|h| h > 0.5));
    assert!(blocked.count() * 2 > below.len());
}

#[test]
fn a_pose_that_is_no_number_changes_nothing() {
    let planes = look(&[], &here(), camera(0.5, 0.6, 0.0));
    let mut map = seen(ElevationConfig::default(), &planes, 2);
    let before = map.view().clone();
    let nowhere = Pose::<Map, Robot>::from_yaw(f64::NAN, 0.0, 0.0, 0.0);
    assert!(map.insert(&planes, &nowhere).is_err());
    assert_eq!(map.view(), &before);
    assert_eq!(planes.points_in_robot_m.len(), WIDTH * HEIGHT);
}

#[test]
fn heights_are_said_to_be_as_sure_as_they_are_and_noise_from_afar_is_no_obstacle() {
    let mut luck = Luck(5);
    let mut map = map(ElevationConfig {
        sigma_per_metre: 0.03,
        ..ElevationConfig::default()
    });
    let mut before = f32::INFINITY;
    for _ in 0..5 {
        let planes = terrain::look(
            DEPTH_CAMERA,
            |_, _| 0.0,
            camera(0.6, 0.35, 0.0),
            0.03,
            &mut luck,
        );
        assert!(map.insert(&planes, &here()).unwrap().used);
        let view = map.view();
        let cell = |x_m: f64| view.lattice.cell_at(x_m, 0.02);
        let [near, far] = [0.9, 1.7].map(|x_m| *view.sigmas_m.get(cell(x_m)).unwrap());
        assert!(
            0.0 < near && near < far && far < before,
            "{near} {far} {before}"
        );
        let estimate = map.estimate(cell(1.7)).unwrap();
        assert!((estimate.variance_m2.sqrt() - far).abs() < 1e-6);
        before = far;
        let obstacle = |cell: Cell| matches!(view.cell(cell), Surface::Obstacle(_));
        let obstacles = view.cells.area().cells().filter(|&cell| obstacle(cell));
        assert_eq!(obstacles.count(), 0);
    }
}
