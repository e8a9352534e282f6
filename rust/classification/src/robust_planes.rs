//! Planes among clutter: sampled, scored by how far points lie from them, and refined without the rest.

use geometry::{Plane, SplitMix64};
use nalgebra::{Matrix3, Unit, Vector3};
use settings::{ConfigError, POSITIVE, SHARE, Table, at_least, settings};

use crate::cloud::{CloudError, Point3, check};

settings! {
    /// How planes are found among clutter.
    pub struct RobustPlanesConfig("classification.robust_planes") {
        /// Standard deviation of a point from its plane.
        noise: f64 = 0.01, "m", POSITIVE;
        /// Points farther from a plane than this many times the noise do not belong to it.
        gate: f64 = 3.0, "1", POSITIVE, "Torr and Zisserman 2000, section 4";
        /// Planes through three points that are tried.
        samples: usize = 300, "1", at_least(1.0);
        /// Rounds in which the best is fitted to the points near it.
        rounds: usize = 10, "1", at_least(0.0);
        /// Share of the points that a plane must hold.
        least_share: f64 = 0.1, "1", SHARE;
        /// Most planes of a cloud.
        most: usize = 8, "1", at_least(1.0);
    }
}

/// A plane and what lies on it.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundPlane {
    /// The plane, in the cloud's own frame.
    pub plane: Plane,
    /// Which points lie on it, in the cloud's order.
    pub points: Vec<usize>,
}

/// Finds planes where half of the points are something else: handbook, section 36.3.5, references 36.56 and 36.57 (MSAC, Torr and
/// Zisserman 2000; then weights by Tukey's biweight). The samples come from a counter: the same cloud gives the same planes.
#[derive(Debug, Clone)]
pub struct RobustPlanes {
    config: RobustPlanesConfig,
}

impl RobustPlanes {
    /// With settings.
    pub fn new(config: RobustPlanesConfig) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self { config })
    }

    /// The planes of a cloud, each of the points that the ones before it left, while they hold enough.
    pub fn find(&self, points: &[Point3]) -> Result<Vec<FoundPlane>, CloudError> {
        check(points, 3)?;
        let all: Vec<_> = points.iter().map(|point| Vector3::from(*point)).collect();
        let least = ((self.config.least_share * all.len() as f64) as usize).max(3);
        let mut left: Vec<usize> = (0..all.len()).collect();
        let mut found = Vec::new();
        while found.len() < self.config.most && left.len() >= least {
            let Some(one) = self
                .largest(&all, &left)
                .filter(|one| one.points.len() >= least)
            else {
                break;
            };
            left.retain(|index| one.points.binary_search(index).is_err());
            found.push(one);
        }
        Ok(found)
    }

    /// The plane that explains most of some points.
    fn largest(&self, all: &[Vector3<f64>], left: &[usize]) -> Option<FoundPlane> {
        let gate_m = self.config.gate * self.config.noise;
        let mut numbers = SplitMix64::new(left.len() as u64);
        let mut draw = || all[left[(numbers.uniform() * left.len() as f64) as usize]];
        // Each point costs its square up to the gate's: what lies beyond costs the same, however far it is.
        let cost = |normal: &Vector3<f64>, on: &Vector3<f64>| -> f64 {
            let squares = left.iter().map(|&index| {
                let apart_m = normal.dot(&(all[index] - on));
                (apart_m * apart_m).min(gate_m * gate_m)
            });
            squares.sum()
        };
        let mut best: Option<(f64, Vector3<f64>, Vector3<f64>)> = None;
        for _ in 0..self.config.samples {
            let [a, b, c] = [draw(), draw(), draw()];
            let Some(normal) = (b - a).cross(&(c - a)).try_normalize(f64::MIN_POSITIVE) else {
                continue;
            };
            let of_this = cost(&normal, &a);
            if best.is_none_or(|(of_best, ..)| of_this < of_best) {
                best = Some((of_this, normal, a));
            }
        }
        let (mut of_best, mut normal, mut on) = best?;
        for _ in 0..self.config.rounds {
            let Some((fitted, middle)) = fitted(all, left, [normal, on], gate_m) else {
                break;
            };
            let of_fitted = cost(&fitted, &middle);
            if of_fitted >= of_best {
                break;
            }
            (of_best, normal, on) = (of_fitted, fitted, middle);
        }
        let points = left.iter().copied();
        let near = |index: &usize| normal.dot(&(all[*index] - on)).abs() <= gate_m;
        let normal_up = if normal[2] < 0.0 { -normal } else { normal };
        Some(FoundPlane {
            plane: Plane {
                normal: Unit::new_normalize(normal_up),
                distance_m: normal_up.dot(&on),
            },
            points: points.filter(near).collect(),
        })
    }
}

