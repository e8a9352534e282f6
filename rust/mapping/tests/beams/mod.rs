//! Trees and frames of beams for the tests of the octree.

#![expect(clippy::unwrap_used, reason = "a helper of tests panics, too")]

use proptest::prelude::*;
use volume::Ray;
use volume::octree::{Octree, OctreeConfig};

pub(crate) const RESOLUTION: f64 = 0.1;
/// Voxels along each axis of all that a tree holds, and the one at the origin.
pub(crate) const SPAN: i32 = 65_536;
pub(crate) const CENTRE: f64 = 32_768.0;

pub(crate) fn tree() -> Octree {
    Octree::new(OctreeConfig {
        resolution: RESOLUTION,
        ..OctreeConfig::default()
    })
    .unwrap()
}

pub(crate) fn in_voxels(at_m: [f64; 3]) -> [f64; 3] {
    at_m.map(|at| at * (1.0 / RESOLUTION) + CENTRE)
}

/// Points around, at most so many metres away: by one axis further than the marks of one frame reach at a time.
pub(crate) fn point(reach: f64) -> impl Strategy<Value = [f64; 3]> {
    let axis = move || -reach..reach;
    (axis(), axis(), axis()).prop_map(|(x, y, z)| [x, y, z])
}

pub(crate) fn frames(reach: f64) -> impl Strategy<Value = Vec<([f64; 3], Vec<Ray>)>> {
    let ray = (point(reach), any::<bool>()).prop_map(|(end_m, hit)| Ray { end_m, hit });
    proptest::collection::vec((point(2.0), proptest::collection::vec(ray, 0..40)), 1..6)
}
