//! Ground of any shape, seen by a depth camera with errors in disparity.

use geometry::{Camera, Map, Pose, Robot};
use nalgebra::{Point3, Vector3};
use segmentation::Planes;
use sensing::Intrinsics;

/// Repeatable numbers.
pub struct Luck(pub u64);

impl Luck {
    /// From 0 to 1.
    pub fn share(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Of mean 0 and deviation 1, nearly normal.
    pub fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.share()).sum::<f64>() - 6.0
    }
}

/// The picture of ground `height(x, y)` from a robot at the map's origin; the error of each disparity has this deviation, pixels.
pub fn look(
    camera: Intrinsics,
    height: impl Fn(f64, f64) -> f64,
    robot_from_camera: Pose<Robot, Camera>,
    sigma_px: f64,
    luck: &mut Luck,
) -> Planes {
    let mut planes = Planes::new(camera.width * camera.height);
    planes.robot_from_camera = robot_from_camera;
    planes.camera = Some(camera);
    planes.reliable = true;
    let eye = robot_from_camera.inner.translation.vector;
    for (index, point) in planes.points_in_robot_m.iter_mut().enumerate() {
        let ray = camera.ray(index % camera.width, index / camera.width);
        let along = robot_from_camera.inner.rotation * Vector3::from(ray);
        let below = |t: f64| {
            let at = eye + along * t;
            at.z < height(at.x, at.y)
        };
        let Some(met) = (1..1000).map(|i| 0.004 * f64::from(i)).find(|&t| below(t)) else {
            continue;
        };
        let (mut above, mut under) = (met - 0.004, met);
        for _ in 0..20 {
            let middle = 0.5 * (above + under);
            *(if below(middle) {
                &mut under
            } else {
                &mut above
            }) = middle;
        }
        let disparity = camera.disparity_px(under) + sigma_px * luck.normal();
        let depth = camera.focal_px * camera.baseline_m / disparity;
        let at = Point3::from(eye + along * depth);
        *point = [at.x as f32, at.y as f32, at.z as f32];
    }
    planes
}

/// As seen from the map's origin.
pub fn here() -> Pose<Map, Robot> {
    Pose::from_yaw(0.0, 0.0, 0.0, 0.0)
}
