//! Between which values a setting may lie.

use std::fmt;

use crate::{ConfigError, require};

/// No number but 0 is nearer to it than this, where its own bounds say nothing.
pub const LEAST: f64 = 1e-9;
/// No number is further from 0 than this, where its own bounds say nothing. The square of what one such number is to another fits
/// in 32 bits: what is computed of them stays finite.
pub const LARGEST: f64 = 1e9;

/// One end of what is allowed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum End {
    /// No limit but [`LARGEST`].
    None,
    /// Up to and with this value.
    With(f64),
    /// Up to this value, but not with it.
    Without(f64),
}

/// The values that a number may have. All are 0 or from [`LEAST`] to [`LARGEST`] in size, whatever its unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The lower end.
    pub low: End,
    /// The upper end.
    pub high: End,
}

/// Any number; anything, of what is no number.
pub const ANY: Bounds = bounds(End::None, End::None);
/// Greater than 0: a length, a time, a weight.
pub const POSITIVE: Bounds = bounds(End::Without(0.0), End::None);
/// 0 or greater.
pub const NOT_NEGATIVE: Bounds = bounds(End::With(0.0), End::None);
/// From 0 to 1: a share, a weight of a mean.
pub const SHARE: Bounds = within(0.0, 1.0);

const fn bounds(low: End, high: End) -> Bounds {
    Bounds { low, high }
}

/// `low` or greater.
pub const fn at_least(low: f64) -> Bounds {
    bounds(End::With(low), End::None)
}

/// Greater than `low`.
pub const fn above(low: f64) -> Bounds {
    bounds(End::Without(low), End::None)
}

/// From `low` to `high`, with both.
pub const fn within(low: f64, high: f64) -> Bounds {
    bounds(End::With(low), End::With(high))
}

/// From `low` to `high`, with neither.
pub const fn between(low: f64, high: f64) -> Bounds {
    bounds(End::Without(low), End::Without(high))
}

/// Greater than `low`, up to and with `high`.
pub const fn above_to(low: f64, high: f64) -> Bounds {
    bounds(End::Without(low), End::With(high))
}

/// From `low` on, less than `high`.
pub const fn from_below(low: f64, high: f64) -> Bounds {
    bounds(End::With(low), End::Without(high))
}

impl Bounds {
    /// Whether a number may have this value.
    pub fn hold(&self, value: f64) -> bool {
        self.enclose(value) && self.fit(value)
    }

    /// Whether a value lies between the ends.
    fn enclose(&self, value: f64) -> bool {
        let low = match self.low {
            End::None => true,
            End::With(low) => value >= low,
            End::Without(low) => value > low,
        };
        let high = match self.high {
            End::None => true,
            End::With(high) => value <= high,
            End::Without(high) => value < high,
        };
        value.is_finite() && low && high
    }

    /// Whether a value is neither too near to 0 nor too far from it.
    fn fit(&self, value: f64) -> bool {
        // As the narrowest numbers have it: one of theirs may lie a little below.
        let seen = matches!(self.low, End::With(low) | End::Without(low) if low > 0.0)
            || value == 0.0
            || value.abs() as f32 >= LEAST as f32;
        let low = self.low != End::None || value >= -LARGEST;
        let high = self.high != End::None || value <= LARGEST;
        seen && low && high
    }

    /// Refuses a value outside, by its key; `found` is the value as it was written.
    pub fn check(
        &self,
        key: &str,
        value: f64,
        found: impl fmt::Display,
    ) -> Result<(), ConfigError> {
        let far = value.is_finite() && !(1e-6..1e15).contains(&value.abs()) && value != 0.0;
        let found = if far {
            format!("{value:e}")
        } else {
            found.to_string()
        };
        require(self.enclose(value), key, &self.to_string(), &found)?;
        let allowed = format!("{self}, and 0 or from {LEAST:e} to {LARGEST:e} in size");
        require(self.fit(value), key, &allowed, &found)
    }

