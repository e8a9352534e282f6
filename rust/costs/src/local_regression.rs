//! A number learned online from a few others: linear models, each for its neighbourhood, by recursive least squares.

use nalgebra::{DMatrix, DVector};
use settings::{ConfigError, POSITIVE, Table, above_to, at_least, settings};

settings! {
    /// How a number is learned from others on the way.
    pub struct LocalRegressionConfig("costs.local_regression") {
        /// How far around it a model counts: the standard deviation of its bell. Inputs are meant to lie from 0 to 1.
        width: f64 = 0.12, "1", POSITIVE, "Schaal and Atkeson 1998, equation (2)";
        /// A new model is made where no other counts by this much.
        apart: f64 = 0.3, "1", above_to(0.0, 1.0), "Schaal and Atkeson 1998, section 3.3";
        /// How fast what was learned long ago is forgotten. 1 forgets nothing.
        forgetting: f64 = 1.0, "1", above_to(0.0, 1.0), "Schaal and Atkeson 1998, equation (5)";
        /// Standard deviation of a measurement, in its unit.
        noise: f64 = 0.5, "1", POSITIVE;
        /// Standard deviation of the weights before anything is learned: of the number itself, and of its change as an input goes from 0 to 1.
        spread: f64 = 1.0, "1", POSITIVE;
        /// Measurements whose weight equals that of the prior.
        doubt: f64 = 1.0, "1", POSITIVE;
        /// Most models: no more are made then.
        most: usize = 200, "1", at_least(1.0);
    }
}

/// What cannot be learned from or told.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RegressionError {
    /// Settings that cannot be used.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// Another number of inputs than before.
    #[error("{found} inputs, expected {expected}")]
    WrongLength {
        /// How many there are.
        found: usize,
        /// How many there should be.
        expected: usize,
    },
    /// An input or a measurement that is no number.
    #[error("input {index} is not finite")]
    NotFinite {
        /// Which; one past the last is the measurement.
        index: usize,
    },
}

/// What is told of a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prediction {
    /// The number.
    pub value: f64,
    /// Measurements that it rests on, by their weights: 0 where nothing like it was met.
    pub support: f64,
}

/// One linear model about its centre.
#[derive(Debug, Clone)]
struct ReceptiveField {
    center: DVector<f64>,
    weights: DVector<f64>,
    covariance: DMatrix<f64>,
    support: f64,
}

/// Learns a number from others by receptive fields, each with a linear model that recursive least squares keeps (Schaal and Atkeson 1998):
/// costs of what is far from what is near (004, Fig. 36.16), slip from shade (reference 36.33), roughness and traversability (36.32, 36.34).
/// The same measurements in the same order give the same bits.
#[derive(Debug, Clone)]
pub struct LocalRegression {
    config: LocalRegressionConfig,
    inputs: usize,
    prior: f64,
    models: Vec<ReceptiveField>,
}

impl LocalRegression {
    /// Of so many inputs; `prior` is told where nothing was learned.
    pub fn new(
        config: LocalRegressionConfig,
        inputs: usize,
        prior: f64,
    ) -> Result<Self, RegressionError> {
        config.check()?;
        if !prior.is_finite() {
            return Err(RegressionError::NotFinite { index: inputs });
        }
        Ok(Self {
            config,
            inputs,
            prior,
            models: Vec::new(),
        })
    }

    /// What the number is thought to be where these are the inputs.
    pub fn predict(&self, inputs: &[f64]) -> Result<Prediction, RegressionError> {
        let inputs = self.read(inputs)?;
        let (mut sum, mut support) = (self.config.doubt * self.prior, 0.0);
        for model in &self.models {
            let counts = self.counts(model, &inputs) * model.support;
            sum += counts * (self.prior + model.weights.dot(&terms(&inputs, &model.center)));
            support += counts;
        }
        Ok(Prediction {
            value: sum / (self.config.doubt + support),
            support,
        })
    }

    /// Learns what the number was where these were the inputs.
    pub fn learn(&mut self, inputs: &[f64], measured: f64) -> Result<(), RegressionError> {
        let inputs = self.read(inputs)?;
        if !measured.is_finite() {
            return Err(RegressionError::NotFinite { index: self.inputs });
        }
        let covers = |model: &ReceptiveField| self.counts(model, &inputs) > self.config.apart;
        if self.models.len() < self.config.most && !self.models.iter().any(covers) {
            let size = self.inputs + 1;
            self.models.push(ReceptiveField {
                center: inputs.clone(),
                weights: DVector::zeros(size),
                covariance: DMatrix::identity(size, size)
                    * (self.config.spread * self.config.spread),
                support: 0.0,
            });
        }
        let variance = self.config.noise * self.config.noise;
        let counts: Vec<f64> = (self.models.iter())
            .map(|model| self.counts(model, &inputs))
            .collect();
        for (model, counts) in self.models.iter_mut().zip(counts) {
            if counts < f64::EPSILON.sqrt() {
                continue;
            }
            let forgetting = self.config.forgetting;
            let terms = terms(&inputs, &model.center);
            let spread = &model.covariance * &terms;
            let gain = &spread / (forgetting * variance / counts + terms.dot(&spread));
            let missed = measured - self.prior - model.weights.dot(&terms);
            model.weights.axpy(missed, &gain, 1.0);
            let covariance = (&model.covariance - &gain * spread.transpose()) / forgetting;
            model.covariance = (&covariance + covariance.transpose()) * 0.5;
            model.support = forgetting * model.support + counts;
        }
        Ok(())
    }

