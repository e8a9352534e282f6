//! Parameters of the octree, and the log-odds that they mean.

use serde::{Deserialize, Serialize};
use settings::{ConfigError, require, require_positive};

/// Parameters of the octree. The defaults are OctoMap's (Hornung et al. 2013).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct OctreeConfig {
    /// Side of the smallest voxels, m.
    pub resolution: f64,
    /// P(n|z) of equation (1) of 002 for the voxel in which a beam ends.
    pub p_hit: f64,
    /// P(n|z) of a voxel that a beam passes.
    pub p_miss: f64,
    /// No beam makes a voxel less likely occupied than this,
    pub p_min: f64,
    /// nor more likely than this: what has been seen long can still change.
    pub p_max: f64,
}

impl Default for OctreeConfig {
    fn default() -> Self {
        Self {
            resolution: 0.04,
            p_hit: 0.7,
            p_miss: 0.4,
            p_min: 0.1192,
            p_max: 0.971,
        }
    }
}

impl OctreeConfig {
    /// Refuses what cannot be used, naming the key.
    pub fn check(&self) -> Result<(), ConfigError> {
        require_positive("octree.resolution", self.resolution)?;
        let scale = (1.0 / self.resolution).is_finite() && (self.resolution * 65536.0).is_finite();
        require(
            scale,
            "octree.resolution",
            "1e-300 to 1e300",
            self.resolution,
        )?;
        for (key, value) in [("octree.p_hit", self.p_hit), ("octree.p_max", self.p_max)] {
            require(
                value > 0.5 && value < 1.0,
                key,
                "above 0.5 and below 1",
                value,
            )?;
        }
        for (key, value) in [("octree.p_miss", self.p_miss), ("octree.p_min", self.p_min)] {
            require(
                value > 0.0 && value < 0.5,
                key,
                "above 0 and below 0.5",
                value,
            )?;
        }
        Ok(())
    }
}

/// Equation (1) as log-odds: a measurement adds to what was known, the prior of 0.5 adds nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Beam {
    pub(super) hit: f32,
    pub(super) miss: f32,
    pub(super) lowest: f32,
    pub(super) highest: f32,
}

impl Beam {
    pub(super) fn new(config: &OctreeConfig) -> Self {
        Self {
            hit: log_odds(config.p_hit),
            miss: log_odds(config.p_miss),
            lowest: log_odds(config.p_min),
            highest: log_odds(config.p_max),
        }
    }

    /// What is known after a hit. A value beyond the bound, from a file, stays.
    #[inline]
    pub(super) fn after_hit(&self, value: f32) -> f32 {
        (value + self.hit).min(value.max(self.highest))
    }

    /// What is known after a miss.
    #[inline]
    pub(super) fn after_miss(&self, value: f32) -> f32 {
        (value + self.miss).max(value.min(self.lowest))
    }
}

/// Log-odds in steps of 2^-20: their sums are exact in 32 bits, so that the order of measurements does not matter until a bound is
/// met, and voxels that saw the same are equal and prune.
pub(super) fn log_odds(probability: f64) -> f32 {
    const STEPS: f64 = 1_048_576.0;
    (((probability / (1.0 - probability)).ln() * STEPS).round() / STEPS) as f32
}

/// Probability of log-odds.
pub fn probability(log_odds: f32) -> f64 {
    1.0 / (1.0 + f64::from(-log_odds).exp())
}

#[cfg(test)]
mod tests {
    use super::super::super::bayes;
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn log_odds_are_the_recursion_of_equation_1(seen in proptest::collection::vec(any::<bool>(), 0..40)) {
            let beam = Beam::new(&OctreeConfig::default());
            let (mut value, mut expected) = (0.0_f32, 0.5_f64);
            let (lowest, highest) = (probability(beam.lowest), probability(beam.highest));
            for hit in seen {
                value = if hit { beam.after_hit(value) } else { beam.after_miss(value) };
                let measured = probability(if hit { beam.hit } else { beam.miss });
                expected = bayes(expected, measured, 1.0 - measured).clamp(lowest, highest);
                prop_assert!((probability(value) - expected).abs() < 1e-9);
            }
        }

        #[test]
        fn the_order_does_not_matter_between_the_bounds(hits in 0..4_usize, misses in 0..4_usize, turn in 0..8_usize) {
            let config = OctreeConfig { p_min: 0.01, p_max: 0.99, ..OctreeConfig::default() };
            let beam = Beam::new(&config);
            let mut seen = [vec![true; hits], vec![false; misses]].concat();
            let take = |seen: &[bool]| seen.iter().fold(0.0_f32, |value, &hit| {
                if hit { beam.after_hit(value) } else { beam.after_miss(value) }
            });
            let before = take(&seen);
            let count = seen.len().max(1);
            seen.rotate_left(turn % count);
            prop_assert_eq!(before.to_bits(), take(&seen).to_bits());
        }
    }

    #[test]
    fn steps_are_finer_than_anyone_knows_a_probability() {
        let beam = Beam::new(&OctreeConfig::default());
        for (found, wanted) in [
            (beam.hit, 0.7),
            (beam.miss, 0.4),
            (beam.lowest, 0.1192),
            (beam.highest, 0.971),
        ] {
            assert!((probability(found) - wanted).abs() < 2e-7);
        }
    }

    #[test]
    fn a_bad_value_is_refused_by_its_key() {
        let base = OctreeConfig::default;
        for (config, said) in [
            (
                OctreeConfig {
                    resolution: f64::NAN,
                    ..base()
                },
                "octree.resolution must be finite and > 0, got NaN",
            ),
            (
                OctreeConfig {
                    resolution: 1e-310,
                    ..base()
                },
                "octree.resolution must be 1e-300 to 1e300, got ",
            ),
            (
                OctreeConfig {
                    p_hit: 0.5,
                    ..base()
                },
                "octree.p_hit must be above 0.5 and below 1, got 0.5",
            ),
            (
                OctreeConfig {
                    p_min: 0.0,
                    ..base()
                },
                "octree.p_min must be above 0 and below 0.5, got 0",
            ),
        ] {
            let found = config.check().unwrap_err().to_string();
            assert!(found.starts_with(said), "{found}");
        }
        assert_eq!(base().check(), Ok(()));
    }
}
