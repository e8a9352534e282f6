//! Cylinders of branches and trunks, fitted to points that lie on one side of them.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use settings::{ConfigError, POSITIVE, Table, at_least, settings};

use crate::cloud::{CloudError, Point3, check};

settings! {
    /// How branches and trunks become cylinders.
    pub struct CylinderConfig("classification.cylinder") {
        /// Most steps of the fit.
        steps: usize = 30, "1", at_least(1.0);
        /// Points that lie this far from the surface count half.
        near: f64 = 0.02, "m", POSITIVE;
        /// Largest radius.
        most_radius: f64 = 1.0, "m", POSITIVE;
        /// Fewest points.
        least_points: usize = 10, "1", at_least(6.0);
    }
}

/// A cylinder: a trunk, a branch, a post.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cylinder {
    /// Where its axis begins and ends, m.
    pub ends: [Vector3<f64>; 2],
    /// Its radius, m.
    pub radius_m: f64,
    /// Standard deviation of the points from its surface, m.
    pub sigma_m: f64,
}

/// Fits cylinders: a circle across the longest direction of the points, then all five numbers by Gauss and Newton's steps with the
/// weights of Cauchy (Lukács, Martin and Marshall 1998).
#[derive(Debug, Clone)]
pub struct Cylinders {
    config: CylinderConfig,
}

impl Cylinders {
    /// With settings.
    pub fn new(config: CylinderConfig) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self { config })
    }

    /// The cylinder of some points; `None` where none up to the largest radius fits.
    pub fn fit(&self, points: &[Point3]) -> Result<Option<Cylinder>, CloudError> {
        check(points, self.config.least_points)?;
        let places: Vec<_> = points.iter().map(|point| Vector3::from(*point)).collect();
        Ok(self.fitted(&places))
    }

    fn fitted(&self, places: &[Vector3<f64>]) -> Option<Cylinder> {
        let count = places.len() as f64;
        let middle = places.iter().sum::<Vector3<f64>>() / count;
        let moments = places
            .iter()
            .map(|place| (place - middle) * (place - middle).transpose())
            .sum::<Matrix3<f64>>();
        let eigen = moments.symmetric_eigen();
        let mut axis = eigen
            .eigenvectors
            .column(eigen.eigenvalues.imax())
            .into_owned();
        let (mut on, mut radius_m) = circle(places, middle, axis)?;
        for _ in 0..self.config.steps {
            let step = self.step(places, [axis, on], radius_m)?;
            let [u, v] = across(&axis);
            on += u * step[0] + v * step[1];
            axis = (axis + u * step[2] + v * step[3]).normalize();
            radius_m += step[4];
            if step.norm() < f64::EPSILON {
                break;
            }
        }
        let along = || places.iter().map(|place| (place - on).dot(&axis));
        let ends = [
            along().fold(f64::INFINITY, f64::min),
            along().fold(f64::NEG_INFINITY, f64::max),
        ];
        let apart = |place: &Vector3<f64>| {
            let offset = place - on;
            (offset - axis * offset.dot(&axis)).norm() - radius_m
        };
        let squares: f64 = places.iter().map(|place| apart(place) * apart(place)).sum();
        let fits = radius_m > 0.0 && radius_m <= self.config.most_radius && squares.is_finite();
        fits.then(|| Cylinder {
            ends: ends.map(|end| on + axis * end),
            radius_m,
            sigma_m: (squares / count).sqrt(),
        })
    }

    /// One step of Gauss and Newton: of the axis' place and direction across itself, and of the radius.
    fn step(
        &self,
        places: &[Vector3<f64>],
        [axis, on]: [Vector3<f64>; 2],
        radius_m: f64,
    ) -> Option<SVector<f64, 5>> {
        let [u, v] = across(&axis);
        let mut products = SMatrix::<f64, 5, 5>::zeros();
        let mut moments = SVector::<f64, 5>::zeros();
        for place in places {
            let offset = place - on;
            let along_m = offset.dot(&axis);
            let out = offset - axis * along_m;
            let Some(way) = out.try_normalize(f64::MIN_POSITIVE) else {
                continue;
            };
            let apart_m = out.norm() - radius_m;
            let [to_u, to_v] = [way.dot(&u), way.dot(&v)];
            let slopes = SVector::from([-to_u, -to_v, -along_m * to_u, -along_m * to_v, -1.0]);
            let share = apart_m / self.config.near;
            let weight = 1.0 / (1.0 + share * share);
            products += slopes * slopes.transpose() * weight;
            moments -= slopes * apart_m * weight;
        }
        products.cholesky().map(|factor| factor.solve(&moments))
    }
}

