//! Pictures of a few pixels, as a stranger's camera or a test may have them: little is found in them, and nothing fails.

use sensing::{Intrinsics, Scan};

use crate::finders::{
    Histogram, HistogramConfig, Hough, HoughConfig, Ransac, RansacConfig, ScanLine, ScanLine1994,
    ScanLine1994Config, ScanLineAdaptive, ScanLineAdaptiveConfig, ScanLineConfig,
};
use crate::synthetic::camera_pose;
use crate::{GroundConfig, Planes, Segmenter};

/// Largest side, pixels: up to it some blocks of the picture are narrower than what is compared in them.
const LARGEST: usize = 24;

fn camera(width: usize, height: usize) -> Intrinsics {
    Intrinsics {
        width,
        height,
        focal_px: 1.15 * width.max(height) as f64,
        baseline_m: 0.06,
    }
}

/// Each segmenter for a camera, by its name.
fn all(camera: Intrinsics) -> Vec<(&'static str, Box<dyn Segmenter>)> {
    macro_rules! new {
        ($type:ty, $config:ty) => {
            Box::new(<$type>::new(&<$config>::default(), GroundConfig::default(), camera).unwrap())
        };
    }
    vec![
        ("scan_line", new!(ScanLine, ScanLineConfig)),
        ("scan_line_1994", new!(ScanLine1994, ScanLine1994Config)),
        (
            "scan_line_adaptive",
            new!(ScanLineAdaptive, ScanLineAdaptiveConfig),
        ),
        ("hough", new!(Hough, HoughConfig)),
        ("ransac", new!(Ransac, RansacConfig)),
        ("histogram", new!(Histogram, HistogramConfig)),
    ]
}

/// Floor as seen from half a metre above it, nothing, and a wall.
fn scans(camera: Intrinsics) -> [Scan; 3] {
    let pose = camera_pose(0.0, 0.75);
    let disparity_px = |pixel: usize| {
        let ray = camera.ray(pixel % camera.width, pixel / camera.width);
        let down = (pose.inner.rotation * nalgebra::Vector3::from(ray)).z;
        (down < 0.0).then(|| camera.disparity_px(-0.5 / down) as f32)
    };
    let scan = |disparity_px: &dyn Fn(usize) -> f32| {
        let mut scan = Scan::new(camera);
        scan.robot_from_camera = pose;
        for (pixel, slot) in scan.disparity_px.iter_mut().enumerate() {
            *slot = disparity_px(pixel);
        }
        scan.valid = scan.disparity_px.iter().filter(|d| !d.is_nan()).count();
        scan
    };
    [
        scan(&|pixel| disparity_px(pixel).unwrap_or(f32::NAN)),
        scan(&|_| f32::NAN),
        scan(&|_| camera.disparity_px(1.0) as f32),
    ]
}

#[test]
fn no_picture_is_too_small_for_any() {
    for (width, height) in (1..=LARGEST).flat_map(|w| (1..=LARGEST).map(move |h| (w, h))) {
        let camera = camera(width, height);
        let scans = scans(camera);
        for (name, mut segmenter) in all(camera) {
            let mut planes = Planes::new(width * height);
            for scan in &scans {
                let done = segmenter.segment(scan, &mut planes);
                assert_eq!(done, Ok(()), "{name} {width}x{height}");
                assert_eq!(planes.labels.len(), width * height);
            }
        }
    }
}
