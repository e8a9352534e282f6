//! Planes in any direction in disparity: their fit, and their record.
//!
//! In disparity a plane is linear in the pixel, `d = a x + b y + c`. With `x`, `y` the ray of the pixel `(a, b, c)` is its
//! normal in the camera's frame.

use geometry::{Outline, Plane, Point};
use nalgebra::{Isometry3, Matrix3, Point2, Point3, Unit, Vector2, Vector3};
use sensing::Intrinsics;
use settings::{SHARE, settings};

use crate::{picture::Linear, planes::PlaneRegion};

settings! {
    /// How planes in any direction are described.
    pub struct TiltedTuning("navigation.ground.tuning.tilted") {
        /// Planes whose normal rises by less than this have no outline: they are a line from above. It is the cosine of 80 degrees.
        least_rise: f64 = 0.174, "1", SHARE;
    }
}

/// Sums for the best plane through disparities.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct PlaneSums {
    moments: Matrix3<f64>,
    products: Vector3<f64>,
    squares: f64,
}

impl PlaneSums {
    /// Adds a disparity at a place: `(x, y, 1)` in rays or in columns and rows, `(X, Y, g)` of a view in noises.
    pub(crate) fn add(&mut self, place: [f64; 3], d: f64) {
        let place = Vector3::from(place);
        self.moments += place * place.transpose();
        self.products += place * d;
        self.squares += d * d;
    }

    /// Adds what others hold.
    pub(crate) fn join(&mut self, other: &Self) {
        self.moments += other.moments;
        self.products += other.products;
        self.squares += other.squares;
    }

    /// Number of disparities.
    pub(crate) fn count(&self) -> f64 {
        self.moments[(2, 2)]
    }

    /// The plane of least squares.
    pub(crate) fn plane(&self) -> Option<Vector3<f64>> {
        let plane = self.moments.try_inverse()? * self.products;
        plane.iter().all(|value| value.is_finite()).then_some(plane)
    }

    /// Root mean square distance from that plane, px.
    pub(crate) fn roughness_px(&self, plane: &Vector3<f64>) -> f64 {
        ((self.squares - self.products.dot(plane)).max(0.0) / self.count()).sqrt()
    }

    /// The best plane of this tilt.
    pub(crate) fn tilted(&self, tilt: &Vector2<f64>) -> Option<Vector3<f64>> {
        let direction = Vector3::new(tilt.x, tilt.y, 1.0);
        let q = self.products.dot(&direction) / direction.dot(&(self.moments * direction));
        q.is_finite().then(|| direction * q)
    }

    /// What a plane leaves over, in squared noise of independent pixels: so many are
    /// `alike` that they tell as much as one.
    pub(crate) fn cost(&self, plane: &Vector3<f64>, alike: f64) -> f64 {
        let left = self.squares + plane.dot(&(self.moments * plane - 2.0 * self.products));
        left.max(0.0) / alike
    }

    /// What the best level surface leaves over, in squared noise of independent pixels.
    pub(crate) fn level_cost(&self, alike: f64) -> f64 {
        let explained = self.products.z * self.products.z / self.moments[(2, 2)].max(1e-9);
        (self.squares - explained).max(0.0) / alike
    }
}

/// A plane over columns and rows as one over rays.
pub(crate) fn over_rays(plane: &Linear, camera: &Intrinsics) -> Vector3<f64> {
    let (cx, cy) = camera.principal_point_px();
    let per_pixel = plane.coefficients();
    let middle = per_pixel.dot(&Vector3::new(cx, cy, 1.0));
    Vector3::new(
        per_pixel.x * camera.focal_px,
        per_pixel.y * camera.focal_px,
        middle,
    )
}

/// Makes the record of one plane out of its pixels.
pub(crate) struct TiltedRecord<'a> {
    pose: Isometry3<f64>,
    in_camera: Vector3<f64>,
    /// Focal length times baseline, m px.
    scale: f64,
    support: usize,
    sum: Vector3<f64>,
    corners: &'a mut Vec<Point2<f64>>,
}

impl<'a> TiltedRecord<'a> {
    /// No pixel yet; `in_camera` is the plane over rays, `pose` the camera's.
    pub(crate) fn new(
        camera: &Intrinsics,
        pose: Isometry3<f64>,
        in_camera: Vector3<f64>,
        corners: &'a mut Vec<Point2<f64>>,
    ) -> Self {
        corners.clear();
        Self {
            pose,
            in_camera,
            scale: camera.focal_px * camera.baseline_m,
            support: 0,
            sum: Vector3::zeros(),
            corners,
        }
    }

    /// Adds the place where a ray meets the plane; `there` is the plane's disparity on it, px.
    pub(crate) fn add(&mut self, ray: &Vector3<f64>, there: f64) {
        let point = self.pose * Point3::from(ray * (self.scale / there));
        self.support += 1;
        self.sum += point.coords;
        self.corners.push(point.xy());
    }

    /// The record; none without any pixel. It has an outline when the plane's normal rises by more than `least_rise`.
    pub(crate) fn finish(self, least_rise: f64) -> Option<PlaneRegion> {
        let normal = Unit::new_normalize(self.pose.rotation * -self.in_camera);
        let plane = Plane {
            normal,
            distance_m: normal.dot(&self.pose.translation.vector)
                - self.scale / self.in_camera.norm(),
        };
        (self.support > 0).then(|| PlaneRegion {
            support: self.support,
            mean: Point::wrap(Point3::from(self.sum / self.support as f64)),
            plane,
            boundary: (normal.z.abs() > least_rise)
                .then(|| Outline::hull(self.corners).ok())
                .flatten(),
            floor_height_m: None,
            roughness: None,
        })
    }
}
