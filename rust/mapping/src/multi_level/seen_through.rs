//! Whether a picture shows what lies behind a place: then nothing is there any more.

use geometry::{Map, Pose, Robot};
use nalgebra::{Isometry3, Point3};
use segmentation::Planes;
use sensing::Intrinsics;

/// Looks places up in a frame that is a picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SeenThrough<'a> {
    camera: Intrinsics,
    camera_from_map: Isometry3<f64>,
    eye_in_robot: [f64; 3],
    points_in_robot_m: &'a [[f32; 3]],
}

impl<'a> SeenThrough<'a> {
    /// None where the frame is no picture: what a sight line passes is not known by its pixel then.
    pub(crate) fn new(planes: &'a Planes, map_from_robot: &Pose<Map, Robot>) -> Option<Self> {
        Some(Self {
            camera: planes.camera?,
            camera_from_map: (*map_from_robot * planes.robot_from_camera).inner.inverse(),
            eye_in_robot: planes.robot_from_camera.origin().inner.coords.into(),
            points_in_robot_m: &planes.points_in_robot_m,
        })
    }

    /// How far a place of the map frame is from the eye and how much further the line of sight through it goes, both m; none outside of
    /// the picture, and where nothing was seen.
    #[inline]
    pub(crate) fn beyond_m(&self, at_m: [f64; 3]) -> Option<(f32, f32)> {
        let at = self.camera_from_map * Point3::from(at_m);
        if at.z <= 0.0 {
            return None;
        }
        let (centre_col, centre_row) = self.camera.principal_point_px();
        let col = centre_col + self.camera.focal_px * at.x / at.z + 0.5;
        let row = centre_row + self.camera.focal_px * at.y / at.z + 0.5;
        let [width, height] = [self.camera.width, self.camera.height];
        if !(col >= 0.0 && row >= 0.0 && col < width as f64 && row < height as f64) {
            return None;
        }
        let point = self.points_in_robot_m[row as usize * width + col as usize];
        let along = [0, 1, 2].map(|axis| f64::from(point[axis]) - self.eye_in_robot[axis]);
        let seen_m = geometry::hypot(geometry::hypot(along[0], along[1]), along[2]);
        let there_m = at.coords.norm();
        let beyond_m = (seen_m - there_m) as f32;
        (!beyond_m.is_nan()).then_some((there_m as f32, beyond_m))
    }
}
