//! Labels along a way, by a hidden Markov model: what lies ahead of and behind a place says what it is.

use settings::{ConfigError, Table, between, settings};

settings! {
    /// How labels go on along a way.
    pub struct MarkovChainConfig("classification.markov_chain") {
        /// Probability that the next place of a way is of the same class.
        stay: f64 = 0.9, "1", between(0.0, 1.0), "Wolf, Sukhatme, Fox and Burgard 2005, section III";
    }
}

/// A chain that says nothing, or likelihoods that do not fit one.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ChainError {
    /// Probabilities that are negative, no numbers, or do not add up to 1.
    #[error("{what} must be probabilities that add up to 1, got {found:?}")]
    NotProbabilities {
        /// Which.
        what: &'static str,
        /// What was given.
        found: Vec<f64>,
    },
    /// A step with another number of classes than the chain.
    #[error("step {step} has {found} likelihoods, the chain has {expected} classes")]
    WrongCount {
        /// Which step, from 0 on.
        step: usize,
        /// How many there are.
        found: usize,
        /// How many there should be.
        expected: usize,
    },
    /// No class can be where it must be.
    #[error("step {step} cannot be: every class has the likelihood 0 there")]
    Impossible {
        /// Which step, from 0 on.
        step: usize,
    },
}

/// A hidden Markov model of the classes along a way: handbook, section 36.3.5 (Rabiner 1989; for terrain Wolf et al., ICRA 2005).
#[derive(Debug, Clone, PartialEq)]
pub struct MarkovChain {
    initial: Vec<f64>,
    transition: Vec<Vec<f64>>,
}

impl MarkovChain {
    /// With the probability of each class at the first step, and from each class (row) to each other at the next one (column).
    pub fn new(initial: Vec<f64>, transition: Vec<Vec<f64>>) -> Result<Self, ChainError> {
        let fit = |what, row: &[f64]| {
            let right = row.len() == initial.len()
                && row.iter().all(|share| (0.0..=1.0).contains(share))
                && (row.iter().sum::<f64>() - 1.0).abs() < 1e-9;
            let found = row.to_vec();
            right
                .then_some(())
                .ok_or(ChainError::NotProbabilities { what, found })
        };
        fit("those of the first step", &initial)?;
        for row in &transition {
            fit("those of a transition", row)?;
        }
        if transition.len() != initial.len() {
            let found = vec![transition.len() as f64];
            return Err(ChainError::NotProbabilities {
                what: "a row for each class",
                found,
            });
        }
        Ok(Self {
            initial,
            transition,
        })
    }

    /// Of classes that are equally likely and stay as the settings say.
    pub fn sticky(config: &MarkovChainConfig, classes: usize) -> Result<Self, ConfigError> {
        config.check()?;
        let count = classes.max(1);
        let go = (1.0 - config.stay) / (count.max(2) - 1) as f64;
        let row = |from: usize| {
            let of = |to| if to == from { config.stay } else { go };
            if count == 1 {
                vec![1.0]
            } else {
                (0..count).map(of).collect()
            }
        };
        Ok(Self {
            initial: vec![1.0 / count as f64; count],
            transition: (0..count).map(row).collect(),
        })
    }

    /// The probability of each class at each step, given what was measured at all steps: forward and backward. `likelihoods` has for
    /// each step how likely the measurement is in each class, up to a factor.
    pub fn beliefs(&self, likelihoods: &[Vec<f64>]) -> Result<Vec<Vec<f64>>, ChainError> {
        self.fit(likelihoods)?;
        let mut forward: Vec<Vec<f64>> = Vec::new();
        for (step, seen) in likelihoods.iter().enumerate() {
            let prior = forward
                .last()
                .map_or_else(|| self.initial.clone(), |last| self.ahead(last));
            let joint = prior
                .iter()
                .zip(seen)
                .map(|(prior, seen)| prior * seen)
                .collect();
            forward.push(normalized(joint).ok_or(ChainError::Impossible { step })?);
        }
        let mut backward = vec![1.0; self.initial.len()];
        for step in (0..forward.len()).rev() {
            let joint = forward[step]
                .iter()
                .zip(&backward)
                .map(|(a, b)| a * b)
                .collect();
            forward[step] = normalized(joint).ok_or(ChainError::Impossible { step })?;
            let weighed: Vec<f64> = backward
                .iter()
                .zip(&likelihoods[step])
                .map(|(later, seen)| later * seen)
                .collect();
            let earlier = self
                .transition
                .iter()
                .map(|row| row.iter().zip(&weighed).map(|(go, later)| go * later).sum());
            backward = normalized(earlier.collect()).ok_or(ChainError::Impossible { step })?;
        }
        Ok(forward)
    }

    /// The one course of classes that is most likely as a whole (Viterbi 1967); of equals the lowest class.
    pub fn most_likely(&self, likelihoods: &[Vec<f64>]) -> Result<Vec<usize>, ChainError> {
        self.fit(likelihoods)?;
        let classes = self.initial.len();
        let mut best: Vec<f64> = Vec::new();
        let mut came_from: Vec<Vec<usize>> = Vec::new();
        for (step, seen) in likelihoods.iter().enumerate() {
            let arrive = |class: usize| -> (usize, f64) {
                if step == 0 {
                    return (0, libm::log(self.initial[class]));
                }
                let ways = (0..classes)
                    .map(|from| (from, best[from] + libm::log(self.transition[from][class])));
                ways.reduce(|a, b| if b.1 > a.1 { b } else { a })
                    .unwrap_or((0, f64::NEG_INFINITY))
            };
            let arrived: Vec<_> = (0..classes).map(arrive).collect();
            best = (arrived.iter().zip(seen))
                .map(|((_, log), seen)| log + libm::log(*seen))
                .collect();
            came_from.push(arrived.into_iter().map(|(from, _)| from).collect());
            if best.iter().all(|log| *log == f64::NEG_INFINITY) {
                return Err(ChainError::Impossible { step });
            }
        }
        let last = (0..best.len()).reduce(|a, b| if best[b] > best[a] { b } else { a });
        let mut course: Vec<usize> = last.into_iter().collect();
        for from in came_from.iter().skip(1).rev() {
            course.push(from[course[course.len() - 1]]);
        }
        course.reverse();
        course.truncate(likelihoods.len());
        Ok(course)
    }

    /// The probability of each class one step on.
    fn ahead(&self, now: &[f64]) -> Vec<f64> {
        let to = |class: usize| {
            now.iter()
                .zip(&self.transition)
                .map(|(p, row)| p * row[class])
                .sum()
        };
        (0..now.len()).map(to).collect()
    }

    fn fit(&self, likelihoods: &[Vec<f64>]) -> Result<(), ChainError> {
        let expected = self.initial.len();
        for (step, seen) in likelihoods.iter().enumerate() {
            if seen.len() != expected {
                let found = seen.len();
                return Err(ChainError::WrongCount {
                    step,
                    found,
                    expected,
                });
            }
            if !seen.iter().all(|value| value.is_finite() && *value >= 0.0) {
                return Err(ChainError::Impossible { step });
            }
        }
        Ok(())
    }
}

/// Shares of one, `None` where all are 0.
fn normalized(mut values: Vec<f64>) -> Option<Vec<f64>> {
    let sum: f64 = values.iter().sum();
    for value in &mut values {
        *value /= sum;
    }
    (sum > 0.0 && sum.is_finite()).then_some(values)
}

#[cfg(test)]
mod tests;
