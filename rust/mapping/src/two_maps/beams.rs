//! What a frame tells the local map: 002, sections III.A and III.B. No beam ends on the floor, but the way to it is free.

use nalgebra::Vector3;
use segmentation::Planes;

use super::BeamsTuning;
use crate::surface::LabelledFrame;
use volume::Ray;

/// What stands for the ground.
pub(super) struct BeamGround<F> {
    /// Height at which the robot stands, m.
    pub(super) level_m: f64,
    /// What rises by less is floor, m.
    pub(super) delta_m: f64,
    /// Height of the floor of the cell that is stored at an index, m, where it is known.
    pub(super) floor_at: F,
}

impl<F: Fn(usize) -> Option<f32>> BeamGround<F> {
    /// Whether a point, or the level surface that it lies on, stands out of the floor. Normals tell the points of floors; one that
    /// is higher than where the robot stands is the top of something, or another level, and solid.
    fn is_left(&self, z_m: f64, surface_m: f64, index: Option<usize>) -> bool {
        if !surface_m.is_nan() {
            return surface_m > self.level_m + self.delta_m;
        }
        let floor_m = index.and_then(|index| (self.floor_at)(index));
        z_m > floor_m.map_or(self.level_m, f64::from) + self.delta_m
    }
}

/// Adds a frame's beams. Points that nothing beside them belongs to are errors of the camera and left out, and so are beams
/// that only pass what those beside them pass.
pub(super) fn read<F>(
    rays: &mut Vec<Ray>,
    (frame, planes): (&LabelledFrame, &Planes),
    ground: &BeamGround<F>,
    (voxel_m, tuning): (f64, &BeamsTuning),
) where
    F: Fn(usize) -> Option<f32>,
{
    let eye_m = Vector3::from(frame.eye_m);
    let size = planes.camera.map(|camera| (camera.width, camera.focal_px));
    // So many beams a voxel, where they end, are enough to pass it; nearer there are more.
    let per_voxel = tuning.per_voxel;
    let is_spare = |end_m: [f64; 3], pixel: usize| {
        size.is_some_and(|(width, focal_px)| {
            let range_m = (Vector3::from(end_m) - eye_m).norm();
            let every = ((voxel_m / per_voxel * focal_px / range_m) as usize).max(1);
            !((pixel % width).is_multiple_of(every) && (pixel / width).is_multiple_of(every))
        })
    };
    for (point, index) in frame.located() {
        let (end_m, pixel) = (point.position_m, point.pixel as usize);
        let hit = point.hit && ground.is_left(end_m[2], point.floor_height_m, index);
        let told = if hit {
            is_supported(planes, pixel, tuning)
        } else {
            !is_spare(end_m, pixel)
        };
        if told {
            rays.push(Ray { end_m, hit });
        }
    }
}

/// Whether enough pixels beside one see the same surface; of what is no picture nobody can tell.
fn is_supported(planes: &Planes, pixel: usize, tuning: &BeamsTuning) -> bool {
    let Some(camera) = planes.camera else {
        return true;
    };
    let points = &planes.points_in_robot_m;
    let here = Vector3::from(points[pixel]);
    let eye = planes.robot_from_camera.inner.translation.vector;
    let reach_m = tuning.same_surface * (here - eye.map(|m| m as f32)).norm();
    let col = pixel % camera.width;
    let beside = [
        (col > 0, pixel.wrapping_sub(1)),
        (col + 1 < camera.width, pixel + 1),
        (true, pixel.wrapping_sub(camera.width)),
        (true, pixel + camera.width),
    ];
    // Not a number: nothing seen, no support.
    let near = |&&(inside, next): &&(bool, usize)| {
        let there = points.get(next).map(|&there| Vector3::from(there));
        inside && there.is_some_and(|there| (there - here).norm() <= reach_m)
    };
    beside.iter().filter(near).count() >= tuning.support
}
