//! A depth image with the camera's pose: what the segmenter reads.

use geometry::{Camera, Pose, Robot};

use crate::{Frame, Intrinsics};

/// Why a depth image gives no scan.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ScanError {
    /// Not the camera's size.
    #[error("a depth image must have {expected} pixels, got {found}")]
    WrongSize {
        /// Pixels of the camera.
        expected: usize,
        /// Pixels of the image.
        found: usize,
    },
}

/// A depth image as disparities, with where the joints say that the camera was. Reused from frame to frame.
#[derive(Debug, Clone)]
pub struct Scan {
    /// When the picture was taken, nanoseconds since the start.
    pub exposure_ns: u64,
    /// The camera.
    pub camera: Intrinsics,
    /// Camera in the robot's frame by the measured joints and the estimated attitude; wrong by the encoders' offsets.
    pub robot_from_camera: Pose<Robot, Camera>,
    /// Disparity of each pixel, row by row; NaN where nothing was seen or the robot saw itself.
    pub disparity_px: Vec<f32>,
    /// Number of pixels with a disparity.
    pub valid: usize,
}

impl Scan {
    /// An empty scan for this camera.
    pub fn new(camera: Intrinsics) -> Self {
        Self {
            exposure_ns: 0,
            camera,
            robot_from_camera: Pose::identity(),
            disparity_px: vec![f32::NAN; camera.width * camera.height],
            valid: 0,
        }
    }

    /// Reads a depth image. Depths that are not positive and finite count as not seen. Allocates nothing.
    pub fn read(
        &mut self,
        frame: &Frame,
        robot_from_camera: Pose<Robot, Camera>,
    ) -> Result<(), ScanError> {
        self.read_depths(frame.depth_m.iter().copied(), robot_from_camera)?;
        self.exposure_ns = frame.exposure_ns;
        Ok(())
    }

    /// The same from the depths alone, metres, row by row.
    pub fn read_depths(
        &mut self,
        depths_m: impl ExactSizeIterator<Item = f32>,
        robot_from_camera: Pose<Robot, Camera>,
    ) -> Result<(), ScanError> {
        if depths_m.len() != self.disparity_px.len() {
            return Err(ScanError::WrongSize {
                expected: self.disparity_px.len(),
                found: depths_m.len(),
            });
        }
        self.robot_from_camera = robot_from_camera;
        self.valid = 0;
        let scale = (self.camera.focal_px * self.camera.baseline_m) as f32;
        for (disparity, depth) in self.disparity_px.iter_mut().zip(depths_m) {
            let seen = depth.is_finite() && depth > 0.0;
            *disparity = if seen { scale / depth } else { f32::NAN };
            self.valid += usize::from(seen);
        }
        Ok(())
    }
}
