//! A picture of depths, as grouping takes it.

use geometry::{Camera, Map, Pose};
use nalgebra::{Point3, Vector3};

/// A picture that cannot be grouped.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PictureError {
    /// Its pixels do not fill rows.
    #[error("a picture of {cols} columns cannot have {pixels} pixels")]
    WrongSize {
        /// Columns.
        cols: usize,
        /// Pixels.
        pixels: usize,
    },
    /// A number of the camera is none.
    #[error("a camera's focal lengths and its noise must be finite and > 0")]
    BadCamera,
}

/// What a depth camera saw. In inverse depth a plane is linear in the pixel, and the errors of stereo and structured light are as large
/// near as far.
#[derive(Debug, Clone, PartialEq)]
pub struct DepthPicture {
    /// Width, pixels.
    pub cols: usize,
    /// One over the depth along the optical axis, row by row from the top, 1/m; NaN where nothing was seen.
    pub inverse_depths_per_m: Vec<f32>,
    /// Focal lengths across and down, pixels.
    pub focal_px: [f64; 2],
    /// Where the optical axis meets the picture, column and row.
    pub centre_px: [f64; 2],
    /// Standard deviation of an inverse depth, 1/m: the disparity's over focal length and baseline.
    pub sigma_per_m: f64,
    /// Where the camera is, over a floor at z = 0.
    pub map_from_camera: Pose<Map, Camera>,
}

impl DepthPicture {
    /// Refuses what cannot be grouped.
    pub(crate) fn check(&self) -> Result<(), PictureError> {
        let (cols, pixels) = (self.cols, self.inverse_depths_per_m.len());
        if cols == 0 || !pixels.is_multiple_of(cols) {
            return Err(PictureError::WrongSize { cols, pixels });
        }
        let positive = |value: &f64| value.is_finite() && *value > 0.0;
        let [across, down] = self.focal_px;
        if [across, down, self.sigma_per_m].iter().all(positive) {
            Ok(())
        } else {
            Err(PictureError::BadCamera)
        }
    }

    /// Number of rows.
    pub(crate) fn rows(&self) -> usize {
        self.inverse_depths_per_m.len() / self.cols
    }

    /// The ray of a pixel, optical frame, of depth 1.
    pub(crate) fn ray(&self, at: usize) -> Vector3<f64> {
        let (col, row) = (at % self.cols, at / self.cols);
        Vector3::new(
            (col as f64 - self.centre_px[0]) / self.focal_px[0],
            (row as f64 - self.centre_px[1]) / self.focal_px[1],
            1.0,
        )
    }

    /// Where a pixel's ray ends at this inverse depth, in the map, m.
    pub(crate) fn point(&self, at: usize, inverse_depth: f64) -> Point3<f64> {
        self.map_from_camera.inner * Point3::from(self.ray(at) / inverse_depth)
    }

    /// The pixels beside one, above, left, right and below.
    pub(crate) fn beside(&self, at: usize) -> [Option<usize>; 4] {
        let col = at % self.cols;
        let below = at + self.cols;
        [
            at.checked_sub(self.cols),
            (col > 0).then(|| at - 1),
            (col + 1 < self.cols).then_some(at + 1),
            (below < self.inverse_depths_per_m.len()).then_some(below),
        ]
    }
}
