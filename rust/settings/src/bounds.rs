//! Between which values a setting may lie.

use std::fmt;

use crate::{ConfigError, require};

/// One end of what is allowed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum End {
    /// No limit but that the number is finite.
    None,
    /// Up to and with this value.
    With(f64),
    /// Up to this value, but not with it.
    Without(f64),
}

/// The values that a number may have. All are finite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The lower end.
    pub low: End,
    /// The upper end.
    pub high: End,
}

/// Any finite number; anything, of what is no number.
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

    /// Refuses a value outside, by its key.
    pub fn check(&self, key: &str, value: f64) -> Result<(), ConfigError> {
        require(self.hold(value), key, &self.to_string(), value)
    }

    /// The keywords of JSON schema that say the same.
    pub fn keywords(&self) -> Vec<(&'static str, f64)> {
        let low = match self.low {
            End::None => None,
            End::With(low) => Some(("minimum", low)),
            End::Without(low) => Some(("exclusiveMinimum", low)),
        };
        let high = match self.high {
            End::None => None,
            End::With(high) => Some(("maximum", high)),
            End::Without(high) => Some(("exclusiveMaximum", high)),
        };
        low.into_iter().chain(high).collect()
    }
}

impl fmt::Display for Bounds {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.low, self.high) {
            (End::None, End::None) => write!(to, "finite"),
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
            (ANY, -3.0, f64::INFINITY, "finite"),
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
    fn a_schema_says_the_same() {
        assert_eq!(ANY.keywords(), []);
        assert_eq!(
            above_to(0.0, 60.0).keywords(),
            [("exclusiveMinimum", 0.0), ("maximum", 60.0)]
        );
    }
}
