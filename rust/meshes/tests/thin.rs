//! A thin plate has two sides, seen from above and from below.

mod common;

use common::fused::{see, volume};
use common::{Scene, SplitMix64, standing};
use meshes::Topology;

#[test]
fn a_plate_that_is_thinner_than_the_distances_reach_keeps_both_sides() {
    let scene = Scene {
        blocks: vec![[[0.6, -0.5, 0.65], [1.4, 0.5, 0.70]]],
    };
    let (mut volume, mut luck) = (volume(0.02), SplitMix64::new(5));
    for _ in 0..2 {
        for view in [
            standing([0.1, 0.0, 0.3], -0.4, 0.0),
            standing([0.1, 0.0, 1.1], 0.5, 0.0),
        ] {
            for _ in 0..3 {
                see(&mut volume, &scene, &view, &mut luck);
            }
        }
    }
    let mesh = volume.mesh();
    assert!(Topology::of(&mesh).is_manifold());
    for (height_m, up) in [(0.65, -1.0), (0.70, 1.0)] {
        let area: f64 = (mesh.triangles.iter())
            .map(|&triangle| {
                let [a, b, c] = mesh.places_m(triangle);
                let middle = (a + b + c) / 3.0;
                let here = (middle.z - height_m).abs() < 0.012 && (middle.x - 1.0).abs() < 0.25;
                let inner = here && middle.y.abs() < 0.3;
                if inner {
                    up * mesh.area_vector_m2(triangle).z
                } else {
                    0.0
                }
            })
            .sum();
        assert!(
            area > 0.95 * 0.3 && area < 1.05 * 0.3,
            "{area} m² at {height_m} m"
        );
    }
}
