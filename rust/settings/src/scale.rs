//! How a default follows from the robot's size, by its unit.
//!
//! Robots that are alike move alike at equal Froude numbers: with lengths `s` times as large, times and speeds are `sqrt(s)` times
//! as large, rates `1/sqrt(s)` times, and accelerations the same; forces go with the mass. What a unit has of length, time and force
//! therefore says what becomes of a default; a count of frames that stands for a time follows as a time does, and the camera's period.
//! What is not the robot's own says so where it is declared, by its [`Owner`].

use serde_json::{Map, Number, Value, json};

use crate::{Owner, Parameter};

/// Tables that are read for a robot. The others are for data of whatever sensor.
const OF_ROBOTS: [&str; 4] = [
    "navigation.",
    "gait.",
    "costs.limits.",
    "costs.traversability.",
];

/// Of a count of frames that stands for a time.
const FRAMES: &str = "frames";

/// Of a camera's noise that grows with the square of the range: it goes with focal length and baseline.
const RANGE_NOISE: &str = "1/m";

/// How large a robot is against the one whose numbers the defaults are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// Its lengths over that one's.
    pub length: f64,
    /// Its mass over that one's.
    pub mass: f64,
    /// By how many pixels its camera's two views differ at a range, over that one's: focal length times baseline.
    pub disparity: f64,
    /// The time between two of its camera's frames over that one's.
    pub period: f64,
}

/// Dimensions of a unit: quarters of the power of lengths, by which times are half as much, and the powers of masses and of a camera's
/// period.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Power {
    quarters: i32,
    mass: i32,
    period: i32,
}

impl Scale {
    /// The size of the robot whose numbers the defaults are.
    pub const ONE: Self = Self {
        length: 1.0,
        mass: 1.0,
        disparity: 1.0,
        period: 1.0,
    };

    /// What a number with this unit is multiplied by; `None` for a unit that is not known.
    pub fn factor(&self, unit: &str) -> Option<f64> {
        let power = power(unit)?;
        let root = self.length.sqrt();
        let mut factor = whole_power(self.length, power.quarters.div_euclid(4));
        let rest = power.quarters.rem_euclid(4);
        if rest >= 2 {
            factor *= root;
        }
        if rest % 2 == 1 {
            factor *= root.sqrt();
        }
        Some(factor * whole_power(self.mass, power.mass) * whole_power(self.period, power.period))
    }

    /// The default of a setting at this size; `None` where it is the same at any.
    pub fn default_of(&self, parameter: &Parameter) -> Option<Value> {
        let default = &parameter.default;
        if *self == Self::ONE {
            None
        } else if parameter.scales {
            Some(self.scaled(default, parameter.unit))
        } else if parameter.owner == Some(Owner::Camera) && parameter.unit == RANGE_NOISE {
            Some(json!(default.as_f64().map(|noise| noise / self.disparity)))
        } else {
            None
        }
    }

    /// A value, or each of a list's with its part of the unit, at this size.
    fn scaled(&self, value: &Value, unit: &str) -> Value {
        match value {
            Value::Array(values) => {
                let units: Vec<_> = unit.split(", ").collect();
                let unit_at = |index| if units.len() == 1 { unit } else { units[index] };
                let numbered = values.iter().enumerate();
                let scaled = numbered.map(|(index, value)| self.scaled(value, unit_at(index)));
                Value::Array(scaled.collect())
            }
            Value::Number(number) if number.is_f64() => {
                let scaled = number.as_f64().zip(self.factor(unit));
                json!(scaled.map(|(number, factor)| number * factor))
            }
            Value::Number(number) if unit == FRAMES => {
                let scaled = number.as_f64().zip(self.factor(unit));
                let whole =
                    scaled.map(|(number, factor)| (number * factor).round().max(1.0) as u64);
                json!(whole.filter(|_| number.as_u64() != Some(0)).unwrap_or(0))
            }
            other => other.clone(),
        }
    }

    /// What of a table's defaults is other at this size, as a table; `under` is the table's key.
    pub fn defaults_of(&self, parameters: &[Parameter], under: &str) -> Value {
        let mut scaled = Value::Object(Map::new());
        for parameter in parameters {
            let Some(value) = self.default_of(parameter) else {
                continue;
            };
            let mut place = &mut scaled;
            for name in parameter.key[under.len() + 1..].split('.') {
                if place.is_null() {
                    *place = Value::Object(Map::new());
                }
                place = &mut place[name];
            }
            *place = value;
        }
        scaled
    }
}

/// Whether the default of the setting `key` follows from the robot's size, where nobody owns it.
pub(crate) fn follows(key: &str, unit: &str, default: &Value) -> bool {
    let of_robot = OF_ROBOTS.iter().any(|table| key.starts_with(table));
    let has_power = |unit| power(unit).is_some_and(|power| power != Power::default());
    of_robot && unit.split(", ").any(has_power) && (has_number(default) || unit == FRAMES)
}

fn has_number(value: &Value) -> bool {
    match value {
        Value::Array(values) => values.iter().any(has_number),
        value => value.as_number().is_some_and(Number::is_f64),
    }
}

