//! Whether two heights are one level: the one place that asks it. Who asks says how much they may differ.

/// A height, or a difference of heights.
pub trait Height: Copy {
    /// How far two heights lie apart, compared with a tolerance: at most that, or more. What is no number is neither.
    fn apart(self, other: Self, tolerance: Self) -> Option<Apart>;
}

/// How far two heights lie apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Apart {
    /// By no more than the tolerance.
    Within,
    /// By more than it.
    Beyond,
}

macro_rules! heights {
    ($($number:ty),*) => {$(
        impl Height for $number {
            #[inline]
            fn apart(self, other: Self, tolerance: Self) -> Option<Apart> {
                let apart = (self - other).abs();
                if apart <= tolerance {
                    Some(Apart::Within)
                } else if apart > tolerance {
                    Some(Apart::Beyond)
                } else {
                    None
                }
            }
        }
    )*};
}

heights!(f32, f64);

/// Whether two heights are known and differ by no more than a tolerance, m: they are one level.
#[inline]
pub fn same_level<T: Height>(a_m: T, b_m: T, tolerance_m: T) -> bool {
    a_m.apart(b_m, tolerance_m) == Some(Apart::Within)
}

/// Whether two heights are known and differ by more than a tolerance, m: they are two levels.
#[inline]
pub fn two_levels<T: Height>(a_m: T, b_m: T, tolerance_m: T) -> bool {
    a_m.apart(b_m, tolerance_m) == Some(Apart::Beyond)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tolerance_belongs_to_the_level_and_the_unknown_to_none() {
        assert!(same_level(0.5, 0.75, 0.25) && !two_levels(0.5, 0.75, 0.25));
        assert!(two_levels(0.5_f32, 0.0, 0.25) && !same_level(0.5_f32, 0.0, 0.25));
        assert!(!same_level(f64::NAN, 0.0, 1.0) && !two_levels(f64::NAN, 0.0, 1.0));
    }
}
