//! The heading's error, the gyroscope's remaining bias, and the error at each keyframe, with what is known of them together.
//!
//! A keyframe was drawn with the heading that was believed then. To see it again tells the difference between the error then and
//! now, never the error itself: a Kalman filter with a clone of the state for each keyframe (stochastic cloning: Roumeliotis and
//! Burdick 2002). By the time between, that difference is the bias; by the bias, all errors since the start are known.

use nalgebra::{DMatrix, DVector};

/// Place of the error now.
const NOW: usize = 0;
/// Place of the rate at which it grows.
const RATE: usize = 1;
/// Place of the first keyframe's.
const FIRST: usize = 2;

/// A Kalman filter over `[error now, its rate, error at each keyframe]`; errors are what has to be added to the odometry's heading.
#[derive(Debug, Clone)]
pub(super) struct HeadingFilter {
    state: DVector<f64>,
    covariance: DMatrix<f64>,
}

impl HeadingFilter {
    /// At the start the heading is told; the gyroscope's bias is anything.
    pub(super) fn new(rate_sd_radps: f64) -> Self {
        let mut covariance = DMatrix::zeros(FIRST, FIRST);
        covariance[(RATE, RATE)] = rate_sd_radps * rate_sd_radps;
        Self {
            state: DVector::zeros(FIRST),
            covariance,
        }
    }

    /// What has to be added to the odometry's heading, rad.
    pub(super) fn error_rad(&self) -> f64 {
        self.state[NOW]
    }

    /// Time goes by: the error grows, and becomes less sure.
    pub(super) fn predict(&mut self, passed_s: f64, heading_drift: f64, bias_drift: f64) {
        self.state[NOW] += self.state[RATE] * passed_s;
        let mut step = DMatrix::identity(self.state.len(), self.state.len());
        step[(NOW, RATE)] = passed_s;
        self.covariance = &step * &self.covariance * step.transpose();
        self.covariance[(NOW, NOW)] += heading_drift * heading_drift * passed_s;
        self.covariance[(RATE, RATE)] += bias_drift * bias_drift * passed_s;
    }

    /// The gyroscope's bias was learned at rest: what is left of it is within this standard deviation of nothing.
    pub(super) fn rested(&mut self, rate_sd_radps: f64) {
        let (known, wanted) = (self.covariance[(RATE, RATE)], rate_sd_radps.powi(2));
        if wanted < known {
            let mut of = DVector::zeros(self.state.len());
            of[RATE] = 1.0;
            self.fuse(&of, -self.state[RATE], 1.0 / (1.0 / wanted - 1.0 / known));
        }
    }

    /// Remembers the error now as that of a new keyframe, which keeps the heading as well as `noise_rad` says.
    pub(super) fn remember(&mut self, noise_rad: f64) {
        let at = self.state.len();
        let state = std::mem::take(&mut self.state);
        self.state = state.push(0.0);
        self.state[at] = self.state[NOW];
        let covariance = std::mem::replace(&mut self.covariance, DMatrix::zeros(0, 0));
        let mut covariance = covariance.resize(at + 1, at + 1, 0.0);
        for other in 0..at {
            covariance[(at, other)] = covariance[(NOW, other)];
            covariance[(other, at)] = covariance[(other, NOW)];
        }
        covariance[(at, at)] = covariance[(NOW, NOW)] + noise_rad * noise_rad;
        self.covariance = covariance;
    }

    /// Forgets a keyframe.
    pub(super) fn forget(&mut self, keyframe: usize) {
        let at = FIRST + keyframe;
        let state = std::mem::take(&mut self.state);
        self.state = state.remove_row(at);
        let covariance = std::mem::replace(&mut self.covariance, DMatrix::zeros(0, 0));
        self.covariance = covariance.remove_row(at).remove_column(at);
    }

    /// By how much the error has grown since a keyframe, rad, and the variance of that.
    pub(super) fn since(&self, keyframe: usize) -> (f64, f64) {
        let of = self.difference(keyframe);
        (self.state.dot(&of), of.dot(&(&self.covariance * &of)))
    }

    /// Takes in that the error has grown by `beyond_rad` more than was believed since a keyframe.
    pub(super) fn correct(&mut self, keyframe: usize, beyond_rad: f64, variance_rad2: f64) {
        self.fuse(&self.difference(keyframe), beyond_rad, variance_rad2);
    }

    fn difference(&self, keyframe: usize) -> DVector<f64> {
        let mut of = DVector::zeros(self.state.len());
        of[NOW] = 1.0;
        of[FIRST + keyframe] = -1.0;
        of
    }

    fn fuse(&mut self, of: &DVector<f64>, innovation: f64, variance: f64) {
        let shared = &self.covariance * of;
        let gain = &shared / (of.dot(&shared) + variance);
        self.state += &gain * innovation;
        self.covariance -= &gain * shared.transpose();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE_RADPS: f64 = 0.001;

    #[test]
    fn a_keyframe_seen_again_tells_the_bias_and_by_it_the_error_since_the_start() {
        let mut filter = HeadingFilter::new(0.0015);
        filter.predict(20.0, 1e-4, 1e-5);
        filter.remember(0.009);
        filter.predict(20.0, 1e-4, 1e-5);
        for _ in 0..200 {
            let (believed_rad, _) = filter.since(0);
            filter.correct(0, 20.0 * RATE_RADPS - believed_rad, 0.01);
        }
        let error_rad = filter.error_rad();
        assert!((error_rad - 40.0 * RATE_RADPS).abs() < 0.012, "{error_rad}");
    }

    #[test]
    fn a_keyframe_just_drawn_tells_nothing_about_the_heading() {
        let mut filter = HeadingFilter::new(0.0015);
        filter.predict(20.0, 1e-4, 1e-5);
        filter.remember(0.009);
        let before = filter.error_rad();
        filter.correct(0, 0.05, 1e-4);
        assert!((filter.error_rad() - before).abs() < 1e-9);
    }

    #[test]
    fn what_is_forgotten_leaves_the_rest_as_it_was() {
        let mut filter = HeadingFilter::new(0.0015);
        for _ in 0..3 {
            filter.predict(5.0, 1e-4, 1e-5);
            filter.remember(0.009);
        }
        let (first, last) = (filter.since(0), filter.since(2));
        filter.forget(1);
        assert_eq!((filter.since(0), filter.since(1)), (first, last));
    }

    #[test]
    fn a_rest_bounds_the_bias() {
        let mut filter = HeadingFilter::new(0.0015);
        filter.rested(3e-4);
        filter.rested(1e-3);
        filter.predict(10.0, 1e-9, 1e-9);
        filter.remember(1e-9);
        assert!((filter.covariance[(NOW, NOW)].sqrt() - 3e-3).abs() < 1e-6);
    }
}
