//! A classifier that is trained: how likely each class is, by logistic regression on features, their squares and products.

use nalgebra::{DMatrix, DVector};
use settings::{ConfigError, POSITIVE, Table, at_least, settings};

settings! {
    /// How classes are learned from examples.
    pub struct TrainedConfig("classification.trained") {
        /// Price of the squares of the weights, for each example: what few examples cannot say stays at 0.
        ridge: f64 = 1e-4, "1", POSITIVE, "le Cessie and van Houwelingen 1992, equation (1)";
        /// Newton steps for each class.
        steps: usize = 12, "1", at_least(1.0);
    }
}

/// Examples that nothing can be learned from.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TrainingError {
    /// No settings to learn with.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// Examples and labels that do not belong together, or of several lengths.
    #[error("example {index} has {found} features, expected {expected}")]
    WrongLength {
        /// Which example.
        index: usize,
        /// How many it has.
        found: usize,
        /// How many it should have.
        expected: usize,
    },
    /// A feature that is no number.
    #[error("example {index} has a feature that is not finite")]
    NotFinite {
        /// Which example.
        index: usize,
    },
    /// Features whose squares are no numbers.
    #[error("the features of class {class} are too large")]
    TooLarge {
        /// Which class.
        class: usize,
    },
    /// A class without enough examples.
    #[error("class {class} has {found} examples, at least 2 are needed")]
    TooFew {
        /// Which class.
        class: usize,
        /// How many it has.
        found: usize,
    },
}

/// Classes that are told by logistic regression, each against the rest: handbook, section 36.3.5, "train the classifier on training
/// data". The same examples in the same order give the same classifier, to the bit.
#[derive(Debug, Clone)]
pub struct TrainedClasses {
    /// Mean of each feature over the examples, and one over its standard deviation.
    scales: Vec<[f64; 2]>,
    weights: Vec<DVector<f64>>,
}

impl TrainedClasses {
    /// Learns from examples: a row of features each, and its class from 0 to `classes`.
    pub fn train(
        config: &TrainedConfig,
        examples: &[(Vec<f64>, usize)],
        classes: usize,
    ) -> Result<Self, TrainingError> {
        config.check()?;
        let expected = examples.first().map_or(0, |(features, _)| features.len());
        let mut counts = vec![0; classes];
        for (index, (features, class)) in examples.iter().enumerate() {
            let found = features.len();
            if found != expected {
                return Err(TrainingError::WrongLength {
                    index,
                    found,
                    expected,
                });
            }
            if !features.iter().all(|value| value.is_finite()) {
                return Err(TrainingError::NotFinite { index });
            }
            if let Some(count) = counts.get_mut(*class) {
                *count += 1;
            }
        }
        if let Some(class) = counts.iter().position(|count| *count < 2) {
            let found = counts[class];
            return Err(TrainingError::TooFew { class, found });
        }
        let scales = scales(examples, expected);
        let rows: Vec<_> = (examples.iter())
            .map(|(features, _)| terms(&scales, features))
            .collect();
        let weights = (0..classes).map(|class| {
            let is_of = |index: usize| examples[index].1 == class;
            fitted(config, &rows, is_of).ok_or(TrainingError::TooLarge { class })
        });
        let weights = weights.collect::<Result<_, _>>()?;
        Ok(Self { scales, weights })
    }

    /// What was learned, as text: a line of means, one of scales, and one of weights for each class; seven digits of each number.
    pub fn text(&self) -> String {
        let line = |values: &mut dyn Iterator<Item = f64>| {
            let numbers: Vec<String> = values.map(|value| format!("{value:.6e}")).collect();
            numbers.join(" ") + "\n"
        };
        let mut text = line(&mut self.scales.iter().map(|[mean, _]| *mean));
        text += &line(&mut self.scales.iter().map(|[_, scale]| *scale));
        for weights in &self.weights {
            text += &line(&mut weights.iter().copied());
        }
        text
    }

