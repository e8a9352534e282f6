//! The height of the ground under vegetation learned from what the feet measure: recursive least squares.

use nalgebra::{SMatrix, SVector};
use settings::{ConfigError, POSITIVE, Table, above_to, settings};

use crate::load_bearing::Support;

settings! {
    /// How the ground under vegetation is learned on the way.
    pub struct LearnedGroundConfig("classification.learned_ground") {
        /// How fast what was learned long ago is forgotten: its weight falls by this factor with each step. 1 forgets nothing.
        forgetting: f64 = 0.995, "1", above_to(0.0, 1.0), "Haykin, Adaptive Filter Theory, section 9.3";
        /// Standard deviation of the weights before anything is learned. Less trusts the raw surface longer.
        prior: f64 = 1.0, "1", POSITIVE;
        /// Standard deviation of what a foot measures of the ground below what was seen.
        noise: f64 = 0.02, "m", POSITIVE;
    }
}

/// Number of features: the constant, how dense the canopy is, how far it reaches above its lowest part, and their product.
const FEATURES: usize = 4;

type FeatureWeights = SVector<f64, FEATURES>;

/// How the canopy of a cell looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Canopy {
    /// Mean height of what is seen, m: the raw surface.
    pub raw_m: f64,
    /// Share of the rays that ended above the lowest returns that agree.
    pub cover: f64,
    /// How far the raw surface stands above those, m.
    pub thickness_m: f64,
}

impl From<Support> for Canopy {
    fn from(support: Support) -> Self {
        Self {
            raw_m: support.raw_m,
            cover: support.cover,
            thickness_m: support.raw_m - support.height_m,
        }
    }
}

impl Canopy {
    fn features(&self) -> FeatureWeights {
        let [cover, thickness_m] = [self.cover, self.thickness_m];
        FeatureWeights::from([1.0, cover, thickness_m, cover * thickness_m])
    }
}

/// Learns how far below the raw surface the ground lies: handbook, section 36.3.1 (after Wellington and Stentz 2004).
///
/// Claim: where a foot has stood, the ground is known; what the canopy looked like there tells of the ground ahead.
#[derive(Debug, Clone)]
pub struct LearnedGround {
    config: LearnedGroundConfig,
    weights: FeatureWeights,
    covariance: SMatrix<f64, FEATURES, FEATURES>,
}

impl LearnedGround {
    /// Before the first step.
    pub fn new(config: LearnedGroundConfig) -> Result<Self, ConfigError> {
        config.check()?;
        let variance = config.prior * config.prior;
        Ok(Self {
            config,
            weights: FeatureWeights::zeros(),
            covariance: SMatrix::identity() * variance,
        })
    }

    /// Where the ground is thought to be, m, and the standard deviation of that by what was learned, m.
    pub fn predict(&self, canopy: &Canopy) -> (f64, f64) {
        let features = canopy.features();
        let variance = (features.transpose() * self.covariance * features)[0];
        let below_m = self.weights.dot(&features);
        (canopy.raw_m - below_m, (variance.max(0.0)).sqrt())
    }

    /// A foot stands where the canopy looked so, at this height, m.
    pub fn learn(&mut self, canopy: &Canopy, felt_m: f64) {
        let features = canopy.features();
        let noise = self.config.noise * self.config.noise;
        let spread = self.covariance * features;
        let gain = spread / (noise * self.config.forgetting + features.dot(&spread));
        let missed_m = (canopy.raw_m - felt_m) - self.weights.dot(&features);
        self.weights += gain * missed_m;
        let covariance = self.covariance - gain * spread.transpose();
        let covariance = (covariance + covariance.transpose()) / 2.0;
        self.covariance = covariance / self.config.forgetting;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::Noise;
    use proptest::prelude::*;

    /// A cell of a meadow that is walked: how its canopy looks, and the true ground (m). The taller the grass is, the more it hides.
    fn cell(noise: &mut Noise) -> (Canopy, f64) {
        let ground_m = noise.within(-0.1, 0.1);
        let tall_m = noise.within(0.05, 0.4);
        let dense = noise.within(0.2, 1.0);
        // Dense grass is seen near its tips, and its lowest returns do not reach the ground.
        let raw_m = ground_m + tall_m * (0.3 + 0.5 * dense) + noise.normal(0.015);
        let lowest_m = ground_m + 0.3 * dense * tall_m + noise.normal(0.01);
        let canopy = Canopy {
            raw_m,
            cover: (dense + noise.normal(0.05)).clamp(0.0, 1.0),
            thickness_m: raw_m - lowest_m,
        };
        (canopy, ground_m)
    }

    #[test]
    fn what_the_feet_felt_halves_the_error_of_the_raw_surface_within_a_walk() {
        for seed in 0..20 {
            let mut noise = Noise::new(seed);
            let mut learned = LearnedGround::new(LearnedGroundConfig::default()).unwrap();
            let (mut squares, mut raw) = (0.0, 0.0);
            for _ in 0..200 {
                let (canopy, ground_m) = cell(&mut noise);
                let (height_m, _) = learned.predict(&canopy); // ahead, before a foot was there
                squares += (height_m - ground_m) * (height_m - ground_m);
                raw += (canopy.raw_m - ground_m) * (canopy.raw_m - ground_m);
                learned.learn(&canopy, ground_m + noise.normal(0.005));
            }
            let ratio = f64::sqrt(squares / raw);
            assert!(
                ratio <= 0.5,
                "seed {seed}: {ratio:.3} of the raw surface's error"
            );
        }
    }

    #[test]
    fn before_the_first_step_the_raw_surface_is_the_ground() {
        let learned = LearnedGround::new(LearnedGroundConfig::default()).unwrap();
        let (canopy, _) = cell(&mut Noise::new(1));
        let (height_m, sigma_m) = learned.predict(&canopy);
        assert_eq!(height_m, canopy.raw_m);
        assert!(sigma_m >= 1.0);
    }

    proptest! {
        #[test]
        fn without_forgetting_it_is_ridge_regression_over_all_steps(seed in 0_u64..200, steps in 1_usize..30) {
            let config = LearnedGroundConfig { forgetting: 1.0, ..LearnedGroundConfig::default() };
            let mut noise = Noise::new(seed);
            let mut learned = LearnedGround::new(config.clone()).unwrap();
            let mut information = SMatrix::<f64, FEATURES, FEATURES>::identity() / (config.prior * config.prior);
            let mut moments = FeatureWeights::zeros();
            for _ in 0..steps {
                let (canopy, ground_m) = cell(&mut noise);
                learned.learn(&canopy, ground_m);
                let features = canopy.features();
                information += features * features.transpose() / (config.noise * config.noise);
                moments += features * (canopy.raw_m - ground_m) / (config.noise * config.noise);
            }
            let expected = information.cholesky().unwrap().solve(&moments);
            prop_assert!((learned.weights - expected).norm() < 1e-6);
        }
    }
}
