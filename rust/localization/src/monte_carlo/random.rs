//! Random numbers by counter: what a particle draws depends on the seed, the step and its index, not on who drew before it, so that
//! any number of threads draws the same.

use geometry::{GOLDEN, SplitMix64, mix};

/// What numbers are drawn for; each has streams of its own.
#[derive(Debug, Clone, Copy)]
pub(super) enum Purpose {
    Start,
    Motion,
    Beams,
    Ground,
    Resampling,
    Injection,
    Jitter,
    Floor,
}

/// The numbers of one particle at one step: splitmix64 from a place that the three together say.
#[derive(Debug, Clone)]
pub(super) struct Stream(SplitMix64);

impl Stream {
    pub(super) fn new(seed: u64, step: u64, purpose: Purpose, index: usize) -> Self {
        let parts = [step, purpose as u64, index as u64];
        Self(SplitMix64::new(
            parts.iter().fold(mix(seed ^ GOLDEN), |state, &part| {
                mix(state.wrapping_add(part.wrapping_add(1).wrapping_mul(GOLDEN)))
            }),
        ))
    }

    /// Uniform in 0..1, 1 excluded.
    pub(super) fn uniform(&mut self) -> f64 {
        self.0.uniform()
    }

    /// A whole number from 0 to `count` - 1; `count` must not be 0.
    pub(super) fn below(&mut self, count: usize) -> usize {
        ((u128::from(self.0.next_bits()) * count as u128) >> 64) as usize
    }

    /// Independent numbers of mean 0 and variance 1, by Box and Muller.
    pub(super) fn normals<const N: usize>(&mut self) -> [f64; N] {
        self.0.normals()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_of_neighbours_are_independent_normals() {
        let n = 40_000;
        let draws: Vec<[f64; 3]> = (0..n)
            .map(|index| Stream::new(7, 3, Purpose::Motion, index).normals())
            .collect();
        let mean = |of: &dyn Fn(usize) -> f64| (1..n).map(of).sum::<f64>() / (n - 1) as f64;
        for a in 0..3 {
            assert!(mean(&|i| draws[i][a]).abs() < 0.02);
            assert!((mean(&|i| draws[i][a].powi(2)) - 1.0).abs() < 0.03);
            assert!((mean(&|i| draws[i][a].powi(4)) - 3.0).abs() < 0.25);
            // With the next of its own, and with the same of the particle before.
            assert!(mean(&|i| draws[i][a] * draws[i][(a + 1) % 3]).abs() < 0.02);
            assert!(mean(&|i| draws[i][a] * draws[i - 1][a]).abs() < 0.02);
        }
    }

    #[test]
    fn seed_step_purpose_and_index_each_give_another_stream() {
        let first =
            |seed, step, purpose, index| Stream::new(seed, step, purpose, index).0.next_bits();
        let base = first(1, 1, Purpose::Start, 1);
        assert_eq!(base, first(1, 1, Purpose::Start, 1));
        for other in [
            first(2, 1, Purpose::Start, 1),
            first(1, 2, Purpose::Start, 1),
            first(1, 1, Purpose::Jitter, 1),
            first(1, 1, Purpose::Start, 2),
        ] {
            assert_ne!(base, other);
        }
    }
}