/// Two directions across an axis and each other.
fn across(axis: &Vector3<f64>) -> [Vector3<f64>; 2] {
    let u = axis.cross(&Vector3::ith(axis.iamin(), 1.0)).normalize();
    [u, axis.cross(&u)]
}

/// Middle and radius of the circle through points seen along an axis (Kåsa 1976).
fn circle(
    places: &[Vector3<f64>],
    middle: Vector3<f64>,
    axis: Vector3<f64>,
) -> Option<(Vector3<f64>, f64)> {
    let [u, v] = across(&axis);
    let mut products = Matrix3::zeros();
    let mut moments = Vector3::zeros();
    for place in places {
        let [x, y] = [(place - middle).dot(&u), (place - middle).dot(&v)];
        let row = Vector3::new(2.0 * x, 2.0 * y, 1.0);
        products += row * row.transpose();
        moments += row * (x * x + y * y);
    }
    let found = products.cholesky()?.solve(&moments);
    let square = found[2] + found[0] * found[0] + found[1] * found[1];
    let on = middle + u * found[0] + v * found[1];
    (square > 0.0).then(|| (on, square.sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::Noise;

    /// Points on the side of a trunk that is seen, with noise and some leaves; its axis and radius (m).
    fn trunk(seed: u64) -> (Vec<Point3>, Vector3<f64>, f64) {
        let mut noise = Noise::new(seed);
        let radius_m = noise.within(0.04, 0.2);
        let lean = Vector3::new(noise.within(-0.3, 0.3), noise.within(-0.3, 0.3), 1.0);
        let axis = lean.normalize();
        let [u, v] = across(&axis);
        let foot = Vector3::new(noise.within(-9.0, 9.0), noise.within(-9.0, 9.0), 0.0);
        let seen_from = noise.within(0.0, core::f64::consts::TAU);
        let points = (0..500)
            .map(|index| {
                let along_m = noise.within(0.0, 8.0 * radius_m + 0.5);
                let (sin, cos) = libm::sincos(seen_from + noise.within(-1.4, 1.4));
                let out_m = radius_m + noise.normal(0.005);
                let leaf_m = if index % 20 == 0 {
                    noise.within(0.0, 0.1)
                } else {
                    0.0
                };
                let place = foot + axis * along_m + (u * cos + v * sin) * (out_m + leaf_m);
                place.into()
            })
            .collect();
        (points, axis, radius_m)
    }

    #[test]
    fn a_trunk_that_is_seen_from_one_side_has_its_radius_within_a_tenth() {
        let cylinders = Cylinders::new(CylinderConfig::default()).unwrap();
        for seed in 0..40 {
            let (points, axis, radius_m) = trunk(seed);
            let found = cylinders.fit(&points).unwrap().unwrap();
            let error = (found.radius_m - radius_m).abs() / radius_m;
            assert!(error <= 0.1, "seed {seed}: {radius_m:.3} m, {found:?}");
            let direction = (found.ends[1] - found.ends[0]).normalize();
            assert!(direction.dot(&axis).abs() > 0.995, "seed {seed}: {found:?}");
        }
    }

    #[test]
    fn without_noise_it_is_the_cylinder_itself() {
        let axis = Vector3::new(0.1, -0.2, 1.0).normalize();
        let [u, v] = across(&axis);
        let points: Vec<Point3> = (0..200)
            .map(|index| {
                let (sin, cos) = libm::sincos(f64::from(index) * 0.7);
                let along_m = f64::from(index) * 0.01;
                (Vector3::new(3.0, 4.0, 0.0) + axis * along_m + (u * cos + v * sin) * 0.12).into()
            })
            .collect();
        let found = Cylinders::new(CylinderConfig::default())
            .unwrap()
            .fit(&points)
            .unwrap()
            .unwrap();
        assert!(
            (found.radius_m - 0.12).abs() < 1e-9 && found.sigma_m < 1e-9,
            "{found:?}"
        );
        assert!(((found.ends[1] - found.ends[0]).norm() - 1.99).abs() < 1e-6);
    }

    #[test]
    fn what_is_no_cylinder_is_none() {
        let cylinders = Cylinders::new(CylinderConfig::default()).unwrap();
        assert!(cylinders.fit(&[[0.0; 3]; 3]).is_err());
        assert_eq!(cylinders.fit(&[[1.0; 3]; 20]).unwrap(), None);
    }
}
