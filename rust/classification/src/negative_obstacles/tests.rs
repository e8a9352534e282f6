//! Claims about pictures of flat ground with and without ditches.

use core::f64::consts::PI;

use proptest::prelude::*;

use super::*;
use crate::synthetic::Noise;

/// A ditch with level edges across the way: its near edge ahead (m), width, depth, and the turn of the edge (rad).
#[derive(Debug, Clone, Copy)]
struct Ditch {
    ahead_m: f64,
    width_m: f64,
    depth_m: f64,
    turn: f64,
}

/// The basin of the scenario `basin`: 15 cm long and 30 mm deep.
fn basin(ahead_m: f64, turn: f64) -> Ditch {
    Ditch {
        ahead_m,
        width_m: 0.15,
        depth_m: 0.03,
        turn,
    }
}

/// The robot's camera (88 x 72, focal length 101.2 pixels) 0.45 m above the ground, looking down by 0.35 rad; the range's noise grows
/// with its square.
fn picture(ditch: Option<Ditch>, noise_m: f64, noise: &mut Noise) -> RangePicture {
    let eye = [0.0, 0.0, 0.45];
    let (sin, cos) = libm::sincos(0.35);
    let mut hits = Vec::new();
    for row in 0..72 {
        for col in 0..88 {
            let (right, down) = (
                (f64::from(col) - 43.5) / 101.2,
                (f64::from(row) - 35.5) / 101.2,
            );
            let ray = [cos - sin * down, -right, -sin - cos * down];
            hits.push(range(ditch, eye, ray).map(|depth_m| {
                let depth_m = depth_m + noise.normal(noise_m) * depth_m * depth_m;
                [0, 1, 2].map(|axis| eye[axis] + ray[axis] * depth_m)
            }));
        }
    }
    RangePicture {
        cols: 88,
        hits,
        eye,
    }
}

/// How far a ray goes, in lengths of `ray`; nothing is seen beyond 3 m.
fn range(ditch: Option<Ditch>, eye: Point3, ray: Point3) -> Option<f64> {
    if ray[2] >= 0.0 {
        return None;
    }
    let to_height = |height_m: f64| (height_m - eye[2]) / ray[2];
    let ground = to_height(0.0);
    let Some(ditch) = ditch else {
        return (ground < 3.0).then_some(ground);
    };
    let (sin, cos) = libm::sincos(ditch.turn);
    let across = |way: f64| cos * (ray[0] * way - ditch.ahead_m) + sin * ray[1] * way;
    let inside = across(ground);
    if !(0.0..ditch.width_m).contains(&inside) {
        return (ground < 3.0).then_some(ground);
    }
    let bottom = to_height(-ditch.depth_m);
    if across(bottom) < ditch.width_m {
        return Some(bottom);
    }
    let wall = ground + (bottom - ground) * (ditch.width_m - inside) / (across(bottom) - inside);
    Some(wall)
}

fn finder(noise_m: f64) -> NegativeObstacles {
    let config = NegativeObstaclesConfig {
        noise: noise_m,
        ..NegativeObstaclesConfig::default()
    };
    NegativeObstacles::new(config).unwrap()
}

#[test]
fn the_basin_is_flagged_a_metre_ahead_and_where_it_is_with_the_robots_own_noise() {
    let mut noise = Noise::new(1);
    let mut flagged = 0;
    for seed in 0..40 {
        let ditch = basin(noise.within(1.0, 1.2), noise.within(-0.3, 0.3));
        let found = finder(0.02).find(&picture(Some(ditch), 0.02, &mut Noise::new(seed)));
        flagged += usize::from(!found.is_empty());
        for one in &found {
            let (sin, cos) = libm::sincos(ditch.turn);
            let edge_m = cos * (one.near_m[0] - ditch.ahead_m) + sin * one.near_m[1];
            assert!(edge_m.abs() < 0.1, "seed {seed}: {one:?} of {ditch:?}");
        }
    }
    assert_eq!(flagged, 40);
}

#[test]
fn a_deeper_ditch_is_flagged_with_its_depth() {
    for seed in 0..40 {
        let ditch = Ditch {
            ahead_m: 1.0 + 0.01 * seed as f64,
            width_m: 0.3,
            depth_m: 0.1,
            turn: 0.0,
        };
        let found = finder(0.02).find(&picture(Some(ditch), 0.02, &mut Noise::new(seed)));
        assert!(!found.is_empty(), "seed {seed}");
        assert!(found.iter().all(|one| one.depth_m > 0.04), "{found:?}");
    }
}

#[test]
fn of_pictures_of_flat_ground_at_most_one_in_a_hundred_is_flagged() {
    for noise_m in [0.0, 0.01, 0.02] {
        let flagged = (0..300)
            .filter(|seed| {
                let picture = picture(None, noise_m, &mut Noise::new(1000 + seed));
                !finder(noise_m).find(&picture).is_empty()
            })
            .count();
        assert!(flagged <= 3, "noise {noise_m} m: {flagged} of 300");
    }
}

#[test]
fn a_slope_that_can_be_walked_is_no_ditch() {
    let mut picture = picture(None, 0.0, &mut Noise::new(0));
    for hit in picture.hits.iter_mut().flatten() {
        // Seen along the same ray: from 0.8 m on the ground falls by 10 %.
        let ray = [hit[0], hit[1], hit[2] - 0.45];
        let way = (0.45 - 0.08) / (-ray[2] - 0.1 * ray[0]);
        if hit[0] > 0.8 && way.is_finite() {
            *hit = [ray[0] * way, ray[1] * way, 0.45 + ray[2] * way];
        }
    }
    assert!(picture.hits.iter().flatten().any(|hit| hit[2] < -0.1));
    assert_eq!(finder(0.0).find(&picture), []);
}

#[test]
fn an_empty_picture_shows_nothing() {
    let empty = RangePicture {
        cols: 4,
        hits: vec![None; 12],
        eye: [0.0, 0.0, 1.0],
    };
    assert_eq!(finder(0.0).find(&empty), []);
    let none = RangePicture {
        cols: 0,
        hits: Vec::new(),
        ..empty
    };
    assert_eq!(finder(0.0).find(&none), []);
}

proptest! {
    #[test]
    fn without_noise_every_ditch_within_view_is_found_at_its_edge(
        ahead_m in 0.6..1.3_f64,
        depth_m in 0.02..0.3_f64,
        turn in -PI / 8.0..PI / 8.0,
    ) {
        let ditch = Ditch { ahead_m, width_m: 0.3, depth_m, turn };
        let found = finder(0.0).find(&picture(Some(ditch), 0.0, &mut Noise::new(0)));
        prop_assert!(!found.is_empty());
        for one in found {
            prop_assert!(one.depth_m <= depth_m + 1e-9);
        }
    }
}
