//! A tenth of the triangles is the same surface within two centimetres (004, Fig. 36.14; H41).

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::fused::fused;
use common::{Scene, SplitMix64};
use meshes::{SimplifyConfig, Topology, TriangleMesh, simplified};
use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::TriMesh;

/// The furthest that a point of one mesh is from another, m, of its corners and of points on its triangles, a few each.
fn furthest_m(from: &TriangleMesh, to: &TriangleMesh, luck: &mut SplitMix64) -> f64 {
    let corners = to.corners_m.iter();
    let corners = corners.map(|at| Vector::new(at[0].into(), at[1].into(), at[2].into()));
    let there = TriMesh::new(corners.collect(), to.triangles.clone()).unwrap();
    let mut furthest = 0.0_f64;
    for &triangle in &from.triangles {
        let [a, b, c] = from.places_m(triangle);
        let count = 1 + (from.area_vector_m2(triangle).norm() / 4e-4) as usize;
        for _ in 0..count {
            let (u, v) = (luck.uniform(), luck.uniform());
            let (u, v) = if u + v > 1.0 {
                (1.0 - u, 1.0 - v)
            } else {
                (u, v)
            };
            let at = a + (b - a) * u + (c - a) * v;
            let off = there.distance_to_local_point(Vector::new(at.x, at.y, at.z), false);
            furthest = furthest.max(off);
        }
    }
    furthest
}

#[test]
fn a_tenth_of_the_triangles_is_the_same_surface_within_two_centimetres() {
    for seed in 0..2 {
        let mesh = fused(&Scene::boxes(), seed);
        let simple = simplified(&mesh, &SimplifyConfig::default());
        let share = simple.triangles.len() as f64 / mesh.triangles.len() as f64;
        assert!(share <= 0.1, "{share}");
        let topology = Topology::of(&simple);
        assert!(topology.is_manifold(), "{topology:?}");
        let mut luck = SplitMix64::new(seed);
        let there_m = furthest_m(&simple, &mesh, &mut luck);
        let back_m = furthest_m(&mesh, &simple, &mut luck);
        assert!(there_m.max(back_m) <= 0.02, "{there_m} m, {back_m} m");
    }
}
