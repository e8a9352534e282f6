//! What can be the value of a setting, and what is known of one.

use schemars::JsonSchema;
use serde::de::Error as _;
use serde_json::{Map, Value, json};

use crate::reading::{not_read, value_of};
use crate::{Bounds, ConfigError, MakeError};

/// Whose a setting is that does not follow the robot's size, though its unit has a length or a time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Owner {
    /// The camera's: how far it sees, how its depths err, how often it looks.
    Camera,
    /// That of the inertial unit, the encoders or the force cells: how they err, and how long what they say is averaged.
    Sensor,
    /// That of what is there whoever looks at it: how people move.
    World,
    /// The computation's: where it has converged.
    Numerics,
}

/// One setting, as `treadwell list parameters` shows it.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Parameter {
    /// Dotted key, as in `navigation.fog.cell`.
    pub key: String,
    /// What it has where nobody says.
    pub default: Value,
    /// Its unit; `1` for a number without one, `-` for what is no number.
    pub unit: &'static str,
    /// What is allowed.
    pub bounds: String,
    /// What it means.
    pub meaning: String,
    /// Paper and equation, where it comes from one.
    pub source: Option<&'static str>,
    /// Whose it is, where it does not follow the robot's size though its unit would.
    pub owner: Option<Owner>,
    /// Whether its default follows from the robot's size.
    pub scales: bool,
    /// Whether it stands under `tuning`: a number that decides something, but that few will want to turn.
    pub tuning: bool,
    /// Its part of the table's JSON schema.
    pub schema: Value,
}

/// A value that a setting can have: a number, a choice, a list of such, or a table of settings.
pub trait Setting: Sized {
    /// What was given for the setting `key`; of a table, over its default or that of its type.
    fn over(default: Option<&Self>, given: &Value, key: &str) -> Result<Self, MakeError>;

    /// The value as a user would write it.
    fn written(&self) -> Value;

    /// Refuses what is outside the bounds, by its key.
    fn check(&self, key: &str, bounds: &Bounds) -> Result<(), ConfigError>;

    /// JSON schema of its values.
    fn schema(bounds: &Bounds) -> Value;

    /// The settings in it with its values for defaults, where it is a table.
    fn parameters(&self, _key: &str) -> Option<Vec<Parameter>> {
        None
    }

    /// What is allowed, in words.
    fn allowed(bounds: &Bounds) -> String {
        bounds.to_string()
    }
}

macro_rules! numbers {
    ($kind:literal: $($number:ty),*) => {$(
        impl Setting for $number {
            fn over(_: Option<&Self>, given: &Value, key: &str) -> Result<Self, MakeError> {
                value_of(given, key)
            }

            fn written(&self) -> Value {
                json!(self)
            }

            fn check(&self, key: &str, bounds: &Bounds) -> Result<(), ConfigError> {
                // As wide as every number here that a bound can name.
                #[expect(clippy::allow_attributes, reason = "only some conversions are lossless")]
                #[allow(
                    clippy::cast_lossless,
                    trivial_numeric_casts,
                    reason = "only some conversions are lossless"
                )]
                let value = *self as f64;
                bounds.check(key, value, self)
            }

            fn schema(bounds: &Bounds) -> Value {
                let mut schema = Map::from_iter([("type".to_owned(), json!($kind))]);
                for (keyword, value) in bounds.keywords() {
                    drop(schema.insert(keyword.to_owned(), json!(value)));
                }
                Value::Object(schema)
            }
        }
    )*};
}

numbers!("number": f64, f32);
numbers!("integer": u8, u16, u32, u64, usize, i32, i64);

impl Setting for bool {
    fn over(_: Option<&Self>, given: &Value, key: &str) -> Result<Self, MakeError> {
        value_of(given, key)
    }

    fn written(&self) -> Value {
        json!(self)
    }

    fn check(&self, _: &str, _: &Bounds) -> Result<(), ConfigError> {
        Ok(())
    }

    fn schema(_: &Bounds) -> Value {
        json!({"type": "boolean"})
    }

