//! Parameters of the octree, and the log-odds that they mean.

use settings::{POSITIVE, between, settings};

settings! {
    /// An octree of occupancy. The defaults are those of OctoMap (Hornung et al. 2013).
    pub struct OctreeConfig("octree") {
        /// Side of the smallest voxels.
        resolution: f64 = 0.04, "m", POSITIVE;
        /// Probability by the sensor that the voxel in which a beam ends is occupied.
        p_hit: f64 = 0.7, "1", between(0.5, 1.0), "002, equation (1): P(n|z)";
        /// Probability by the sensor that a voxel which a beam passes is occupied.
        p_miss: f64 = 0.4, "1", between(0.0, 0.5), "002, equation (1): P(n|z)";
        /// No beam makes a voxel less likely occupied than this.
        p_min: f64 = 0.1192, "1", between(0.0, 0.5), "Hornung et al. 2013, equation (4)";
        /// No beam makes a voxel more likely occupied than this: what has been seen long can still change.
        p_max: f64 = 0.971, "1", between(0.5, 1.0), "Hornung et al. 2013, equation (4)";
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
    // Exact in the 24 bits of a number with 32: sums stay below 16.
    const STEPS: f64 = 1_048_576.0;
    ((libm::log(probability / (1.0 - probability)) * STEPS).round() / STEPS) as f32
}

/// Probability of log-odds.
pub fn probability(log_odds: f32) -> f64 {
    1.0 / (1.0 + libm::exp(f64::from(-log_odds)))
}

#[cfg(test)]
mod tests {
    use super::super::super::bayes;
    use super::*;
    use proptest::prelude::*;
    use settings::Table;

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
                "octree.resolution must be > 0, got NaN",
            ),
            (
                OctreeConfig {
                    resolution: 1e-310,
                    ..base()
                },
                "octree.resolution must be > 0, and 0 or from 1e-9 to 1e9 in size, got 1e-310",
            ),
            (
                OctreeConfig {
                    p_hit: 0.5,
                    ..base()
                },
                "octree.p_hit must be > 0.5 and < 1, got 0.5",
            ),
            (
                OctreeConfig {
                    p_min: 0.0,
                    ..base()
                },
                "octree.p_min must be > 0 and < 0.5, got 0",
            ),
        ] {
            let found = config.check().unwrap_err().to_string();
            assert!(found.starts_with(said), "{found}");
        }
        assert_eq!(base().check(), Ok(()));
    }
}
