//! Fewer triangles for the same surface: by quadrics (Garland and Heckbert 1997), as meshoptimizer has them.

use meshopt::{SimplifyOptions, VertexDataAdapter};
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::TriMesh;
use settings::{POSITIVE, above_to, settings};

use crate::mesh::{TriangleMesh, vector};
use crate::topology::{Topology, wrong_triangles};

settings! {
    /// How meshes are simplified (004, section 36.3.3).
    pub struct SimplifyConfig("navigation.mesh.simplify") {
        /// Of the triangles, the share that is kept, where the surface does not move further than `error` for that.
        keep: f64 = 0.1, "1", above_to(0.0, 1.0), "004, Fig. 36.14: by a factor of 10";
        /// How far the surface may move.
        error: f64 = 0.01, "m", POSITIVE;
    }
}

/// The mesh with fewer triangles. Corners stay where they are. What is a manifold remains one: the library does not see to that, so that
/// where it would not be one the corners around stay, and it is asked again, or else the triangles there are left out; likewise where a corner would be further from the surface than
/// was allowed, as at ragged borders.
pub fn simplified(mesh: &TriangleMesh, config: &SimplifyConfig) -> TriangleMesh {
    let wanted = (config.keep * mesh.triangles.len() as f64) as usize * 3;
    let bytes: Vec<u8> = (mesh.corners_m.as_flattened().iter())
        .flat_map(|part| part.to_ne_bytes())
        .collect();
    // A whole number of corners, each from its first byte on: never refused.
    let Ok(corners) = VertexDataAdapter::new(&bytes, size_of::<[f32; 3]>(), 0) else {
        return mesh.clone();
    };
    let mut kept = vec![false; mesh.corners_m.len()];
    let was_manifold = Topology::of(mesh).is_manifold();
    loop {
        let corners_left = meshopt::simplify_with_locks(
            mesh.triangles.as_flattened(),
            &corners,
            &kept,
            wanted,
            config.error as f32,
            SimplifyOptions::ErrorAbsolute,
            None,
        );
        let (triangles, _) = corners_left.as_chunks();
        let mut simple = TriangleMesh {
            corners_m: mesh.corners_m.clone(),
            triangles: triangles.to_vec(),
        };
        let wrong = if was_manifold {
            wrong_triangles(&simple)
        } else {
            Vec::new()
        };
        let more = [
            keep_around(&simple, &wrong, &mut kept),
            keep_far(&simple, config.error, &mut kept),
        ];
        if more == [false; 2] {
            drop_triangles(&mut simple, wrong);
            let _ = simple.drop_unused_corners();
            return simple;
        }
    }
}

/// Leaves out triangles that no corner helps that could be kept: rather a small hole than edges of three triangles.
fn drop_triangles(simple: &mut TriangleMesh, mut wrong: Vec<usize>) {
    while !wrong.is_empty() {
        wrong.sort_unstable();
        let mut at = 0..;
        let mut is_wrong = || {
            at.next()
                .is_some_and(|index| wrong.binary_search(&index).is_ok())
        };
        simple.triangles.retain(|_| !is_wrong());
        wrong = wrong_triangles(simple);
    }
}

/// Keeps the corners around some triangles; whether there are more of them now.
fn keep_around(simple: &TriangleMesh, triangles: &[usize], kept: &mut [bool]) -> bool {
    let mut more = false;
    for &triangle in triangles {
        let places = simple.places_m(simple.triangles[triangle]);
        let (mut low, mut high) = (places[0], places[0]);
        for at in places {
            (low, high) = (low.inf(&at), high.sup(&at));
        }
        for (at_m, keep) in simple.corners_m.iter().zip(&mut *kept) {
            let at = vector(*at_m);
            if !*keep && at >= low && at <= high {
                *keep = true;
                more = true;
            }
        }
    }
    more
}

/// Keeps the corners that are further from the simple surface than this, m; whether there are more of them now.
fn keep_far(simple: &TriangleMesh, most_m: f64, kept: &mut [bool]) -> bool {
    let places = simple.corners_m.iter().map(|at| at.map(f64::from).into());
    let Ok(surface) = TriMesh::new(places.collect(), simple.triangles.clone()) else {
        return false;
    };
    let mut more = false;
    for (at_m, keep) in simple.corners_m.iter().zip(kept) {
        if !*keep {
            let off_m = surface.distance_to_local_point(at_m.map(f64::from).into(), false);
            *keep = off_m > most_m;
            more |= *keep;
        }
    }
    more
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_square_becomes_two_triangles_and_nothing_stays_nothing() {
        let side = 20;
        let corners = (0..=side).flat_map(|y| (0..=side).map(move |x| [x as f32, y as f32, 0.0]));
        let first = (0..side).flat_map(|y| (0..side).map(move |x| y * (side + 1) + x));
        let squares = first.flat_map(|at| {
            let up = at + side + 1;
            [[at, at + 1, up], [at + 1, up + 1, up]]
        });
        let mesh = TriangleMesh {
            corners_m: corners.collect(),
            triangles: squares.collect(),
        };
        let config = SimplifyConfig {
            keep: 0.001,
            ..SimplifyConfig::default()
        };
        let simple = simplified(&mesh, &config);
        assert_eq!((simple.triangles.len(), simple.corners_m.len()), (2, 4));
        let nothing = TriangleMesh::default();
        assert_eq!(simplified(&nothing, &config), nothing);
    }
}
