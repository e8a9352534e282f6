//! Made-up measurements for tests: noise that is the same everywhere.

use geometry::SplitMix64;

/// Random numbers of a test.
pub(crate) struct Noise(SplitMix64);

impl Noise {
    /// From a seed on.
    pub(crate) const fn new(seed: u64) -> Self {
        Self(SplitMix64::new(seed))
    }

    /// Uniform from `low` to `high`.
    pub(crate) fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.uniform()
    }

    /// Normal with mean 0 and this standard deviation (Box and Muller 1958).
    pub(crate) fn normal(&mut self, sigma: f64) -> f64 {
        let radius = (-2.0 * libm::log(1.0 - self.0.uniform())).sqrt();
        sigma * radius * libm::cos(core::f64::consts::TAU * self.0.uniform())
    }
}
