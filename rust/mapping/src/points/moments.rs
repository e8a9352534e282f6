//! Mean and covariance of points, kept without the points.

use nalgebra::{Matrix3, Vector3};

/// Weighted mean and covariance of some points. Those of two sets together follow from those of each, exactly, so that it does not matter in
/// which order points come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moments {
    /// Sum of the points' inverse variances, 1/m².
    pub weight: f32,
    /// Points.
    pub count: u32,
    /// Their mean, m.
    pub mean_m: [f32; 3],
    /// Their covariance, m²: xx, yy, zz, xy, xz, yz.
    pub covariance_m2: [f32; 6],
}

/// Standard deviations along the principal axes and across the surface that comes nearest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// The largest first, m.
    pub sigmas_m: [f32; 3],
    /// Along the least, of length 1, upwards.
    pub normal: [f32; 3],
}

impl Moments {
    /// No points.
    pub const NONE: Self = Self {
        weight: 0.0,
        count: 0,
        mean_m: [0.0; 3],
        covariance_m2: [0.0; 6],
    };

    /// One point, m, of which a coordinate is as sure as a variance, m², says.
    pub fn of(point_m: [f32; 3], variance_m2: f32) -> Self {
        Self {
            weight: 1.0 / variance_m2,
            count: 1,
            mean_m: point_m,
            covariance_m2: [0.0; 6],
        }
    }

    /// Those of both sets of points together: 004, equations 36.17 and 36.18, in three dimensions, and the covariance beside it.
    #[must_use]
    pub fn with(&self, other: &Self) -> Self {
        let weight = self.weight + other.weight;
        if weight <= 0.0 {
            return *self;
        }
        let gain = other.weight / weight;
        let [x, y, z] = [0, 1, 2].map(|axis| other.mean_m[axis] - self.mean_m[axis]);
        let apart = [x * x, y * y, z * z, x * y, x * z, y * z];
        let between = gain * (1.0 - gain);
        Self {
            weight,
            count: self.count.saturating_add(other.count),
            mean_m: [0, 1, 2]
                .map(|axis| self.mean_m[axis] + gain * (other.mean_m[axis] - self.mean_m[axis])),
            covariance_m2: std::array::from_fn(|at| {
                let own = self.covariance_m2[at];
                own + gain * (other.covariance_m2[at] - own) + between * apart[at]
            }),
        }
    }

    /// Moments of the points when all are moved by so much, m.
    #[must_use]
    pub fn moved(&self, by_m: [f32; 3]) -> Self {
        Self {
            mean_m: [0, 1, 2].map(|axis| self.mean_m[axis] + by_m[axis]),
            ..*self
        }
    }

    /// Variance of one of the points by the sensor, m²: their harmonic mean.
    pub fn noise_m2(&self) -> f32 {
        self.count as f32 / self.weight
    }

    /// How the points are spread.
    pub fn shape(&self) -> Shape {
        let [xx, yy, zz, xy, xz, yz] = self.covariance_m2.map(f64::from);
        let eigen = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz).symmetric_eigen();
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        let normal: Vector3<f64> = eigen.eigenvectors.column(order[2]).into_owned();
        let upwards = if normal.z < 0.0 { -normal } else { normal };
        Shape {
            sigmas_m: order.map(|axis| eigen.eigenvalues[axis].max(0.0).sqrt() as f32),
            normal: [0, 1, 2].map(|axis| upwards[axis] as f32),
        }
    }

    /// From 0, spread over a surface or along a line, to 1, spread alike in all directions: Lalonde et al. 2006, section 3, by standard deviations.
    pub fn scatter(&self) -> f32 {
        let [a, _, c] = self.shape().sigmas_m;
        if a > 0.0 { c / a } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn points() -> impl Strategy<Value = Vec<([f32; 3], f32)>> {
        prop::collection::vec((prop::array::uniform3(-0.3..0.3f32), 1e-4..1e-2f32), 1..40)
    }

    fn fused(points: &[([f32; 3], f32)]) -> Moments {
        let each = points
            .iter()
            .map(|&(at, variance)| Moments::of(at, variance));
        each.fold(Moments::NONE, |all, one| all.with(&one))
    }

    proptest! {
        #[test]
        fn moments_of_parts_are_those_of_the_whole(points in points(), cut in 0.0..1.0f64) {
            let cut = (points.len() as f64 * cut) as usize;
            let (whole, a, b) = (fused(&points), fused(&points[..cut]), fused(&points[cut..]));
            for parts in [a.with(&b), b.with(&a)] {
                prop_assert_eq!(parts.count, whole.count);
                prop_assert!((parts.weight / whole.weight - 1.0).abs() < 1e-4);
                for axis in 0..3 {
                    prop_assert!((parts.mean_m[axis] - whole.mean_m[axis]).abs() < 1e-5);
                }
                for at in 0..6 {
                    prop_assert!((parts.covariance_m2[at] - whole.covariance_m2[at]).abs() < 1e-6);
                }
            }
        }

        #[test]
        fn they_are_the_weighted_mean_and_covariance(points in points()) {
            let total: f64 = points.iter().map(|(_, v)| 1.0 / f64::from(*v)).sum();
            let mean = [0, 1, 2].map(|axis| {
                points.iter().map(|(at, v)| f64::from(at[axis]) / f64::from(*v)).sum::<f64>() / total
            });
            let xz = points.iter().map(|(at, v)| {
                (f64::from(at[0]) - mean[0]) * (f64::from(at[2]) - mean[2]) / f64::from(*v)
            }).sum::<f64>() / total;
            let found = fused(&points);
            for (axis, mean) in mean.into_iter().enumerate() {
                prop_assert!((f64::from(found.mean_m[axis]) - mean).abs() < 1e-5);
            }
            prop_assert!((f64::from(found.covariance_m2[4]) - xz).abs() < 1e-6);
        }
    }

    #[test]
    fn a_slope_has_its_normal_and_a_ball_is_scatter() {
        let slope: Vec<_> = (0..100)
            .map(|at| [(at % 10) as f32 * 0.01, (at / 10) as f32 * 0.01])
            .map(|[x, y]| ([x, y, 0.5 * x], 1e-4))
            .collect();
        let shape = fused(&slope).shape();
        let length = 1.25_f32.sqrt();
        assert!((shape.normal[2] - 1.0 / length).abs() < 1e-3);
        assert!((shape.normal[0] + 0.5 / length).abs() < 1e-3);
        assert!(shape.sigmas_m[2] < 1e-4 && fused(&slope).scatter() < 0.01);
        let corners: Vec<_> = (0..8_u8)
            .map(|at| ([0, 1, 2].map(|axis| f32::from(at >> axis & 1)), 1e-4))
            .collect();
        assert!((fused(&corners).scatter() - 1.0).abs() < 1e-3);
    }
}
