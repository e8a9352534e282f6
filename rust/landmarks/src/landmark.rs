//! One landmark: a Gaussian on the plane, and how sure it is that something is there.

use geometry::PlanarPose;
use nalgebra::{Matrix2, Vector2};

use crate::LandmarksConfig;
use crate::sighting::{ExpectedReading, LandmarkReading, RangeBearing, noise};

/// A landmark on the plane (004, section 36.2.4: one of K two-dimensional Gaussians).
#[derive(Debug, Clone, PartialEq)]
pub struct Landmark {
    /// Where it most likely is, m, in the map frame.
    pub at_m: Vector2<f64>,
    /// Covariance of that, m².
    pub covariance: Matrix2<f64>,
    /// What the sensor calls it, where it can tell.
    pub name: Option<u32>,
    /// Logarithm of the odds that it is there.
    pub log_odds: f64,
    /// How many readings of it were taken in.
    pub readings: u32,
    /// How far the robot had gone, m, and turned, rad, at the last of them.
    pub(crate) gone: [f64; 2],
}

impl Landmark {
    /// From its first reading, by a robot at a place that is known.
    pub fn first(
        robot: &PlanarPose,
        sighting: &LandmarkReading,
        gone: [f64; 2],
        config: &LandmarksConfig,
    ) -> Self {
        let by_reading = sighting.at.place_by_reading(robot);
        Self {
            at_m: sighting.at.place_m(robot),
            covariance: by_reading * noise(config) * by_reading.transpose(),
            name: sighting.name.filter(|_| config.named),
            log_odds: 0.0,
            readings: 1,
            gone,
        }
    }

    /// Takes in another reading, by a robot at a place that is known: an extended Kalman filter of two dimensions. `doubt`: what the variance of the
    /// reading's error is multiplied by.
    pub fn update(
        &mut self,
        robot: &PlanarPose,
        at: &RangeBearing,
        doubt: f64,
        config: &LandmarksConfig,
    ) {
        let Some(expected) = ExpectedReading::of(robot, &self.at_m) else {
            return;
        };
        let by = expected.by_landmark;
        let noise = noise(config) * doubt;
        let spread = self.covariance * by.transpose();
        let Some(inverse) = (by * spread + noise).try_inverse() else {
            return;
        };
        let gain = spread * inverse;
        self.at_m += gain * at.minus(&expected.reading);
        // Joseph's form: stays symmetric and positive.
        let kept = Matrix2::identity() - gain * by;
        self.covariance =
            kept * self.covariance * kept.transpose() + gain * noise * gain.transpose();
        self.readings += 1;
    }

    /// The mean of several guesses of it with their weights, and the covariance of all (the moments of a mixture of Gaussians).
    pub(crate) fn mean_of(&self, same: &[(&Self, f64)]) -> Self {
        let sum: f64 = same.iter().map(|(_, weight)| weight).sum();
        if sum <= 0.0 {
            return self.clone();
        }
        let shares = same.iter().map(|(one, weight)| (*one, weight / sum));
        let at_m: Vector2<f64> = shares.clone().map(|(one, share)| one.at_m * share).sum();
        let of = |(one, share): (&Self, f64)| {
            let off = one.at_m - at_m;
            (one.covariance + off * off.transpose()) * share
        };
        Self {
            at_m,
            covariance: shares.map(of).sum(),
            ..self.clone()
        }
    }

    /// Probability that it is there.
    pub fn probability(&self) -> f64 {
        1.0 / (1.0 + libm::exp(-self.log_odds))
    }

    /// Takes in that a look at its place saw it, or did not.
    pub(crate) fn look(&mut self, saw_it: bool, config: &LandmarksConfig) {
        let (seen, imagined) = (config.seen, config.imagined);
        let ratio = if saw_it {
            seen / imagined
        } else {
            (1.0 - seen) / (1.0 - imagined)
        };
        let most = libm::log(config.sure / (1.0 - config.sure));
        self.log_odds = (self.log_odds + libm::log(ratio)).clamp(-most, most);
    }

    /// Whether a reading from here is independent of its last one.
    pub(crate) fn is_apart(&self, gone: [f64; 2], config: &LandmarksConfig) -> bool {
        (0..2).any(|way| gone[way] - self.gone[way] >= config.apart[way])
    }
}
