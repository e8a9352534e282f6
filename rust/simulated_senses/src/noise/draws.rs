//! Random numbers as the cameras' errors need them, from one seeded stream each.

use geometry::SplitMix64;

/// Bits of a share of a draw.
const SHARE: u32 = 16;
/// The middle of all values that a share can have, twice.
const TWICE_MIDDLE: u32 = (1 << SHARE) - 1;
/// A draw's bytes in every second place.
const EVERY_OTHER_BYTE: u64 = 0x00FF_00FF_00FF_00FF;
/// Multiplied by it, four numbers of 16 bits have their sum in the highest.
const SUM_OF_FOUR: u64 = 0x0001_0001_0001_0001;

/// Fills two rows with independent numbers of mean 0 and standard deviation 1, spread evenly: for what is summed over a window.
pub(super) fn even(stream: &mut SplitMix64, first: &mut [f32], second: &mut [f32]) {
    let scale = over_deviation(1 << SHARE, 1);
    let centred = |bits: u64| {
        let share = (bits as u32) & TWICE_MIDDLE;
        (2 * share as i32 - TWICE_MIDDLE as i32) as f32 * scale
    };
    let (mut firsts, mut seconds) = (first.chunks_mut(2), second.chunks_mut(2));
    while let (Some(a), Some(b)) = (firsts.next(), seconds.next()) {
        let bits = stream.next_bits();
        for (i, (a, b)) in a.iter_mut().zip(b).enumerate() {
            let own = bits >> (32 * i);
            *a = centred(own);
            *b = centred(own >> SHARE);
        }
    }
}

/// Fills a row with numbers of mean 0 and standard deviation 1 whose distribution is nearly the normal one: each is a sum of the
/// eight bytes of a draw.
pub(super) fn bell(stream: &mut SplitMix64, row: &mut [f32]) {
    let scale = over_deviation(1 << 8, 8);
    for value in row {
        let bits = stream.next_bits();
        let pairs = (bits & EVERY_OTHER_BYTE) + ((bits >> 8) & EVERY_OTHER_BYTE);
        let sum = (pairs.wrapping_mul(SUM_OF_FOUR) >> 48) as i32;
        *value = (2 * sum - 8 * 255) as f32 * scale;
    }
}

/// What turns twice the sum of so many even numbers of `steps` values, about its mean, into one of deviation 1.
fn over_deviation(steps: u32, count: u32) -> f32 {
    let (steps, count, twelve) = (f64::from(steps), f64::from(count), f64::from(12_u32));
    (0.5 * (twelve / (count * (steps * steps - 1.0))).sqrt()) as f32
}

/// Two independent numbers of mean 0 and standard deviation 1, normally distributed (Box and Muller 1958).
pub(super) fn normals(stream: &mut SplitMix64) -> [f64; 2] {
    let length = (-2.0 * libm::log(1.0 - stream.uniform())).sqrt();
    let angle = std::f64::consts::TAU * stream.uniform();
    [length * libm::cos(angle), length * libm::sin(angle)]
}

/// Below which value of a standard normal the share `p` lies.
pub(super) fn quantile(p: f64) -> f64 {
    // Beyond this there is nothing that a double could tell from 0 or 1.
    let (mut low, mut high) = (-1e2_f64, 1e2_f64);
    for _ in 0..f64::MANTISSA_DIGITS + 8 {
        let middle = f64::midpoint(low, high);
        if 0.5 * libm::erfc(-middle * std::f64::consts::FRAC_1_SQRT_2) < p {
            low = middle;
        } else {
            high = middle;
        }
    }
    f64::midpoint(low, high)
}

/// Picks one in so many of a long line of things without looking at each: the gaps between are geometrically distributed.
#[derive(Debug, Clone)]
pub(super) struct Rarely {
    log_not: f64,
    gap: u64,
}

impl Rarely {
    /// Picks each with probability `share`.
    pub(super) fn new(share: f64, stream: &mut SplitMix64) -> Self {
        let mut rarely = Self {
            log_not: libm::log(1.0 - share),
            gap: 0,
        };
        rarely.gap = rarely.next_gap(stream);
        rarely
    }

