//! What is seen of what was told. The local map holds what the static one lacks (002, III.B); seen from afar, by a robot that is wrong
//! about its heading, a wall of the static map would stand beside itself.

use known_map::MapAround;
use nalgebra::Vector3;
use volume::Ray;
use volume::octree::ViewLayers;

/// What is nearer is taken in, whatever was told: there it matters, and there it is where it is seen, m.
const NEAR_M: f64 = 1.2;
/// How far off what is seen may lie, m: by voxels and by where the robot is,
const OFF_M: f64 = 0.04;
/// and by its heading and the camera, per metre.
const OFF_PER_M: f64 = 0.04;

/// Beams from afar that end at what stands in the static map end nowhere: the way is free until shortly before.
pub(super) fn leave_out(rays: &mut [Ray], eye_m: [f64; 3], known: &MapAround, layers: &ViewLayers) {
    let eye_m = Vector3::from(eye_m);
    for ray in rays.iter_mut().filter(|ray| ray.hit) {
        let along = Vector3::from(ray.end_m) - eye_m;
        let range_m = along.norm();
        if range_m < NEAR_M {
            continue;
        }
        let off_m = OFF_M + OFF_PER_M * range_m;
        if known.stands_near(ray.end_m, off_m, layers) {
            *ray = Ray {
                end_m: (eye_m + along * (1.0 - off_m / range_m)).into(),
                hit: false,
            };
        }
    }
}
