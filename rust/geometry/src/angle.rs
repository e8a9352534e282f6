//! Angles in radians: wrapping and differences.

use std::f64::consts::{PI, TAU};

/// Brings an angle into (-pi, pi].
pub fn wrap_angle(angle_rad: f64) -> f64 {
    let wrapped = angle_rad.rem_euclid(TAU);
    if wrapped > PI { wrapped - TAU } else { wrapped }
}

/// The shortest turn that takes `from_rad` to `to_rad`, in (-pi, pi].
pub fn angle_between(from_rad: f64, to_rad: f64) -> f64 {
    wrap_angle(to_rad - from_rad)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn wrapping_keeps_the_direction(angle in -50.0..50.0f64) {
            let wrapped = wrap_angle(angle);
            prop_assert!(wrapped > -PI - 1e-12 && wrapped <= PI + 1e-12);
            prop_assert!((libm::sin(wrapped) - libm::sin(angle)).abs() < 1e-9);
            prop_assert!((libm::cos(wrapped) - libm::cos(angle)).abs() < 1e-9);
        }

        #[test]
        fn the_difference_leads_from_one_to_the_other(a in -10.0..10.0f64, b in -10.0..10.0f64) {
            prop_assert!(wrap_angle(a + angle_between(a, b) - b).abs() < 1e-9);
        }
    }
}
