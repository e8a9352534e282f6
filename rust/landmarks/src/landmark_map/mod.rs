//! Landmarks mapped from places that are known: K small extended Kalman filters, each its own.

#[cfg(test)]
mod tests;

use std::sync::Arc;

use core::f64::consts::TAU;

use geometry::PlanarPose;
use nalgebra::{Matrix2, Matrix3, Vector2};
use settings::{ConfigError, Table};

use crate::sighting::{ExpectedReading, LandmarkReading, RangeBearing, in_view, noise};
use crate::{Landmark, LandmarksConfig};

/// What a reading is taken for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Pairing {
    /// A landmark that is known, by index.
    Known(Matched),
    /// One that is not known yet.
    New,
    /// Nobody's: too far from all, or too near to be another.
    Nobody,
}

/// A reading of a landmark that is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Matched {
    /// The landmark's index.
    pub(crate) index: usize,
    /// What was expected of it.
    pub(crate) expected: ExpectedReading,
    /// The reading less what was expected: m, rad.
    pub(crate) innovation: Vector2<f64>,
    /// Inverse of the innovation's covariance.
    pub(crate) information: Matrix2<f64>,
    /// Logarithm of the density of the reading.
    pub(crate) log_likelihood: f64,
    /// What the variance of its error is taken for, over what the settings say: above 1 where it lies beyond the gate and yet must be this landmark's.
    pub(crate) doubt: f64,
    /// Whether it says something that the last reading did not.
    pub(crate) is_apart: bool,
}

/// Landmarks, each a Gaussian of its own (004, section 36.2.4: "we only need K two-dimensional Gaussians to represent the entire map since the robot
/// pose is known"). Copies of a map share the landmarks that neither changed since.
#[derive(Debug, Clone)]
pub struct LandmarkMap {
    config: Arc<LandmarksConfig>,
    landmarks: Vec<Arc<Landmark>>,
}

