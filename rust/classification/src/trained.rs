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
mod tests {
    use super::*;
    use crate::moments::tests::{accuracy as of_points, scene};
    use crate::slope_statistics::tests::{CELL_M, accuracy as of_cells, site};
    use crate::synthetic::Noise;
    use crate::{MomentsConfig, PointClass, PointClasses, SlopeStatistics, SlopeStatisticsConfig};

    fn trained(examples: &[(Vec<f64>, usize)], classes: usize) -> TrainedClasses {
        TrainedClasses::train(&TrainedConfig::default(), examples, classes).unwrap()
    }

    #[test]
    fn trained_on_other_sites_obstacles_are_told_as_well_as_by_limits_and_better_in_noise() {
        let statistics = SlopeStatistics::new(SlopeStatisticsConfig::default()).unwrap();
        for (noise_m, margin) in [(0.005, 0.0), (0.015, 0.02)] {
            let mut examples = Vec::new();
            for seed in 100..110 {
                let (heights_m, truth) = site(seed, noise_m);
                let all = statistics.statistics(&heights_m, CELL_M);
                // As many of each kind: the accuracy counts both alike.
                let mut pick = Noise::new(seed);
                let obstacles = truth.iter().filter(|obstacle| **obstacle).count() as f64;
                let share = obstacles / (truth.len() as f64 - obstacles);
                for (one, obstacle) in all.values().iter().zip(truth) {
                    if let Some(one) = one
                        && (obstacle || pick.within(0.0, 1.0) < share)
                    {
                        examples.push((statistics.features(one), usize::from(obstacle)));
                    }
                }
            }
            let trained = trained(&examples, 2);
            let (mut by_limits, mut by_training) = (0.0, 0.0);
            for seed in 0..20 {
                let (heights_m, truth) = site(seed, noise_m);
                let all = statistics.statistics(&heights_m, CELL_M);
                let found: Vec<_> = (all.values().iter())
                    .map(|one| one.map(|one| trained.classify(&statistics.features(&one)) == 1))
                    .collect();
                by_training += of_cells(&found, &truth) / 20.0;
                by_limits +=
                    of_cells(statistics.obstacles(&heights_m, CELL_M).values(), &truth) / 20.0;
            }
            assert!(
                by_training >= by_limits + margin,
                "{noise_m} m: {by_training:.3} {by_limits:.3}"
            );
            assert!(by_training > 0.85, "{noise_m} m: {by_training:.3}");
        }
    }

    #[test]
    fn trained_on_other_clouds_points_are_told_as_well_as_by_their_saliency() {
        let classes = PointClasses::new(MomentsConfig::default()).unwrap();
        let told = [PointClass::Scatter, PointClass::Linear, PointClass::Surface];
        let features = |cloud: &[crate::Point3]| -> Vec<Vec<f64>> {
            let all = classes.saliencies(cloud).unwrap();
            all.iter()
                .map(|one| one.map_or(vec![0.0; 2], |one| vec![one.scatter, one.linear]))
                .collect()
        };
        let mut examples = Vec::new();
        for seed in 200..204 {
            let (points, truth) = scene(seed, 0.2);
            let labels = truth.iter().map(|class| *class as usize - 1);
            examples.extend(features(&points).into_iter().zip(labels));
        }
        let trained = trained(&examples, 3);
        let (mut by_saliency, mut by_training) = (0.0, 0.0);
        for seed in 0..20 {
            let (points, truth) = scene(seed, 0.2);
            let found: Vec<_> = (features(&points).iter())
                .map(|features| told[trained.classify(features)])
                .collect();
            by_training += of_points(&found, &truth) / 20.0;
            by_saliency += of_points(&classes.classify(&points).unwrap(), &truth) / 20.0;
        }
        assert!(
            by_training >= by_saliency,
            "{by_training:.4} {by_saliency:.4}"
        );
    }

    #[test]
    fn of_two_like_classes_the_border_lies_where_they_are_equally_likely() {
        let mut noise = Noise::new(3);
        let examples: Vec<_> = (0..4000)
            .map(|index| {
                (
                    vec![(index % 2) as f64 * 4.0 + noise.normal(1.0)],
                    index % 2,
                )
            })
            .collect();
        let trained = trained(&examples, 2);
        let border = (0..400)
            .map(|at| f64::from(at) * 0.01)
            .find(|at| trained.classify(&[*at]) == 1);
        assert!((border.unwrap() - 2.0).abs() < 0.15, "{border:?}");
        // Twice the same, to the bit.
        let again = super::tests::trained(&examples, 2);
        assert_eq!(trained.costs(&[1.7]), again.costs(&[1.7]));
    }

    #[test]
    fn what_cannot_be_learned_from_is_refused() {
        let said = |examples: &[(Vec<f64>, usize)]| {
            TrainedClasses::train(&TrainedConfig::default(), examples, 2)
                .unwrap_err()
                .to_string()
        };
        assert_eq!(said(&[]), "class 0 has 0 examples, at least 2 are needed");
        let uneven = said(&[(vec![1.0], 0), (vec![1.0, 2.0], 1)]);
        assert_eq!(uneven, "example 1 has 2 features, expected 1");
        assert_eq!(
            said(&[(vec![f64::NAN], 0)]),
            "example 0 has a feature that is not finite"
        );
    }
}
