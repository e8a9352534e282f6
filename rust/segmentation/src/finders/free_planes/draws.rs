//! Random numbers that are the same for the same frame.

use geometry::SplitMix64;

/// Numbers drawn for a frame.
#[derive(Debug, Clone)]
pub(crate) struct Draws(SplitMix64);

impl Draws {
    /// Seeded by what a frame shows: no clock, and no memory of the frames before it.
    pub(crate) fn of_frame(disparity_px: &[f32]) -> Self {
        let mix = |seed: u64, d: &f32| {
            (seed ^ u64::from(d.to_bits())).wrapping_mul(0x0000_0100_0000_01B3)
        };
        let seed = disparity_px.iter().fold(0xCBF2_9CE4_8422_2325, mix);
        Self(SplitMix64::new(seed))
    }

    /// A whole number from 0 to `count` - 1; `count` must not be 0.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        (self.0.next_bits() % count as u64) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_frame_gives_the_same_numbers_another_one_others() {
        let ten = |frame: &[f32]| {
            let mut draws = Draws::of_frame(frame);
            (0..10).map(|_| draws.below(1000)).collect::<Vec<_>>()
        };
        assert_eq!(ten(&[3.0, f32::NAN, 4.0]), ten(&[3.0, f32::NAN, 4.0]));
        assert_ne!(ten(&[3.0, f32::NAN, 4.0]), ten(&[3.0, 4.0, f32::NAN]));
    }

    #[test]
    fn all_numbers_below_the_count_are_drawn_alike() {
        let mut draws = Draws::of_frame(&[1.0]);
        let mut counts = [0; 7];
        for _ in 0..7000 {
            counts[draws.below(7)] += 1;
        }
        assert!(
            counts.iter().all(|count| (900..1100).contains(count)),
            "{counts:?}"
        );
    }
}
