//! The Gaussian that beams and heights are judged by, for eight guesses at once.

use volume::Lanes;

/// Beyond so many standard deviations a Gaussian is nothing: 2e-8 of its peak, less than single precision tells apart. Up to here the
/// series below is good to a hundred-thousandth.
pub(super) const NO_SIGMAS: f64 = 6.0;
/// Coefficients of the exponential function's series, the highest first.
const SERIES: [f32; 8] = [
    1.0 / 5040.0,
    1.0 / 720.0,
    1.0 / 120.0,
    1.0 / 24.0,
    1.0 / 6.0,
    0.5,
    1.0,
    1.0,
];

#[inline]
pub(super) fn splat(value: f64) -> Lanes {
    Lanes::splat(value as f32)
}

/// `exp(-u^2 / 2)`, to a hundred-thousandth of it: 0 beyond what counts, infinity included.
#[inline]
pub(super) fn gauss(sigmas: Lanes) -> Lanes {
    let sigmas = sigmas.abs();
    let counts = sigmas.simd_lt(splat(NO_SIGMAS));
    if !counts.any() {
        return Lanes::ZERO;
    }
    let sigmas = counts & sigmas;
    // The 32nd root of it by its series, which is short for so small an exponent.
    let exponent = sigmas * sigmas * Lanes::splat(-0.5 / 32.0);
    let root = SERIES.iter().fold(Lanes::ZERO, |sum, &term| {
        sum * exponent + Lanes::splat(term)
    });
    let mut power = root;
    for _ in 0..5 {
        power *= power;
    }
    counts & power
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gaussian_is_one_as_far_as_it_counts() {
        for step in 0..70 {
            let sigmas = 0.2 * f64::from(step) - 6.5;
            let found = f64::from(gauss(splat(sigmas)).to_array()[0]);
            let expected = if sigmas.abs() < NO_SIGMAS {
                libm::exp(-0.5 * sigmas * sigmas)
            } else {
                0.0
            };
            assert!(
                (found - expected).abs() <= 2e-5 * expected,
                "{sigmas}: {found} {expected}"
            );
        }
        assert_eq!(gauss(splat(f64::INFINITY)), Lanes::ZERO);
    }
}