/// Normal and middle of the points near a plane, each with the weight that Tukey's biweight gives it.
fn fitted(
    all: &[Vector3<f64>],
    left: &[usize],
    [normal, on]: [Vector3<f64>; 2],
    gate_m: f64,
) -> Option<(Vector3<f64>, Vector3<f64>)> {
    let weighed = || {
        left.iter().filter_map(|&index| {
            let share = normal.dot(&(all[index] - on)) / gate_m;
            let rest = 1.0 - share * share;
            (rest > 0.0).then(|| (rest * rest, all[index] - on))
        })
    };
    let total: f64 = weighed().map(|(weight, _)| weight).sum();
    let middle = weighed()
        .map(|(weight, offset)| offset * weight)
        .sum::<Vector3<f64>>()
        / total;
    let moments = weighed()
        .map(|(weight, offset)| (offset - middle) * (offset - middle).transpose() * weight)
        .sum::<Matrix3<f64>>();
    if !moments.iter().all(|value| value.is_finite()) {
        return None;
    }
    let eigen = moments.symmetric_eigen();
    let axis = eigen.eigenvalues.imin();
    Some((eigen.eigenvectors.column(axis).into_owned(), on + middle))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::Noise;

    fn finder() -> RobustPlanes {
        RobustPlanes::new(RobustPlanesConfig::default()).unwrap()
    }

    /// A wall of 2 m x 2 m in any direction, as many points of clutter around it, half of it a bush before the wall; its normal.
    fn cluttered(seed: u64) -> (Vec<Point3>, Vector3<f64>) {
        let mut noise = Noise::new(seed);
        let direction = Vector3::from([0; 3].map(|_| noise.normal(1.0))).normalize();
        let across = direction
            .cross(&Vector3::from([0; 3].map(|_| noise.normal(1.0))))
            .normalize();
        let along = direction.cross(&across);
        let middle = Vector3::from([0; 3].map(|_| noise.within(-5.0, 5.0)));
        let bush = middle + direction * 0.4 + across * noise.within(-0.5, 0.5);
        let mut points = Vec::new();
        for index in 0..1000 {
            let [a, b] = [noise.within(-1.0, 1.0), noise.within(-1.0, 1.0)];
            let point = match index % 4 {
                0 | 1 => middle + across * a + along * b + direction * noise.normal(0.01),
                2 => bush + Vector3::from([0; 3].map(|_| noise.normal(0.25))),
                _ => middle + Vector3::from([0; 3].map(|_| noise.within(-1.2, 1.2))),
            };
            points.push(point.into());
        }
        (points, direction)
    }

    #[test]
    fn with_half_of_the_points_clutter_the_normal_is_within_a_degree() {
        for seed in 0..40 {
            let (points, direction) = cluttered(seed);
            let found = finder().find(&points).unwrap();
            let angle = libm::acos(found[0].plane.normal.dot(&direction).abs().min(1.0));
            assert!(
                angle.to_degrees() <= 1.0,
                "seed {seed}: {:.2} degrees",
                angle.to_degrees()
            );
            let right = found[0]
                .points
                .iter()
                .filter(|index| **index % 4 < 2)
                .count();
            assert!(right > 480, "seed {seed}: {right} of 500");
        }
    }

    #[test]
    fn a_floor_and_two_walls_are_three_planes() {
        let mut noise = Noise::new(9);
        let points: Vec<Point3> = (0..1800)
            .map(|index| {
                let [a, b] = [noise.within(0.0, 2.0), noise.within(0.0, 2.0)];
                let off = noise.normal(0.005);
                [[a, b, off], [off, a, b], [a, off, b]][index % 3]
            })
            .collect();
        let found = finder().find(&points).unwrap();
        assert_eq!(found.len(), 3);
        let total: usize = found.iter().map(|one| one.points.len()).sum();
        assert!(total > 1780, "{total}");
        assert!(found.iter().all(|one| one.plane.distance_m.abs() < 0.005));
        assert_eq!(found, finder().find(&points).unwrap());
    }

    #[test]
    fn a_bush_alone_has_no_plane_and_too_few_points_are_refused() {
        let mut noise = Noise::new(4);
        let bush: Vec<Point3> = (0..800)
            .map(|_| [0; 3].map(|_| noise.normal(0.5)))
            .collect();
        assert_eq!(finder().find(&bush).unwrap(), []);
        assert!(finder().find(&[[0.0; 3]; 2]).is_err());
        assert_eq!(finder().find(&[[1.0; 3]; 5]).unwrap(), []); // all on one spot
    }
}
