//! How the points of a picture agree with one that was taken before.

use geometry::{Camera, Odometry, Pose, Robot};
use nalgebra::{Isometry3, Point3};

use super::SceneWatchConfig;
use crate::Scan;

/// A picture that others are held against.
#[derive(Debug, Clone)]
pub(super) struct EarlierPicture {
    pub(super) disparity_px: Vec<f32>,
    pub(super) odometry_from_camera: Pose<Odometry, Camera>,
    pub(super) robot_from_camera: Pose<Robot, Camera>,
    pub(super) exposure_ns: u64,
}

/// How the points of a picture agree with one before.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct PictureFit {
    pub(super) compared: usize,
    /// Nearer than what was seen there.
    pub(super) nearer: usize,
    /// Farther than what was seen there.
    pub(super) farther: usize,
    /// What stood out of the ground before, and is there.
    pub(super) kept: usize,
    /// By which share of them the floor's disparities are off: but for those that may be less, and in the middle.
    pub(super) floor_off: [f64; 2],
}

impl PictureFit {
    /// Of a picture with one before; `floor_off` is scratch. Allocates nothing once that is large enough.
    pub(super) fn of(
        scan: &Scan,
        before: &EarlierPicture,
        before_from_now: &Isometry3<f64>,
        config: &SceneWatchConfig,
        floor_off: &mut Vec<f64>,
    ) -> Self {
        let mut fit = Self::default();
        floor_off.clear();
        for point in points(scan, config.points) {
            let Some(seen) = SeenBefore::again(before, scan, before_from_now, &point) else {
                continue;
            };
            fit.compared += 1;
            let (above_m, depth_m) = (seen.point_m.z.abs(), seen.depth_m);
            let was_floor = above_m < config.floor + config.floor_noise * depth_m;
            if seen.expected_px > seen.most_px + config.differs {
                fit.nearer += 1;
            } else if seen.expected_px < seen.least_px - config.differs {
                fit.farther += 1;
            } else if !was_floor {
                fit.kept += 1;
            }
            if was_floor {
                floor_off.push(1.0 - seen.middle_px / seen.expected_px);
            }
        }
        fit.floor_off = floor_is_off(floor_off, config);
        fit
    }
}

/// By which share of it the floor's disparity is off, whichever way: but for those points that may be less, and in the middle.
fn floor_is_off(floor_off: &mut [f64], config: &SceneWatchConfig) -> [f64; 2] {
    let count = floor_off.len();
    if (count as f64) < config.shared * config.points as f64 {
        return [0.0; 2];
    }
    floor_off.sort_unstable_by(f64::total_cmp);
    let middle = floor_off[count / 2];
    let left = (config.floor_left * count as f64) as usize;
    let least = if middle > 0.0 {
        floor_off[left]
    } else {
        -floor_off[count - 1 - left]
    };
    [least, middle.abs()]
}

/// Some of a scan's points in the camera's frame, m, spread evenly.
fn points(scan: &Scan, count: usize) -> impl Iterator<Item = Point3<f64>> {
    let camera = &scan.camera;
    let apart = ((camera.width * camera.height) as f64 / count as f64).sqrt();
    let stride = (apart as usize).max(1);
    let scale = camera.focal_px * camera.baseline_m;
    (stride / 2..camera.height)
        .step_by(stride)
        .flat_map(move |row| {
            (stride / 2..camera.width)
                .step_by(stride)
                .map(move |col| (row, col))
        })
        .filter_map(move |(row, col)| {
            let disparity_px = f64::from(scan.disparity_px[row * camera.width + col]);
            let depth_m = scale / disparity_px;
            let ray = camera.ray(col, row);
            (!disparity_px.is_nan()).then(|| Point3::from(ray.map(|along| along * depth_m)))
        })
}

/// What a picture before had where a point should have been in it: disparities, px.
struct SeenBefore {
    expected_px: f64,
    /// What was there.
    middle_px: f64,
    /// How far that lay along the camera's axis.
    depth_m: f64,
    /// Where that lay in the robot's frame of then.
    point_m: Point3<f64>,
    /// The least that was there or beside it.
    least_px: f64,
    /// The most that was there or beside it.
    most_px: f64,
}

impl SeenBefore {
    /// `None` where the point was not in view, or nothing was measured there.
    fn again(
        before: &EarlierPicture,
        scan: &Scan,
        before_from_now: &Isometry3<f64>,
        point: &Point3<f64>,
    ) -> Option<Self> {
        let camera = &scan.camera;
        let then = before_from_now * point;
        let (cx, cy) = camera.principal_point_px();
        let col = (cx + camera.focal_px * then.x / then.z).round();
        let row = (cy + camera.focal_px * then.y / then.z).round();
        let inside = then.z > 0.0
            && (1.0..camera.width as f64 - 1.0).contains(&col)
            && (1.0..camera.height as f64 - 1.0).contains(&row);
        if !inside {
            return None;
        }
        let middle = row as usize * camera.width + col as usize;
        let middle_px = f64::from(before.disparity_px[middle]);
        let depth_m = camera.focal_px * camera.baseline_m / middle_px;
        let ray = camera.ray(col as usize, row as usize);
        let mut seen = Self {
            expected_px: camera.disparity_px(then.z),
            middle_px,
            depth_m,
            point_m: before.robot_from_camera.inner
                * Point3::from(ray.map(|along| along * depth_m)),
            least_px: f64::INFINITY,
            most_px: f64::NEG_INFINITY,
        };
        for line in [middle - camera.width, middle, middle + camera.width] {
            for &px in &before.disparity_px[line - 1..=line + 1] {
                seen.least_px = seen.least_px.min(f64::from(px));
                seen.most_px = seen.most_px.max(f64::from(px));
            }
        }
        (!middle_px.is_nan()).then_some(seen)
    }
}
