//! Random numbers that are the same everywhere: splitmix64 (Steele, Lea and Flood 2014).

/// How far the counter goes for each number: 2^64 over the golden ratio, made odd.
pub const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;

/// Mixes the bits of a number: one that differs by a single bit becomes quite another.
#[inline]
pub const fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// Mixed numbers of a counter that starts at a seed.
#[derive(Debug, Clone)]
pub struct SplitMix64(u64);

impl SplitMix64 {
    /// From a seed on.
    pub const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next 64 bits.
    #[inline]
    pub const fn next_bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(GOLDEN);
        mix(self.0)
    }

    /// Uniform in 0..1, 1 excluded.
    #[inline]
    pub const fn uniform(&mut self) -> f64 {
        (self.next_bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Independent numbers of mean 0 and variance 1, by Box and Muller.
    pub fn normals<const N: usize>(&mut self) -> [f64; N] {
        let mut numbers = [0.0; N];
        for pair in numbers.chunks_mut(2) {
            // 1 - u is above 0.
            let radius = (-2.0 * libm::log(1.0 - self.uniform())).sqrt();
            let (sin, cos) = libm::sincos(core::f64::consts::TAU * self.uniform());
            for (slot, value) in pair.iter_mut().zip([radius * cos, radius * sin]) {
                *slot = value;
            }
        }
        numbers
    }
}

/// Low-variance resampling (Thrun, Burgard, Fox 2005, table 4.4): tells `drawn` the indices of `count` particles, each as often as it weighs give or
/// take one, by one random number `uniform` in 0..1. The weights sum to one; without any, nothing is drawn.
pub fn low_variance(
    weights: impl IntoIterator<Item = f64>,
    count: usize,
    uniform: f64,
    mut drawn: impl FnMut(usize),
) {
    let mut weights = weights.into_iter().fuse();
    let Some(mut sum) = weights.next() else {
        return;
    };
    let share = 1.0 / count as f64;
    let start = uniform * share;
    let mut index = 0;
    for number in 0..count {
        while start + number as f64 * share > sum {
            let Some(weight) = weights.next() else { break };
            index += 1;
            sum += weight;
        }
        drawn(index);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_are_those_of_the_published_generator() {
        // By the authors' `splitmix64.c` from the state 1234567.
        let mut numbers = SplitMix64::new(1_234_567);
        let known = [
            6_457_827_717_110_365_317,
            3_203_168_211_198_807_973,
            9_817_491_932_198_370_423,
            4_593_380_528_125_082_431,
            16_408_922_859_458_223_821,
        ];
        assert_eq!(known.map(|_| numbers.next_bits()), known);
    }

    #[test]
    fn uniform_numbers_lie_from_0_to_1_and_are_spread_evenly() {
        let mut numbers = SplitMix64::new(5);
        let mut counts = [0; 10];
        for _ in 0..10_000 {
            counts[(10.0 * numbers.uniform()) as usize] += 1;
        }
        assert!(
            counts.iter().all(|count| (900..1100).contains(count)),
            "{counts:?}"
        );
    }
}
