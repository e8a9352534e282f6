//! How far the lines of sight of a picture go.

use nalgebra::{Isometry3, Vector3};
use sensing::PinholeCamera;

/// The ranges of a picture, to look places of the map frame up in.
#[derive(Debug, Clone)]
pub struct PictureRanges {
    camera: PinholeCamera,
    camera_from_map: Isometry3<f64>,
    /// Of each pixel, row by row, the nearest of it and those beside it, m; NaN where one of them saw nothing: near an edge a pixel does not
    /// tell where exactly the edge is.
    ranges_m: Vec<f32>,
}

impl PictureRanges {
    /// Of a picture's ranges, m, row by row, NaN where nothing was seen.
    pub fn new(camera: PinholeCamera, camera_from_map: Isometry3<f64>, ranges_m: &[f32]) -> Self {
        let [width, height] = camera.size_px;
        let mut nearest_m = vec![f32::NAN; ranges_m.len()];
        for row in 1..height.saturating_sub(1) {
            for col in 1..width.saturating_sub(1) {
                let around = (row - 1..=row + 1)
                    .flat_map(|y| ranges_m[y * width + col - 1..=y * width + col + 1].iter());
                let least = |low: f32, &one: &f32| if one.is_nan() { one } else { low.min(one) };
                // What is no number stays so: `min` would drop it.
                let found = around.fold(f32::INFINITY, |low, one| {
                    if low.is_nan() { low } else { least(low, one) }
                });
                nearest_m[row * width + col] = found;
            }
        }
        Self {
            camera,
            camera_from_map,
            ranges_m: nearest_m,
        }
    }

    /// How far a place of the map frame is from the eye, and how far the line of sight through it goes, m; none outside of the picture, and
    /// where nothing was seen.
    #[inline]
    pub fn at(&self, at_m: Vector3<f64>) -> Option<(f64, f64)> {
        let at = self.camera_from_map * nalgebra::Point3::from(at_m);
        if at.z <= 0.0 {
            return None;
        }
        let ([fx, fy], [cx, cy]) = (self.camera.focal_px, self.camera.centre_px);
        let (col, row) = (fx * at.x / at.z + cx + 0.5, fy * at.y / at.z + cy + 0.5);
        let [width, height] = self.camera.size_px;
        if !(col >= 0.0 && row >= 0.0 && col < width as f64 && row < height as f64) {
            return None;
        }
        let range_m = self.ranges_m[row as usize * width + col as usize];
        (!range_m.is_nan()).then(|| (at.coords.norm(), f64::from(range_m)))
    }

    /// Whether part of a ball may be in the picture.
    pub(super) fn may_hold(&self, middle_m: Vector3<f64>, radius_m: f64) -> bool {
        let at = self.camera_from_map * nalgebra::Point3::from(middle_m);
        let [fx, fy] = self.camera.focal_px;
        let ([width, height], [cx, cy]) = (
            self.camera.size_px.map(|px| px as f64),
            self.camera.centre_px,
        );
        let beyond = |along: f64, focal: f64, px: f64| along * focal - px * at.z;
        let off = |focal: f64, px: f64| radius_m * (focal + px);
        at.z > -radius_m
            && beyond(at.x, fx, width - cx) <= off(fx, width - cx)
            && beyond(-at.x, fx, cx + 1.0) <= off(fx, cx + 1.0)
            && beyond(at.y, fy, height - cy) <= off(fy, height - cy)
            && beyond(-at.y, fy, cy + 1.0) <= off(fy, cy + 1.0)
    }
}
