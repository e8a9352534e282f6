//! How a level camera pose shows horizontal surfaces: on each of them disparity over `g` is one number.

use nalgebra::{Matrix3, Rotation3, Vector3};
use sensing::Intrinsics;

/// A function of the pixel that is linear in column and row.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Linear {
    /// Value at column 0, row 0.
    pub origin: f32,
    /// Change per column.
    pub per_col: f32,
    /// Change per row.
    pub per_row: f32,
}

impl Linear {
    /// The function `c` of `c.x * col + c.y * row + c.z`.
    pub(crate) fn new(c: &Vector3<f64>) -> Self {
        Self {
            origin: c.z as f32,
            per_col: c.x as f32,
            per_row: c.y as f32,
        }
    }

    /// The three coefficients: `(per_col, per_row, origin)`.
    pub(crate) fn coefficients(&self) -> Vector3<f64> {
        Vector3::new(self.per_col, self.per_row, self.origin).map(f64::from)
    }

    /// The function along one row.
    pub(crate) fn along(&self, row: usize) -> AlongRow {
        AlongRow {
            origin: self.origin,
            per_col: self.per_col,
            of_row: self.per_row * to_f32(row),
        }
    }

    /// The value at a pixel.
    #[inline]
    pub fn at(&self, col: usize, row: usize) -> f32 {
        self.origin + self.per_col * to_f32(col) + self.per_row * to_f32(row)
    }

    /// Whether a disparity is within `accept_px` of a plane's, where the plane is before the camera.
    #[inline]
    pub(crate) fn passes(&self, col: usize, row: usize, d: f32, accept_px: f32) -> bool {
        let there = self.at(col, row);
        there > 0.0 && (d - there).abs() < accept_px
    }
}

/// The values of a [`Linear`] function along a row: the same bits, for less.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AlongRow {
    origin: f32,
    per_col: f32,
    of_row: f32,
}

impl AlongRow {
    /// The value at a column.
    #[inline]
    pub(crate) fn at(&self, col: f32) -> f32 {
        self.origin + self.per_col * col + self.of_row
    }
}

/// What the camera's orientation says of every pixel's ray (with z = 1 along the optical axis), times focal length and
/// baseline.
///
/// A horizontal surface a height `c` below the camera shows the disparity `d = g / c`: the ray meets it at the depth
/// `c / -ray_z`, and disparity is `f B` over depth. So `q = d / g = 1 / c` is the same all over the surface.
#[derive(Debug, Clone, Copy)]
pub struct View {
    /// Forward part of the ray: `f B` times its x in the robot's axes.
    pub x: Linear,
    /// Leftward part of the ray: `f B` times its y in the robot's axes.
    pub y: Linear,
    /// Fall of the ray, `g`: `f B` times its z, downwards; positive below the horizon.
    pub g: Linear,
}

impl View {
    /// The view of a camera with this orientation in the robot's frame.
    pub fn new(camera: &Intrinsics, robot_from_camera: &Rotation3<f64>) -> Self {
        let (cx, cy) = camera.principal_point_px();
        let baseline = camera.baseline_m;
        let scale = camera.focal_px * baseline;
        let row = |axis: usize, sign: f64| {
            let m = robot_from_camera.matrix();
            Linear {
                origin: (sign
                    * (m[(axis, 2)] * scale
                        - m[(axis, 0)] * cx * baseline
                        - m[(axis, 1)] * cy * baseline)) as f32,
                per_col: (sign * m[(axis, 0)] * baseline) as f32,
                per_row: (sign * m[(axis, 1)] * baseline) as f32,
            }
        };
        Self {
            x: row(0, 1.0),
            y: row(1, 1.0),
            g: row(2, -1.0),
        }
    }

    /// Turns a plane's disparities `(per_col, per_row, origin)` into what they are made of: `(a, b, q)` with
    /// `d = a X + b Y + q g`. `(-a, -b, q)` is the plane's normal in the levelled axes, towards the camera, over its
    /// distance from the camera, 1/m; a horizontal plane has no `a`, `b`.
    pub(crate) fn parts_of_planes(&self) -> Option<Matrix3<f64>> {
        Matrix3::from_columns(&[
            self.x.coefficients(),
            self.y.coefficients(),
            self.g.coefficients(),
        ])
        .try_inverse()
    }

    /// The disparities of the plane `d = a X + b Y + q g`.
    pub(crate) fn plane(&self, abq: &Vector3<f64>) -> Linear {
        let [x, y, g] = [&self.x, &self.y, &self.g].map(Linear::coefficients);
        Linear::new(&(x * abq.x + y * abq.y + g * abq.z))
    }

    /// Fills `out` with `g` of every pixel, row by row.
    pub fn fill(&self, width: usize, out: &mut [f32]) {
        for (row, line) in out.chunks_exact_mut(width).enumerate() {
            let start = self.g.at(0, row);
            for (col, value) in line.iter_mut().enumerate() {
                *value = start + self.g.per_col * to_f32(col);
            }
        }
    }
}

/// A column or row as a number. Processors turn signed numbers of 32 bits into `f32` by the four, those of 64 bits one by one.
#[inline]
pub(crate) const fn to_f32(pixels: usize) -> f32 {
    pixels as i32 as f32
}

/// The smallest turn that makes `(a, b, 1)` point up: what a tilt `(a, b)` of the ground means for the camera.
pub(crate) fn levelling(a: f64, b: f64) -> Rotation3<f64> {
    let normal = nalgebra::Vector3::new(a, b, 1.0);
    Rotation3::rotation_between(&normal, &nalgebra::Vector3::z())
        .unwrap_or_else(Rotation3::identity)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn disparity_over_g_is_one_over_the_height_below_the_camera(
            pitch in 0.3..1.2f64, roll in -0.2..0.2f64, col in 0..88usize, row in 36..72usize, below in 0.2..0.8f64,
        ) {
            let camera = Intrinsics { width: 88, height: 72, focal_px: 101.2, baseline_m: 0.06 };
            let level = Rotation3::from_matrix_unchecked(nalgebra::Matrix3::new(
                0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0));
            let rotation = Rotation3::from_axis_angle(&nalgebra::Vector3::x_axis(), roll)
                * Rotation3::from_axis_angle(&nalgebra::Vector3::y_axis(), pitch) * level;
            let ray = rotation * nalgebra::Vector3::from(camera.ray(col, row));
            prop_assume!(ray.z < -0.1);
            let disparity = camera.disparity_px(below / -ray.z);
            let g = f64::from(View::new(&camera, &rotation).g.at(col, row));
            assert_relative_eq!(disparity / g, 1.0 / below, max_relative = 1e-4);
        }

        #[test]
        fn levelling_makes_the_normal_upright(a in -0.3..0.3f64, b in -0.3..0.3f64) {
            let up = levelling(a, b) * nalgebra::Vector3::new(a, b, 1.0).normalize();
            prop_assert!((up - nalgebra::Vector3::z()).norm() < 1e-12);
        }
    }
}
