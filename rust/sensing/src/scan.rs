//! A depth image with the camera's pose: what the segmenter reads.

use geometry::{Camera, Pose, Robot};
use settings::{NOT_NEGATIVE, above_to, settings};

use crate::{Frame, Intrinsics};

settings! {
    /// How a depth image becomes a scan.
    pub struct ScanConfig("navigation.scan") {
        /// Numbers of the scan that few will want to turn.
        tuning: ScanTuning;
    }
}

settings! {
    /// How the pixels of a depth image are joined that a robot's camera is told to look at as one.
    pub struct ScanTuning("navigation.scan.tuning") {
        /// How much farther than the nearest depth of a block a depth may be, as a share of it, to be of the same surface.
        one_surface: f32 = 0.04, "1", NOT_NEGATIVE;
        /// Share of a block's pixels that must be seen for the block to be.
        seen: f64 = 0.5, "1", above_to(0.0, 1.0);
    }
}

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
    /// Whether the robot stands on a slope: then no level surface is its ground, however near to its height one lies.
    pub on_slope: bool,
    /// Disparity of each pixel, row by row; NaN where nothing was seen or the robot saw itself.
    pub disparity_px: Vec<f32>,
    /// Number of pixels with a disparity.
    pub valid: usize,
    /// Pixels a side of the depth image that are one of the scan.
    pool: usize,
    tuning: ScanTuning,
}

impl Scan {
    /// An empty scan for this camera.
    pub fn new(camera: Intrinsics) -> Self {
        Self::pooled(camera, 1, ScanConfig::default())
    }

    /// An empty scan for this camera that takes `pool` x `pool` of its pixels for one.
    pub fn pooled(camera: Intrinsics, pool: usize, config: ScanConfig) -> Self {
        let camera = camera.pooled(pool);
        Self {
            exposure_ns: 0,
            pool: pool.max(1),
            camera,
            robot_from_camera: Pose::identity(),
            on_slope: false,
            disparity_px: vec![f32::NAN; camera.width * camera.height],
            valid: 0,
            tuning: config.tuning,
        }
    }

    /// Depths along the optical axis, m, row by row; NaN where nothing was seen.
    pub fn depths_m(&self) -> impl ExactSizeIterator<Item = f32> {
        let scale = (self.camera.focal_px * self.camera.baseline_m) as f32;
        self.disparity_px.iter().map(move |&px| scale / px)
    }

    /// Reads a depth image. Depths that are not positive and finite count as not seen. Allocates nothing.
    pub fn read(
        &mut self,
        frame: &Frame,
        robot_from_camera: Pose<Robot, Camera>,
    ) -> Result<(), ScanError> {
        if self.pool > 1 {
            self.read_pooled(frame, robot_from_camera)?;
        } else {
            self.read_depths(frame.depth_m.iter().copied(), robot_from_camera)?;
        }
        self.exposure_ns = frame.exposure_ns;
        Ok(())
    }

    /// Each pixel is the mean of a block's nearest surface, where enough of the block was seen.
    fn read_pooled(
        &mut self,
        frame: &Frame,
        robot_from_camera: Pose<Robot, Camera>,
    ) -> Result<(), ScanError> {
        let (pool, camera) = (self.pool, self.camera);
        let fits = [frame.width / pool, frame.height / pool] == [camera.width, camera.height];
        if !fits || frame.depth_m.len() != frame.width * frame.height {
            return Err(ScanError::WrongSize {
                expected: self.disparity_px.len() * pool * pool,
                found: frame.depth_m.len(),
            });
        }
        self.robot_from_camera = robot_from_camera;
        self.valid = 0;
        let scale = (camera.focal_px * camera.baseline_m) as f32;
        let rows = frame.depth_m.chunks_exact(frame.width * pool);
        let lines = self.disparity_px.chunks_exact_mut(camera.width);
        for (rows, line) in rows.zip(lines) {
            for (col, disparity) in line.iter_mut().enumerate() {
                *disparity = pooled_px(rows, frame.width, (col * pool, pool), scale, &self.tuning);
                self.valid += usize::from(!disparity.is_nan());
            }
        }
        Ok(())
    }

