//! Where a ray meets a quadric: a + 2 b w + c w^2 = 0 for the nearness w = 1 / depth.

/// The meetings of a ray with a round surface whose equation at the eye is `c`: above 0 outside of it, below within.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Round {
    c: f64,
    over_c: f64,
}

impl Round {
    pub(crate) fn new(c: f64) -> Self {
        Self { c, over_c: 1.0 / c }
    }

    /// Whether the eye is outside of the surface.
    pub(crate) fn is_before(&self) -> bool {
        self.c > 0.0
    }

    /// How near a ray enters the surface from outside, and how near it leaves it; no numbers where it misses it.
    #[inline]
    pub(crate) fn through(&self, a: f64, b: f64) -> (f64, f64) {
        let root = (b * b - a * self.c).sqrt();
        ((root - b) * self.over_c, (-root - b) * self.over_c)
    }

    /// How near a ray leaves the surface from within.
    #[inline]
    pub(crate) fn leave(&self, a: f64, b: f64) -> f64 {
        let root = (b * b - a * self.c).sqrt();
        // Of the two forms of the solution the one whose terms do not cancel.
        if b < 0.0 {
            a / (root - b)
        } else {
            (-root - b) * self.over_c
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_from_outside_enters_and_leaves_and_one_that_leads_away_does_neither() {
        // A unit sphere, three metres before the eye: 1 - 3 w = +-w at 1/2 and 1/4.
        let round = Round::new(8.0);
        assert!(round.is_before());
        assert_eq!(round.through(1.0, -3.0), (0.5, 0.25));
        assert!(round.through(1.0, 3.0).0 < 0.0);
        assert!(round.through(1.0, 0.0).0.is_nan());
    }

    #[test]
    fn a_ray_from_within_leaves_at_the_far_side_and_loses_no_digits() {
        // From 1e-9 m under the surface of a unit sphere, outwards and right through it.
        let depth = 1e-9;
        let round = Round::new((1.0 - depth) * (1.0 - depth) - 1.0);
        assert!(!round.is_before());
        assert!((1.0 / round.leave(1.0, 1.0 - depth) / depth - 1.0).abs() < 1e-6);
        assert!((1.0 / round.leave(1.0, depth - 1.0) - 2.0).abs() < 1e-8);
    }
}