    /// The keywords of JSON schema that say the same.
    pub fn keywords(&self) -> Vec<(&'static str, f64)> {
        let low = match self.low {
            End::None => ("minimum", -LARGEST),
            End::With(low) => ("minimum", low),
            End::Without(0.0) => ("minimum", LEAST),
            End::Without(low) => ("exclusiveMinimum", low),
        };
        let high = match self.high {
            End::None => ("maximum", LARGEST),
            End::With(high) => ("maximum", high),
            End::Without(high) => ("exclusiveMaximum", high),
        };
        vec![low, high]
    }
}

impl fmt::Display for Bounds {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.low, self.high) {
            (End::None, End::None) => write!(to, "any number"),
            (End::With(low), End::With(high)) => write!(to, "from {low} to {high}"),
            (low, high) => {
                match low {
                    End::None => {}
                    End::With(low) => write!(to, ">= {low}")?,
                    End::Without(low) => write!(to, "> {low}")?,
                }
                if !matches!(low, End::None) && !matches!(high, End::None) {
                    write!(to, " and ")?;
                }
                match high {
                    End::None => Ok(()),
                    End::With(high) => write!(to, "<= {high}"),
                    End::Without(high) => write!(to, "< {high}"),
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_in_or_out_as_they_say_and_nothing_is_infinite() {
        for (bounds, inside, outside, said) in [
            (ANY, -3.0, f64::INFINITY, "any number"),
            (POSITIVE, 1e-9, 0.0, "> 0"),
            (NOT_NEGATIVE, 0.0, -1e-9, ">= 0"),
            (SHARE, 1.0, 1.1, "from 0 to 1"),
            (between(0.0, 0.5), 0.4, 0.5, "> 0 and < 0.5"),
            (above_to(0.0, 60.0), 60.0, 0.0, "> 0 and <= 60"),
            (from_below(0.0, 1.5), 0.0, 1.5, ">= 0 and < 1.5"),
            (above(1.0), 1.1, 1.0, "> 1"),
            (at_least(1.0), 1.0, 0.9, ">= 1"),
        ] {
            assert!(bounds.hold(inside) && !bounds.hold(outside), "{bounds}");
            assert!(!bounds.hold(f64::NAN) && !bounds.hold(f64::NEG_INFINITY));
            assert_eq!(bounds.to_string(), said);
        }
    }

    #[test]
    fn what_is_nearly_nothing_or_beyond_all_measure_is_refused_whatever_the_bounds() {
        for bounds in [
            ANY,
            POSITIVE,
            NOT_NEGATIVE,
            SHARE,
            at_least(0.0),
            between(0.0, 0.5),
        ] {
            for value in [5e-324, 1e-300, 1e-12] {
                assert!(!bounds.hold(value), "{bounds}: {value:e}");
            }
            assert!(bounds.hold(1e-9) && bounds.hold(f64::from(1e-9_f32)));
        }
        for bounds in [ANY, POSITIVE, NOT_NEGATIVE, above(1.0)] {
            assert!(bounds.hold(1e9) && !bounds.hold(1e10) && !bounds.hold(1e308));
        }
        assert!(!ANY.hold(-1e308) && within(1e-15, 1e15).hold(1e15));
        assert!(within(1e-15, 1e15).hold(1e-12));
        let said = POSITIVE.check("a.key", 5e-324, 5e-324).unwrap_err();
        assert_eq!(
            said.to_string(),
            "a.key must be > 0, and 0 or from 1e-9 to 1e9 in size, got 5e-324"
        );
    }

    #[test]
    fn a_schema_says_the_same() {
        assert_eq!(ANY.keywords(), [("minimum", -1e9), ("maximum", 1e9)]);
        assert_eq!(
            above_to(0.0, 60.0).keywords(),
            [("minimum", 1e-9), ("maximum", 60.0)]
        );
        assert_eq!(
            above(1.0).keywords(),
            [("exclusiveMinimum", 1.0), ("maximum", 1e9)]
        );
    }
}
