//! Lines of sight on which nothing was seen. What stood there and went away leaves voxels that no beam ends behind, where the
//! next thing is further away than the camera sees. But most pixels without a depth have none for another reason.

use geometry::{Map, Pose, Robot};
use nalgebra::Vector3;
use segmentation::Planes;

use volume::Ray;

/// How far lines of sight without an end are believed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct EmptySight {
    /// So far the way is free, m.
    pub(super) range_m: f64,
    /// What is nearer may throw a shadow without being seen, m.
    pub(super) blind_m: f64,
    /// Height of the floor, on which a line of sight would have ended, m.
    pub(super) floor_m: f64,
    /// Side of a voxel, m: neighbouring lines of sight within it say the same.
    pub(super) voxel_m: f64,
    /// Rows above and below in which nothing may have been seen either, and columns beside what was.
    pub(super) beside_px: usize,
}

/// Adds the lines of sight that are free as far as is believed, of a frame that is a picture.
///
/// Left out are those that
/// - should have met the floor: something is wrong with their pixels, or in front of the camera;
/// - may lie in the shadow that a nearer thing throws where only one of a depth camera's two eyes sees: beside what is z away it
///   is at most (focal length) x (distance between the eyes) / z wide. What is out of the picture may be as near as the camera is blind;
/// - are next to something that was seen.
pub(super) fn read(
    rays: &mut Vec<Ray>,
    planes: &Planes,
    map_from_robot: &Pose<Map, Robot>,
    empty: &EmptySight,
) {
    let Some(camera) = planes.camera else {
        return;
    };
    let [width, height] = [camera.width, camera.height];
    if empty.range_m == 0.0 || width * height != planes.points_in_robot_m.len() {
        return;
    }
    let from_camera = (*map_from_robot * planes.robot_from_camera).inner;
    let eye = from_camera.translation.vector;
    let turn = from_camera.rotation.to_rotation_matrix();
    let (centre_col, centre_row) = camera.principal_point_px();
    let every = ((empty.voxel_m * camera.focal_px / empty.range_m) as usize).max(1);
    let beside_px = empty.beside_px;
    for row in (beside_px..height.saturating_sub(beside_px)).step_by(every) {
        for col in dark_pixels(planes, row, empty) {
            if !(col.is_multiple_of(every) && is_dark_beside(planes, width, [col, row], beside_px))
            {
                continue;
            }
            let across = (col as f64 - centre_col) / camera.focal_px;
            let down = (row as f64 - centre_row) / camera.focal_px;
            let along = turn * Vector3::new(across, down, 1.0).normalize();
            let end = eye + empty.range_m * along;
            if end.z > empty.floor_m {
                rays.push(Ray {
                    end_m: end.into(),
                    hit: false,
                });
            }
        }
    }
}

fn is_dark(planes: &Planes, pixel: usize) -> bool {
    planes.points_in_robot_m[pixel][0].is_nan()
}

/// Whether nothing was seen above and below a pixel.
fn is_dark_beside(planes: &Planes, width: usize, [col, row]: [usize; 2], beside_px: usize) -> bool {
    let mut rows = row - beside_px..=row + beside_px;
    rows.all(|row| is_dark(planes, row * width + col))
}

/// Columns of a row in which nothing was seen and that can lie in no shadow.
fn dark_pixels(planes: &Planes, row: usize, empty: &EmptySight) -> impl Iterator<Item = usize> {
    let EmptySight {
        blind_m, beside_px, ..
    } = *empty;
    let (width, shadow_px) = planes.camera.map_or((0, 0.0), |camera| {
        (camera.width, camera.focal_px * camera.baseline_m)
    });
    let first = row * width;
    let pose = planes.robot_from_camera.inner;
    let (eye, ahead) = (pose.translation.vector, pose.rotation * Vector3::z());
    let widest_px = move |depth_m: f64| (shadow_px / depth_m.max(blind_m)).ceil() as usize;
    // Of a pixel in which something was seen.
    let reach_px = move |col: usize| {
        let at = planes.points_in_robot_m[first + col].map(f64::from);
        beside_px + widest_px((Vector3::from(at) - eye).dot(&ahead))
    };
    let border_px = widest_px(blind_m);
    let mut next = 0;
    std::iter::from_fn(move || {
        while next < width && !is_dark(planes, first + next) {
            next += 1;
        }
        let begin = next;
        while next < width && is_dark(planes, first + next) {
            next += 1;
        }
        let before = if begin == 0 {
            border_px
        } else {
            reach_px(begin - 1)
        };
        let after = if next == width {
            border_px
        } else {
            reach_px(next)
        };
        (begin < width).then(|| begin + before..next.saturating_sub(after))
    })
    .flatten()
}