/// Reads a unit such as `m`, `rad/s`, `m/s^2`, `m/s/N` or `m/sqrt(s)`.
fn power(unit: &str) -> Option<Power> {
    let mut sum = Power::default();
    for (place, part) in unit.split('/').enumerate() {
        let root = part
            .strip_prefix("sqrt(")
            .and_then(|part| part.strip_suffix(')'));
        let (base, quarters_each) = match (root, part.strip_suffix("^2").or(part.strip_suffix('²')))
        {
            (Some(base), _) => (base, 2),
            (_, Some(base)) => (base, 8),
            (_, None) => (part, 4),
        };
        let signed = if place == 0 {
            quarters_each
        } else {
            -quarters_each
        };
        match base {
            "m" => sum.quarters += signed,
            "s" => sum.quarters += signed / 2,
            "N" | "kg" => sum.mass += signed / 4,
            FRAMES => {
                sum.quarters += signed / 2;
                sum.period -= signed / 4;
            }
            "1" | "-" | "rad" | "px" | "pixels" | "cells" => {}
            _ => return None,
        }
    }
    Some(sum)
}

fn whole_power(base: f64, power: i32) -> f64 {
    let product = (0..power.abs()).fold(1.0, |product, _| product * base);
    if power < 0 { product.recip() } else { product }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ANY, Table, TableDescription, settings};
    use proptest::prelude::*;

    settings! {
        /// Some of each kind.
        pub(super) struct Kinds("navigation.kinds.tuning") {
            /// A length.
            reach: f64 = 0.5, "m", ANY;
            /// A length of the camera's.
            range: f64 = 4.0, "m" of camera, ANY;
            /// The noise of a range.
            noise: f64 = 0.02, "1/m" of camera, ANY;
            /// A count.
            count: usize = 3, "m", ANY;
            /// A count of frames that stands for a time.
            patience: u32 = 40, "frames", ANY;
            /// A length that need not be.
            room: Option<f64> = None, "m", ANY;
            /// An angle.
            turn: f64 = 0.3, "rad", ANY;
            /// Lengths, each.
            aside: [f64; 2] = [-0.1, 0.1], "m", ANY;
            /// A length and an angle.
            near: [f64; 2] = [0.1, 0.2], "m, rad", ANY;
        }
    }

    settings! {
        /// Of no robot.
        pub(super) struct OfNoRobot("plan_view.kinds") {
            /// A length.
            reach: f64 = 0.5, "m", ANY;
        }
    }

    fn sized(length: f64, mass: f64) -> Scale {
        Scale {
            length,
            mass,
            disparity: 4.0,
            period: 2.0,
        }
    }

    #[test]
    fn each_kind_of_unit_follows_by_froude() {
        let four = sized(4.0, 32.0);
        for (unit, factor) in [
            ("m", 4.0),
            ("s", 2.0),
            ("m/s", 2.0),
            ("1/s", 0.5),
            ("rad/s", 0.5),
            ("1/s^2", 0.25),
            ("m/s^2", 1.0),
            ("m^2", 16.0),
            ("m²", 16.0),
            ("1/m", 0.25),
            ("m/rad", 4.0),
            ("s/rad", 2.0),
            ("rad/s/m", 0.125),
            ("N", 32.0),
            ("m/s/N", 0.0625),
            ("m/sqrt(m)", 2.0),
            ("m/sqrt(rad)", 4.0),
            ("m/sqrt(s)", 4.0 / 2.0_f64.sqrt()),
            ("rad/sqrt(m)", 0.5),
            ("rad", 1.0),
            ("px", 1.0),
            ("frames", 1.0),
            ("1", 1.0),
            ("-", 1.0),
        ] {
            let found = four.factor(unit).unwrap();
            assert!((found - factor).abs() < 1e-12, "{unit}: {found}");
            assert_eq!(Scale::ONE.factor(unit), Some(1.0), "{unit}");
        }
        assert_eq!(four.factor("furlong"), None);
    }

    #[test]
    fn what_is_not_the_robots_and_what_is_no_number_stays() {
        let table = TableDescription::of::<Kinds>();
        assert_eq!(
            table.defaults_at(&sized(2.0, 8.0)),
            json!({"reach": 1.0, "noise": 0.005, "patience": 28, "aside": [-0.2, 0.2], "near": [0.2, 0.2]})
        );
        assert_eq!(table.defaults_at(&Scale::ONE), json!({}));
        let other = TableDescription::of::<OfNoRobot>();
        assert_eq!(other.defaults_at(&sized(2.0, 8.0)), json!({}));
        assert_eq!(Kinds::parameters()[1].owner, Some(Owner::Camera));
    }

    proptest! {
        #[test]
        fn larger_and_smaller_again_is_as_before(length in 0.1..10.0, mass in 0.001..1000.0) {
            let (larger, smaller) = (sized(length, mass), sized(1.0 / length, 1.0 / mass));
            for unit in ["m", "s", "m/s", "1/s", "rad/s/m", "m/s/N", "m/sqrt(s)", "m^2"] {
                let both = larger.factor(unit).unwrap() * smaller.factor(unit).unwrap();
                prop_assert!((both - 1.0).abs() < 1e-12, "{}: {}", unit, both);
            }
        }

        #[test]
        fn froude_numbers_stay(length in 0.1..10.0) {
            let scale = sized(length, length.powi(3));
            let by = |unit| scale.factor(unit).unwrap();
            let near = |one: f64, other: f64| (one - other).abs() < 1e-12 * other.abs();
            prop_assert!(near(by("m/s") * by("m/s") / by("m"), 1.0));
            prop_assert!(near(by("m") / by("s"), by("m/s")));
            prop_assert!(near(by("s") * by("1/s"), 1.0));
            prop_assert!(near(by("m/s") / by("s"), by("m/s^2")));
            prop_assert!(near(by("m/s/N") * by("N"), by("m/s")));
        }
    }
}