    fn allowed(_: &Bounds) -> String {
        "true, false".to_owned()
    }
}

impl<T: Setting> Setting for Option<T> {
    fn over(default: Option<&Self>, given: &Value, key: &str) -> Result<Self, MakeError> {
        if given.is_null() {
            return Ok(None);
        }
        T::over(default.and_then(Self::as_ref), given, key).map(Some)
    }

    fn written(&self) -> Value {
        self.as_ref().map_or(Value::Null, T::written)
    }

    fn check(&self, key: &str, bounds: &Bounds) -> Result<(), ConfigError> {
        self.as_ref()
            .map_or(Ok(()), |value| value.check(key, bounds))
    }

    fn schema(bounds: &Bounds) -> Value {
        json!({"anyOf": [T::schema(bounds), {"type": "null"}]})
    }

    fn allowed(bounds: &Bounds) -> String {
        format!("{}, or left out", T::allowed(bounds))
    }
}

impl<T: Setting, const N: usize> Setting for [T; N] {
    fn over(_: Option<&Self>, given: &Value, key: &str) -> Result<Self, MakeError> {
        let given: Vec<Value> = value_of(given, key)?;
        let numbered = given.iter().enumerate();
        let read: Vec<T> = numbered
            .map(|(index, value)| T::over(None, value, &format!("{key}[{index}]")))
            .collect::<Result<_, _>>()?;
        let expected = format!("an array of length {N}");
        Self::try_from(read).map_err(|read| {
            not_read(
                key,
                &serde_json::Error::invalid_length(read.len(), &expected.as_str()),
            )
        })
    }

    fn written(&self) -> Value {
        self.iter().map(T::written).collect()
    }

    fn check(&self, key: &str, bounds: &Bounds) -> Result<(), ConfigError> {
        let mut numbered = self.iter().enumerate();
        numbered.try_for_each(|(index, value)| value.check(&format!("{key}.{index}"), bounds))
    }

    fn schema(bounds: &Bounds) -> Value {
        json!({"type": "array", "items": T::schema(bounds), "minItems": N, "maxItems": N})
    }

    fn allowed(bounds: &Bounds) -> String {
        format!("{N} values, each {}", T::allowed(bounds))
    }
}

/// Words to choose from: the schema of a choice, and what is allowed in words. Used by [`crate::choices!`].
pub fn words_of<T: JsonSchema>() -> (Value, Vec<String>) {
    let generator = schemars::generate::SchemaSettings::draft2020_12()
        .with(|settings| settings.inline_subschemas = true)
        .into_generator();
    let mut schema = generator.into_root_schema_for::<T>().to_value();
    if let Value::Object(schema) = &mut schema {
        for key in ["$schema", "title"] {
            drop(schema.remove(key));
        }
    }
    let named = schema["enum"].as_array().into_iter().flatten();
    let described = schema["oneOf"].as_array().into_iter().flatten();
    let words = named
        .chain(described.map(|one| one.get("const").unwrap_or(&one["enum"][0])))
        .filter_map(|word| word.as_str().map(str::to_owned))
        .collect();
    (schema, words)
}

/// Makes enums settings: one of their words. They need `serde` and `schemars::JsonSchema`.
#[macro_export]
macro_rules! choices {
    ($($choice:ty),* $(,)?) => {$(
        impl $crate::Setting for $choice {
            fn over(
                _: Option<&Self>,
                given: &$crate::serde_json::Value,
                key: &str,
            ) -> Result<Self, $crate::MakeError> {
                $crate::value_of(given, key)
            }

            fn written(&self) -> $crate::serde_json::Value {
                $crate::serde_json::json!(self)
            }

            fn check(&self, _: &str, _: &$crate::Bounds) -> Result<(), $crate::ConfigError> {
                Ok(())
            }

            fn schema(_: &$crate::Bounds) -> $crate::serde_json::Value {
                $crate::words_of::<Self>().0
            }

            fn allowed(_: &$crate::Bounds) -> String {
                $crate::words_of::<Self>().1.join(", ")
            }
        }
    )*};
}
