//! What is seen of the surfaces of the static map. The local map holds what the static one lacks (002, III.B); seen from afar, by a
//! robot that is wrong about its heading, a wall of the static map would stand beside itself.

use known_map::MapAround;
use nalgebra::Vector3;
use volume::Ray;
use volume::octree::ViewLayers;

use super::KnownSurfacesTuning;

/// Beams from afar that end at what stands in the static map end nowhere: the way is free until shortly before.
pub(super) fn leave_out(
    rays: &mut [Ray],
    eye_m: [f64; 3],
    (known, layers): (&MapAround, &ViewLayers),
    tuning: &KnownSurfacesTuning,
) {
    let eye_m = Vector3::from(eye_m);
    for ray in rays.iter_mut().filter(|ray| ray.hit) {
        let along = Vector3::from(ray.end_m) - eye_m;
        let range_m = along.norm();
        if range_m < tuning.near {
            continue;
        }
        let off_m = tuning.off + tuning.off_per_range * range_m;
        if known.stands_near(ray.end_m, off_m, layers) {
            *ray = Ray {
                end_m: (eye_m + along * (1.0 - off_m / range_m)).into(),
                hit: false,
            };
        }
    }
}
