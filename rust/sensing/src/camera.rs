//! The pinhole camera with a second eye.

use robot::CameraMount;

/// Pinhole intrinsics; pixel centres at integer coordinates, square pixels, the axis through the image's middle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Intrinsics {
    /// Width, pixels.
    pub width: usize,
    /// Height, pixels.
    pub height: usize,
    /// Focal length, pixels.
    pub focal_px: f64,
    /// Distance between the eyes, m.
    pub baseline_m: f64,
}

impl From<&CameraMount> for Intrinsics {
    fn from(mount: &CameraMount) -> Self {
        Self {
            width: mount.width,
            height: mount.height,
            focal_px: mount.focal,
            baseline_m: mount.stereo.baseline,
        }
    }
}

impl Intrinsics {
    /// The camera of an image in which `pool` x `pool` pixels, of which the sides hold whole numbers, are one.
    #[must_use]
    pub fn pooled(&self, pool: usize) -> Self {
        let pool = pool.max(1);
        Self {
            width: self.width / pool,
            height: self.height / pool,
            focal_px: self.focal_px / pool as f64,
            ..*self
        }
    }

    /// Column and row at which the optical axis meets the image, pixels.
    pub fn principal_point_px(&self) -> (f64, f64) {
        (
            (self.width as f64 - 1.0) / 2.0,
            (self.height as f64 - 1.0) / 2.0,
        )
    }

    /// Direction of a pixel in the camera's frame, with z = 1.
    pub fn ray(&self, col: usize, row: usize) -> [f64; 3] {
        let (cx, cy) = self.principal_point_px();
        [
            (col as f64 - cx) / self.focal_px,
            (row as f64 - cy) / self.focal_px,
            1.0,
        ]
    }

    /// Disparity of a depth, pixels.
    pub fn disparity_px(&self, depth_m: f64) -> f64 {
        self.focal_px * self.baseline_m / depth_m
    }
}