    /// What was learned before, from its text; none where that is of other classes or features.
    pub fn of_text(text: &str, classes: usize, features: usize) -> Option<Self> {
        let rows = text.lines().map(|line| {
            let numbers = line.split_whitespace().map(|word| word.parse().ok());
            let finite = numbers.map(|number: Option<f64>| number.filter(|one| one.is_finite()));
            finite.collect::<Option<Vec<f64>>>()
        });
        let rows = rows.collect::<Option<Vec<_>>>()?;
        let [means, scales, weights @ ..] = rows.as_slice() else {
            return None;
        };
        let terms = 1 + features + features * (features + 1) / 2;
        let fits = means.len() == features && scales.len() == features && weights.len() == classes;
        (fits && weights.iter().all(|row| row.len() == terms)).then(|| Self {
            scales: means
                .iter()
                .zip(scales)
                .map(|(mean, scale)| [*mean, *scale])
                .collect(),
            weights: weights
                .iter()
                .map(|row| DVector::from_column_slice(row))
                .collect(),
        })
    }

    /// The cost of each class: the negative logarithm of its probability. For [`crate::MarkovField`] as it is.
    pub fn costs(&self, features: &[f64]) -> Vec<f64> {
        let terms = terms(&self.scales, features);
        let odds = self
            .weights
            .iter()
            .map(|weights| logistic(weights.dot(&terms)));
        let odds: Vec<f64> = odds.map(|odds| odds.max(f64::MIN_POSITIVE)).collect();
        let sum: f64 = odds.iter().sum();
        odds.iter().map(|odds| -libm::log(odds / sum)).collect()
    }

    /// The likeliest class.
    pub fn classify(&self, features: &[f64]) -> usize {
        let costs = self.costs(features);
        let better = |a: usize, b: usize| if costs[b] < costs[a] { b } else { a };
        (0..costs.len()).reduce(better).unwrap_or(0)
    }
}

fn logistic(value: f64) -> f64 {
    1.0 / (1.0 + libm::exp(-value))
}

/// Mean of each feature, and one over its standard deviation; 0 where it is the same in all.
fn scales(examples: &[(Vec<f64>, usize)], size: usize) -> Vec<[f64; 2]> {
    let count = examples.len() as f64;
    let of = |feature: usize| {
        let values = || examples.iter().map(|(features, _)| features[feature]);
        let mean = values().sum::<f64>() / count;
        let squares: f64 = values().map(|value| (value - mean) * (value - mean)).sum();
        let sigma = (squares / count).sqrt();
        [mean, if sigma > 0.0 { 1.0 / sigma } else { 0.0 }]
    };
    (0..size).map(of).collect()
}

/// One, the features, their squares and products.
fn terms(scales: &[[f64; 2]], features: &[f64]) -> DVector<f64> {
    let scaled = scales.iter().zip(features);
    let scaled: Vec<f64> = scaled
        .map(|([mean, scale], value)| (value - mean) * scale)
        .collect();
    let mut terms = vec![1.0];
    for (at, one) in scaled.iter().enumerate() {
        terms.push(*one);
        terms.extend(scaled[at..].iter().map(|other| one * other));
    }
    DVector::from_vec(terms)
}

/// The weights at which the examples are likeliest, less the price of the weights; `None` where numbers are too large.
fn fitted(
    config: &TrainedConfig,
    rows: &[DVector<f64>],
    is_of: impl Fn(usize) -> bool,
) -> Option<DVector<f64>> {
    let size = rows[0].len();
    let price = config.ridge * rows.len() as f64;
    let mut weights = DVector::zeros(size);
    for _ in 0..config.steps {
        let mut slope = &weights * price;
        let mut curve = DMatrix::identity(size, size) * price;
        for (index, row) in rows.iter().enumerate() {
            let odds = logistic(weights.dot(row));
            slope.axpy(odds - f64::from(u8::from(is_of(index))), row, 1.0);
            curve.ger(odds * (1.0 - odds), row, row, 1.0);
        }
        weights -= curve.cholesky()?.solve(&slope);
    }
    weights
        .iter()
        .all(|weight| weight.is_finite())
        .then_some(weights)
}

#[cfg(test)]
mod tests;