    /// Number of models.
    pub const fn models(&self) -> usize {
        self.models.len()
    }

    fn read(&self, inputs: &[f64]) -> Result<DVector<f64>, RegressionError> {
        let (found, expected) = (inputs.len(), self.inputs);
        if found != expected {
            return Err(RegressionError::WrongLength { found, expected });
        }
        (inputs.iter().position(|one| !one.is_finite())).map_or_else(
            || Ok(DVector::from_column_slice(inputs)),
            |index| Err(RegressionError::NotFinite { index }),
        )
    }

    /// How much a model counts there: 1 at its centre.
    fn counts(&self, model: &ReceptiveField, inputs: &DVector<f64>) -> f64 {
        let away = (inputs - &model.center).norm_squared();
        libm::exp(-0.5 * away / (self.config.width * self.config.width))
    }
}

/// One, and how far the inputs are from the centre.
fn terms(inputs: &DVector<f64>, center: &DVector<f64>) -> DVector<f64> {
    let apart = inputs - center;
    DVector::from_iterator(
        apart.len() + 1,
        core::iter::once(1.0).chain(apart.iter().copied()),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::SplitMix64;
    use proptest::prelude::*;

    #[test]
    fn a_bent_line_is_learned_from_noisy_measurements() {
        let truth = |x: f64| if x < 0.4 { 3.0 - 5.0 * x } else { 1.0 };
        let mut random = SplitMix64::new(4);
        let mut learned = LocalRegression::new(LocalRegressionConfig::default(), 1, 0.0).unwrap();
        for _ in 0..400 {
            let x = random.uniform();
            learned
                .learn(&[x], truth(x) + random.uniform() - 0.5)
                .unwrap();
        }
        let squares: f64 = (0..100)
            .map(|at| f64::from(at) / 99.0)
            .map(|x| (learned.predict(&[x]).unwrap().value - truth(x)).powi(2))
            .sum();
        let rmse = (squares / 100.0).sqrt();
        assert!(rmse < 0.12, "{rmse}");
        assert!(learned.models() < 15);
    }

    proptest! {
        #[test]
        fn what_was_never_met_has_the_prior_and_no_support(x in 0.0..1.0f64, y in 3.0..9.0f64) {
            let mut learned = LocalRegression::new(LocalRegressionConfig::default(), 2, 7.0).unwrap();
            for _ in 0..20 {
                learned.learn(&[x, x], 1.0).unwrap();
            }
            let far = learned.predict(&[y, x]).unwrap();
            prop_assert!((far.value - 7.0).abs() < 1e-3 && far.support < 1e-3);
            let near = learned.predict(&[x, x]).unwrap();
            prop_assert!((near.value - 1.0).abs() < 0.6 && near.support > 15.0);
        }

        #[test]
        fn a_constant_is_learned_whatever_the_inputs(value in -5.0..5.0f64, seed in 0_u64..100) {
            let mut random = SplitMix64::new(seed);
            let mut learned = LocalRegression::new(LocalRegressionConfig::default(), 2, 0.0).unwrap();
            for _ in 0..300 {
                learned.learn(&[random.uniform(), random.uniform()], value).unwrap();
            }
            let told = learned.predict(&[0.5, 0.5]).unwrap().value;
            prop_assert!((told - value).abs() <= 0.12 * value.abs() + 1e-9, "{}", told);
        }
    }

    #[test]
    fn bad_inputs_are_refused_and_change_nothing() {
        let mut learned = LocalRegression::new(LocalRegressionConfig::default(), 2, 0.0).unwrap();
        let said = |error: RegressionError| error.to_string();
        assert_eq!(
            said(learned.learn(&[1.0], 1.0).unwrap_err()),
            "1 inputs, expected 2"
        );
        assert_eq!(
            said(learned.learn(&[1.0, f64::NAN], 1.0).unwrap_err()),
            "input 1 is not finite"
        );
        assert_eq!(
            said(learned.learn(&[1.0, 1.0], f64::INFINITY).unwrap_err()),
            "input 2 is not finite"
        );
        assert_eq!(learned.models(), 0);
    }
}
