//! By how many pixels a border is seen off its place.

/// A border is not looked for where it is seen less often.
const NEVER: f64 = 1e-9;

/// Normally distributed shifts by whole pixels.
#[derive(Debug, Clone)]
pub(super) struct Wandering {
    /// The largest one, px.
    reach: usize,
    /// A draw above so many of these is so many pixels more than the least one.
    above: Vec<u32>,
}

impl Wandering {
    pub(super) fn new(deviation_px: f64) -> Self {
        let beyond = |place_px: f64| {
            0.5 * libm::erfc(place_px / deviation_px * std::f64::consts::FRAC_1_SQRT_2)
        };
        let mut reach = 0;
        while deviation_px > 0.0 && 2.0 * beyond(f64::from(reach) + 0.5) > NEVER {
            reach += 1;
        }
        let draws = f64::from(u32::MAX);
        let below = |shift: i32| draws * (1.0 - beyond(f64::from(shift) + 0.5));
        Self {
            reach: reach as usize,
            above: (-reach..reach).map(|shift| below(shift) as u32).collect(),
        }
    }

    /// The largest shift, px.
    pub(super) const fn reach(&self) -> usize {
        self.reach
    }

    /// Which pixel, of `count`, is seen in the place of this one, by a draw of any 32 bits.
    pub(super) fn seen(&self, pixel: usize, draw: u32, count: usize) -> usize {
        let above = self.above.iter().filter(|border| draw > **border).count();
        (pixel + above).saturating_sub(self.reach).min(count - 1)
    }
}

#[cfg(test)]
mod tests {
    use geometry::SplitMix64;

    use super::*;

    #[test]
    fn shifts_are_rounded_normal_numbers_and_stay_in_the_picture() {
        let wandering = Wandering::new(0.4);
        assert_eq!(wandering.reach(), 2);
        let mut stream = SplitMix64::new(1);
        let mut counts = [0; 5];
        for _ in 0..100_000 {
            counts[wandering.seen(12, stream.next_bits() as u32, 100) - 10] += 1;
        }
        // P(|x| > 0.5 / 0.4) = 0.2113, P(|x| > 1.5 / 0.4) = 0.00018.
        assert!((counts[2] - 78_870_i32).abs() < 400, "{counts:?}");
        assert!((counts[1] - counts[3]).abs() < 500, "{counts:?}");
        assert!((5..40).contains(&(counts[0] + counts[4])), "{counts:?}");
        assert_eq!(wandering.seen(0, 0, 100), 0);
        assert_eq!(wandering.seen(99, u32::MAX, 100), 99);
    }

    #[test]
    fn without_a_deviation_nothing_wanders() {
        let still = Wandering::new(0.0);
        assert_eq!(still.reach(), 0);
        assert_eq!(still.seen(7, 123, 100), 7);
    }
}
