//! Equation (9) of 000: what a height that is seen makes of one that is known.

/// There is no floor height: below every height.
pub const INVALID: f32 = f32::NEG_INFINITY;

/// Equation (9): the height to keep where `stored` is known and `measured` is seen.
pub fn merge_height(stored: f32, measured: f32, epsilon: f32, nu: f32) -> f32 {
    if measured < stored - epsilon {
        stored
    } else if measured > stored + epsilon {
        measured
    } else {
        nu * stored + (1.0 - nu) * measured
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EPSILON: f32 = 0.015;
    const NU: f32 = 0.9;

    #[test]
    fn a_lower_height_is_ignored() {
        assert_eq!(merge_height(0.1, 0.08, EPSILON, NU), 0.1);
    }

    #[test]
    fn a_higher_height_replaces() {
        assert_eq!(merge_height(0.1, 0.12, EPSILON, NU), 0.12);
    }

    #[test]
    fn a_height_of_the_same_surface_is_smoothed() {
        assert!((merge_height(0.1, 0.11, EPSILON, NU) - 0.101).abs() < 1e-7);
    }

    #[test]
    fn an_invalid_height_lies_below_every_height() {
        assert_eq!(merge_height(INVALID, -5.0, EPSILON, NU), -5.0);
    }
}
