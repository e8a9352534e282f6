//! How sure an edge is by many looks, and how far it may be off.

use geometry::{Point, Robot};
use nalgebra::{Isometry3, Translation3, UnitQuaternion};

use super::*;
use testkit::synthetic::Noise;

fn camera(pan_rad: f64) -> Pose<Map, Camera> {
    let turn = UnitQuaternion::from_euler_angles(0.0, pan_rad, 0.0);
    Pose::wrap(Isometry3::from_parts(
        Translation3::new(0.0, 0.0, 0.5),
        turn,
    ))
}

/// An edge across the way at 1 m, off by this, as one frame shows it.
fn fitted(off_m: f64, turn_rad: f64, aside_m: f64) -> FittedEdge {
    let (sin, cos) = turn_rad.sin_cos();
    let at = |t: f64| Point::<Robot>::new(1.0 + off_m - t * sin, aside_m + t * cos, 0.03);
    FittedEdge {
        edge: Edge {
            left: at(0.15),
            right: at(-0.15),
        },
        place_sigma_m: 0.005,
        heading_sigma_rad: 0.03,
        near_height_m: 0.0,
        far_height_m: 0.03,
    }
}

fn fuse(fits: impl Iterator<Item = (FittedEdge, f64)>) -> FusedEdge {
    let tuning = FusionTuning::default();
    let mut fused: Option<FusedEdge> = None;
    for (fit, pan_rad) in fits {
        let edge = fit.edge.transformed(&Pose::<Map, Robot>::identity());
        if let Some(fused) = &mut fused {
            fused.add(&fit, &edge, &camera(pan_rad), &tuning);
        } else {
            fused = Some(FusedEdge::new(
                &fit,
                &edge,
                [0.0, 0.03],
                &camera(pan_rad),
                &tuning,
            ));
        }
    }
    fused.unwrap()
}

#[test]
fn frames_from_one_head_pose_count_little_more_than_one() {
    let fused = fuse((0..40).map(|_| (fitted(0.004, 0.02, 0.0), 0.0)));
    assert_eq!(fused.fit.frames, 40);
    assert!(fused.fit.place_sigma_m > 0.8 * 0.005);
    let swung = fuse((0..8).map(|i| (fitted(0.004, 0.02, 0.0), 0.05 * f64::from(i))));
    assert!(swung.fit.place_sigma_m < 0.5 * 0.005);
    assert!((swung.edge.beyond_m([1.004, 0.0])).abs() < 1e-9);
    assert!((swung.edge.heading_rad() - 0.02).abs() < 1e-9);
}

#[test]
fn the_sigma_that_is_told_holds_over_many_edges() {
    let (mut places, mut headings, mut sigmas) = (0.0, 0.0, (0.0, 0.0));
    let mut noise = Noise::new(3);
    for _ in 0..200 {
        let fused = fuse((0..8).map(|i| {
            let (off_m, turn_rad) = (0.005 * noise.normal(), 0.03 * noise.normal());
            (fitted(off_m, turn_rad, 0.0), 0.05 * f64::from(i))
        }));
        places += fused.edge.beyond_m([1.0, 0.0]).powi(2) / 200.0;
        headings += fused.edge.heading_rad().powi(2) / 200.0;
        sigmas = (fused.fit.place_sigma_m, fused.fit.heading_sigma_rad);
    }
    assert!(
        places.sqrt() < 1.3 * sigmas.0 && places.sqrt() > 0.5 * sigmas.0,
        "{places} {sigmas:?}"
    );
    assert!(headings.sqrt() < 1.3 * sigmas.1 && headings.sqrt() > 0.5 * sigmas.1);
}

#[test]
fn one_wild_look_moves_the_edge_by_less_than_a_tenth_of_its_error() {
    let off_m = |i| if i == 3 { 0.05 } else { 0.0 };
    let fused = fuse((0..8).map(|i| (fitted(off_m(i), 0.0, 0.0), 0.05 * f64::from(i))));
    assert!(fused.edge.beyond_m([1.0, 0.0]).abs() < 0.005);
}

#[test]
fn looks_at_different_stretches_give_the_heading_by_their_places() {
    // Each says straight across, but those to the left lie farther back: the places tell the turn.
    let fits = (-2..=2).map(|i| {
        let aside_m = 0.4 * f64::from(i);
        (fitted(0.02 * aside_m, 0.0, aside_m), 0.2 * f64::from(i))
    });
    let heading_rad = fuse(fits).edge.heading_rad();
    assert!((-0.02..-0.012).contains(&heading_rad), "{heading_rad}");
}

#[test]
fn steps_make_what_was_seen_before_them_less_sure() {
    let mut fused = fuse((0..8).map(|i| (fitted(0.0, 0.0, 0.0), 0.05 * f64::from(i))));
    let before = fused.fit;
    for _ in 0..4 {
        fused.step(&FusionTuning::default());
    }
    assert!(fused.fit.place_sigma_m > before.place_sigma_m);
    assert!(fused.fit.heading_sigma_rad > before.heading_sigma_rad);
    assert_eq!(fused.steps_ago, 4);
}