    /// Reads depths alone, metres, row by row, each for a pixel of the scan.
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

/// Disparity of a block of `pool` x `pool` depths that begins at column `left` of `rows`; NaN where too little of it was seen.
fn pooled_px(
    rows: &[f32],
    width: usize,
    (left, pool): (usize, usize),
    scale: f32,
    tuning: &ScanTuning,
) -> f32 {
    let mut nearest_m = f32::INFINITY;
    let mut seen = 0_u32;
    let block = || {
        rows.chunks_exact(width)
            .flat_map(|row| &row[left..left + pool])
    };
    for &depth_m in block() {
        if depth_m > 0.0 && depth_m.is_finite() {
            seen += 1;
            nearest_m = nearest_m.min(depth_m);
        }
    }
    if f64::from(seen) < tuning.seen * (pool * pool) as f64 {
        return f32::NAN;
    }
    let farthest_m = nearest_m * (1.0 + tuning.one_surface);
    let (mut sum_px, mut count) = (0.0, 0.0);
    for &depth_m in block() {
        if depth_m > 0.0 && depth_m <= farthest_m {
            sum_px += scale / depth_m;
            count += 1.0;
        }
    }
    sum_px / count
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const CAMERA: Intrinsics = Intrinsics {
        width: 8,
        height: 6,
        focal_px: 12.0,
        baseline_m: 0.075,
    };

    fn pooled(depth_m: Vec<f32>) -> Result<Scan, ScanError> {
        let mut scan = Scan::pooled(CAMERA, 2, ScanConfig::default());
        let frame = Frame {
            exposure_ns: 7,
            arrival_ns: 7,
            width: 8,
            height: 6,
            depth_m,
        };
        scan.read(&frame, Pose::identity()).map(|()| scan)
    }

    proptest! {
        #[test]
        fn a_plane_is_the_same_plane_to_the_pooled_camera(slope in -0.05..0.05f64, down in -0.05..0.05f64) {
            let plane = |camera: &Intrinsics, col: f64, row: f64| {
                let (cx, cy) = camera.principal_point_px();
                let [x, y] = [(col - cx) / camera.focal_px, (row - cy) / camera.focal_px];
                1.0 / (1.0 + slope * x + down * y)
            };
            let depths = (0..48).map(|i| plane(&CAMERA, f64::from(i % 8), f64::from(i / 8)) as f32);
            let scan = pooled(depths.collect()).unwrap();
            prop_assert_eq!(scan.valid, 12);
            for (i, found_px) in scan.disparity_px.iter().enumerate() {
                let depth_m = plane(&scan.camera, (i % 4) as f64, (i / 4) as f64);
                prop_assert!((f64::from(*found_px) - scan.camera.disparity_px(depth_m)).abs() < 1e-4);
            }
        }
    }

    #[test]
    fn at_a_border_the_nearer_surface_counts_and_half_a_block_has_to_be_seen() {
        let mut depths = vec![2.0; 48];
        depths[0] = 1.0;
        (depths[2], depths[3]) = (f32::NAN, 0.0);
        (depths[4], depths[5], depths[12]) = (f32::NAN, f32::INFINITY, f32::NAN);
        let scan = pooled(depths).unwrap();
        let at = |depth_m: f64| scan.camera.disparity_px(depth_m) as f32;
        assert_eq!(scan.disparity_px[..2], [at(1.0), at(2.0)]);
        assert!(scan.disparity_px[2].is_nan());
        assert_eq!((scan.valid, scan.exposure_ns), (11, 7));
    }

    #[test]
    fn an_image_of_another_size_is_refused() {
        assert!(matches!(
            pooled(vec![1.0; 47]),
            Err(ScanError::WrongSize { .. })
        ));
    }
}