impl LandmarkMap {
    /// One without landmarks.
    pub fn new(config: LandmarksConfig) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self {
            config: Arc::new(config),
            landmarks: Vec::new(),
        })
    }

    /// The settings.
    pub fn config(&self) -> &LandmarksConfig {
        &self.config
    }

    /// The landmarks, in the order in which they were first seen.
    pub fn landmarks(&self) -> impl ExactSizeIterator<Item = &Landmark> {
        self.landmarks.iter().map(AsRef::as_ref)
    }

    /// How many of the landmarks are the same piece of memory in another map.
    pub fn shared_with(&self, other: &Self) -> usize {
        let theirs = |one| other.landmarks.iter().any(|other| Arc::ptr_eq(one, other));
        self.landmarks.iter().filter(|one| theirs(one)).count()
    }

    /// Takes in what is seen at one time from a place that is known. `gone`: how far the robot went, m, and turned, rad, since it began.
    pub fn insert(&mut self, robot: &PlanarPose, sightings: &[LandmarkReading], gone: [f64; 2]) {
        let certain = Matrix3::zeros();
        let mut taken = Vec::with_capacity(sightings.len());
        let mut paired = Vec::with_capacity(sightings.len());
        for sighting in sightings.iter().filter(|one| one.at.is_sound()) {
            let pairing = self.pair((robot, &certain), sighting, &taken, gone);
            if let Pairing::Known(found) = &pairing {
                taken.push(found.index);
            }
            paired.push((*sighting, pairing));
        }
        self.take(robot, &paired, gone);
    }

    /// Takes in readings that are paired, from a place that is known.
    pub(crate) fn take(
        &mut self,
        robot: &PlanarPose,
        paired: &[(LandmarkReading, Pairing)],
        gone: [f64; 2],
    ) {
        let config = Arc::clone(&self.config);
        let before = self.landmarks.len();
        let mut seen = vec![false; before];
        for (sighting, pairing) in paired {
            match pairing {
                Pairing::Known(found) => {
                    seen[found.index] = true;
                    if found.is_apart {
                        let landmark = Arc::make_mut(&mut self.landmarks[found.index]);
                        landmark.update(robot, &sighting.at, found.doubt, &config);
                        landmark.look(true, &config);
                        landmark.gone = gone;
                    }
                }
                Pairing::New => {
                    let landmark = Landmark::first(robot, sighting, gone, &config);
                    self.landmarks.push(Arc::new(landmark));
                }
                Pairing::Nobody => {}
            }
        }
        if !config.named {
            self.miss(robot, &seen, gone);
        }
    }

    /// Negative evidence (Montemerlo, Thrun, Koller, Wegbreit 2003): what should be seen and is not may not be there, and what is not there is forgotten.
    fn miss(&mut self, robot: &PlanarPose, seen: &[bool], gone: [f64; 2]) {
        let config = &self.config;
        let least = libm::log(config.forget / (1.0 - config.forget));
        for (landmark, _) in self
            .landmarks
            .iter_mut()
            .zip(seen)
            .filter(|(_, seen)| !**seen)
        {
            if landmark.is_apart(gone, config) && in_view(robot, &landmark.at_m, config) {
                let landmark = Arc::make_mut(landmark);
                landmark.look(false, config);
                landmark.gone = gone;
            }
        }
        self.landmarks.retain(|landmark| landmark.log_odds > least);
    }

    /// Which landmark a reading is of, seen from a pose with a covariance (m, m, rad): the one that the sensor names, else the likeliest of those that are
    /// not `taken` by other readings of the same time (maximum likelihood).
    pub(crate) fn pair(
        &self,
        pose: (&PlanarPose, &Matrix3<f64>),
        sighting: &LandmarkReading,
        taken: &[usize],
        gone: [f64; 2],
    ) -> Pairing {
        let config = &self.config;
        let gate = LandmarksConfig::squared_distance(config.gate);
        let name = sighting.name.filter(|_| config.named);
        let free =
            self.landmarks.iter().enumerate().filter(|(index, one)| {
                !taken.contains(index) && (name.is_none() || one.name == name)
            });
        let beyond = match name {
            Some(_) => f64::INFINITY,
            None => LandmarksConfig::squared_distance(config.new_beyond),
        };
        let mut nearest = f64::INFINITY;
        let mut best: Option<Matched> = None;
        for (index, landmark) in free {
            let Some((found, square)) = self.compare(pose, &sighting.at, (index, beyond)) else {
                continue;
            };
            nearest = nearest.min(square);
            let better = best.is_none_or(|other| found.log_likelihood > other.log_likelihood);
            if better && (square <= gate || name.is_some()) {
                // Errors further out count no more than at the gate (Huber 1964), so that a map that is wrong can be mended.
                let doubt = (square / gate).max(1.0);
                best = Some(Matched {
                    information: found.information / doubt,
                    doubt,
                    is_apart: landmark.is_apart(gone, config),
                    ..found
                });
            }
        }
        match best {
            Some(found) => Pairing::Known(found),
            None if nearest > beyond || name.is_some() => Pairing::New,
            None => Pairing::Nobody,
        }
    }

    /// A reading against a landmark, and its squared Mahalanobis distance; none where that is above `beyond`, as far as it is seen at once.
    fn compare(
        &self,
        (robot, covariance): (&PlanarPose, &Matrix3<f64>),
        at: &RangeBearing,
        (index, beyond): (usize, f64),
    ) -> Option<(Matched, f64)> {
        let landmark = &self.landmarks[index];
        // By the range alone, whose variance is no greater than this: cheap, and most are far away.
        let off_m = at.range_m - distance_m(robot, &landmark.at_m);
        let (m11, m22) = (covariance.m11, covariance.m22);
        let most = m11 + m22 + landmark.covariance.trace() + self.config.range_noise.powi(2);
        if off_m * off_m > beyond * most {
            return None;
        }
        let expected = ExpectedReading::of(robot, &landmark.at_m)?;
        let spread = expected.covariance(covariance, &landmark.covariance, &self.config);
        let information = spread.try_inverse()?;
        let innovation = at.minus(&expected.reading);
        let square = (innovation.transpose() * information * innovation).x;
        let found = Matched {
            index,
            expected,
            innovation,
            information,
            log_likelihood: -0.5 * (square + libm::log(spread.determinant())) - libm::log(TAU),
            doubt: 1.0,
            is_apart: true,
        };
        Some((found, square))
    }

    /// The landmark that is the same as another map's: by its name, else the nearest that passes the gate.
    pub(crate) fn same_as(&self, other: &Landmark) -> Option<&Landmark> {
        if other.name.is_some() {
            return self.landmarks().find(|one| one.name == other.name);
        }
        let square = |one: &Landmark| {
            let inverse = (one.covariance + other.covariance).try_inverse()?;
            let off = one.at_m - other.at_m;
            Some((off.transpose() * inverse * off).x)
        };
        let gate = LandmarksConfig::squared_distance(self.config.gate);
        let near = self.landmarks().filter_map(|one| Some((one, square(one)?)));
        let near = near.filter(|(_, square)| *square <= gate);
        near.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(one, _)| one)
    }

    /// Logarithm of the density of a reading that is no landmark's: as low as at the gate of a landmark whose place is known.
    pub(crate) fn log_likelihood_of_nobody(&self) -> f64 {
        let gate = LandmarksConfig::squared_distance(self.config.gate);
        -0.5 * (gate + libm::log(noise(&self.config).determinant())) - libm::log(TAU)
    }
}

fn distance_m(robot: &PlanarPose, at_m: &Vector2<f64>) -> f64 {
    geometry::hypot(at_m.x - robot.x_m, at_m.y - robot.y_m)
}
