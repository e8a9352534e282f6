//! Many noisy pictures as one surface: a manifold as true as the sensor, with gaps where range jumps (004, Fig. 36.14; H40, H42).

mod common;

use common::fused::{fused, see, views, volume};
use common::{NOISE, Scene, SplitMix64, standing};
use meshes::{Topology, TriangleMesh, parts};
use sensing::RangeNoise;

/// Root of the mean square of how far places are from the truth, in standard deviations of a range from the nearest of the views.
fn deviations(mesh: &TriangleMesh, scene: &Scene, noise: RangeNoise) -> (f64, f64) {
    let eyes: Vec<_> = views().iter().map(|view| view.translation.vector).collect();
    let of = mesh.triangles.iter().map(|&triangle| {
        let [a, b, c] = mesh.places_m(triangle);
        let middle = (a + b + c) / 3.0;
        let ranges = eyes.iter().map(|eye| (eye - middle).norm());
        let sigma_m = noise.deviation_m(ranges.fold(f64::INFINITY, f64::min) as f32);
        let area = mesh.area_vector_m2(triangle).norm();
        (scene.distance_m(middle) / f64::from(sigma_m), area)
    });
    let (mut sum, mut areas, mut within) = (0.0, 0.0, 0.0);
    for (off, area) in of {
        sum += off * off * area;
        areas += area;
        within += if off <= 1.0 { area } else { 0.0 };
    }
    ((sum / areas).sqrt(), within / areas)
}

#[test]
fn many_noisy_pictures_are_one_manifold_as_true_as_a_single_range() {
    for seed in 0..2 {
        let scene = Scene::boxes();
        let mesh = fused(&scene, seed);
        let topology = Topology::of(&mesh);
        assert!(topology.is_manifold(), "{topology:?}");
        let (off, within) = deviations(&mesh, &scene, NOISE);
        assert!(off <= 1.0, "{off} standard deviations, seed {seed}");
        assert!(within > 0.95, "{within}");
    }
}

#[test]
fn the_fused_surface_joins_no_table_to_the_floor() {
    for (seed, height_m) in [0.3, 0.45].into_iter().enumerate() {
        let scene = Scene::table(height_m);
        let mesh = fused(&scene, seed as u64);
        assert!(Topology::of(&mesh).is_manifold());
        // What is nearer to the table, and what is nearer to the floor.
        let half_m = 0.5 * height_m;
        let (mut high, mut low) = (Vec::new(), Vec::new());
        for (triangle, part) in mesh.triangles.iter().zip(parts(&mesh)) {
            let heights = mesh.places_m(*triangle).map(|at| at.z);
            let above = heights.map(|z| z > half_m);
            assert!(above == [true; 3] || above == [false; 3], "{heights:?}");
            if above[0] { &mut high } else { &mut low }.push(part);
        }
        assert!(high.len() > 500 && low.len() > 500);
        high.sort_unstable();
        assert!(low.iter().all(|part| high.binary_search(part).is_err()));
    }
}

#[test]
fn what_is_gone_is_gone_after_some_pictures() {
    let mut volume = volume(0.02);
    let mut luck = SplitMix64::new(1);
    let view = standing([0.0, 0.0, 0.6], 0.6, 0.0);
    let box_m = |mesh: &TriangleMesh| mesh.corners_m.iter().filter(|at| at[2] > 0.06).count();
    let scene = Scene {
        blocks: vec![[[0.7, -0.1, 0.0], [0.9, 0.1, 0.15]]],
    };
    for _ in 0..10 {
        see(&mut volume, &scene, &view, &mut luck);
    }
    let before = box_m(&volume.mesh());
    assert!(before > 100, "{before}");
    for _ in 0..10 {
        see(&mut volume, &Scene::default(), &view, &mut luck);
    }
    let after = box_m(&volume.mesh());
    assert!(after * 50 < before, "{after} of {before}");
}

#[test]
fn what_is_far_away_is_forgotten_where_that_is_asked() {
    let mut volume = volume(0.02);
    let view = standing([0.0, 0.0, 0.6], 0.6, 0.0);
    see(
        &mut volume,
        &Scene::default(),
        &view,
        &mut SplitMix64::new(1),
    );
    let before = volume.blocks();
    volume.forget_beyond([0.8, 0.0, 0.0], 0.5);
    assert!(volume.blocks() > 10 && volume.blocks() < before);
    assert!(
        volume
            .mesh()
            .corners_m
            .iter()
            .all(|at| (at[0] - 0.8).abs() < 0.75)
    );
}