    /// The next one among the `count` things from `from` on; `None`, and they are passed, where there is none.
    pub(super) fn next(
        &mut self,
        from: usize,
        count: usize,
        stream: &mut SplitMix64,
    ) -> Option<usize> {
        let left = (count - from) as u64;
        if self.gap >= left {
            self.gap -= left;
            return None;
        }
        let at = from + self.gap as usize;
        self.gap = self.next_gap(stream);
        Some(at)
    }

    fn next_gap(&self, stream: &mut SplitMix64) -> u64 {
        let gap = libm::log(1.0 - stream.uniform()) / self.log_not;
        // Never picked: 0 / 0 or infinity.
        if gap.is_finite() {
            gap as u64
        } else {
            u64::MAX
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean, deviation, skewness and kurtosis.
    fn moments(values: &[f32]) -> [f64; 4] {
        let count = values.len() as f64;
        let mean = values.iter().map(|x| f64::from(*x)).sum::<f64>() / count;
        let mut sums = [0.0; 3];
        for value in values {
            let off = f64::from(*value) - mean;
            let square = off * off;
            for (sum, power) in sums.iter_mut().zip([square, square * off, square * square]) {
                *sum += power / count;
            }
        }
        let [variance, third, fourth] = sums;
        let deviation = variance.sqrt();
        let (cube, square) = (variance * deviation, variance * variance);
        [mean, deviation, third / cube, fourth / square]
    }

    #[test]
    fn even_numbers_have_mean_0_and_deviation_1_and_two_rows_have_nothing_in_common() {
        let mut stream = SplitMix64::new(1);
        let (mut first, mut second) = (vec![0.0; 100_001], vec![0.0; 100_001]);
        even(&mut stream, &mut first, &mut second);
        for row in [&first, &second] {
            let [mean, deviation, skew, tails] = moments(row);
            assert!(mean.abs() < 0.01 && skew.abs() < 0.02);
            assert!((deviation - 1.0).abs() < 0.005);
            assert!((tails - 1.8).abs() < 0.02);
        }
        let common = |a: &[f32], b: &[f32]| {
            let all = a.iter().zip(b).map(|(a, b)| f64::from(a * b));
            all.sum::<f64>() / a.len() as f64
        };
        assert!(common(&first, &second).abs() < 0.01);
        assert!(common(&first[1..], &first[..100_000]).abs() < 0.01);
    }

    #[test]
    fn the_bells_numbers_are_nearly_normal() {
        let mut row = vec![0.0; 200_000];
        bell(&mut SplitMix64::new(2), &mut row);
        let [mean, deviation, skew, tails] = moments(&row);
        assert!(mean.abs() < 0.01 && skew.abs() < 0.02);
        assert!((deviation - 1.0).abs() < 0.005);
        assert!((tails - 2.85).abs() < 0.04, "{tails}");
        let beyond = row.iter().filter(|x| x.abs() > 2.0).count() as f64 / row.len() as f64;
        assert!((beyond - 0.0455).abs() < 0.003, "{beyond}");
    }

    #[test]
    fn quantiles_are_those_of_the_normal_distribution() {
        for (p, expected) in [
            (0.5, 0.0),
            (0.95, 1.644_853_626_951_472_2),
            (0.02, -2.053_748_910_631_823),
            (1e-12, -7.034_483_825_301_131),
        ] {
            assert!((quantile(p) - expected).abs() < 1e-9, "{p}");
        }
    }

    #[test]
    fn one_in_so_many_is_picked_and_all_or_none_where_that_is_asked() {
        let mut stream = SplitMix64::new(3);
        for (share, least, most) in [(0.01, 900, 1100), (0.0, 0, 0), (1.0, 100_000, 100_000)] {
            let mut rarely = Rarely::new(share, &mut stream);
            let mut picked = 0;
            for _ in 0..100 {
                let mut from = 0;
                while let Some(at) = rarely.next(from, 1000, &mut stream) {
                    assert!((from..1000).contains(&at));
                    from = at + 1;
                    picked += 1;
                }
            }
            assert!((least..=most).contains(&picked), "{share}: {picked}");
        }
    }
}
