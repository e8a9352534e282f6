//! A table of settings: declared once by `settings!`, read from what a user wrote, refused by key.

use std::collections::BTreeMap;

use serde::de::{Deserialize as _, Deserializer, Error as _};
use serde_json::{Map, Value, json};

use crate::scale;
use crate::{Bounds, ConfigError, MakeError, Owner, Parameter, Scale, Setting};

/// A struct whose fields are settings. Declared by [`crate::settings!`].
pub trait Table: Setting + Default {
    /// Where it stands, as in `navigation.fog`.
    const KEY: &'static str;
    /// What the table is for.
    const ABOUT: &'static str;

    /// Refuses what cannot be used, as settings of the table `key`.
    fn check_as(&self, key: &str) -> Result<(), ConfigError>;

    /// The settings of the table `key` with its values for defaults, tables within it included.
    fn parameters_as(&self, key: &str) -> Vec<Parameter>;

    /// What was given for the table `key`, over the defaults.
    fn read_as(key: &str, given: &Value) -> Result<Self, MakeError> {
        Self::over(None, given, key)
    }

    /// Refuses what cannot be used.
    fn check(&self) -> Result<(), ConfigError> {
        self.check_as(Self::KEY)
    }

    /// Every setting, tables within included.
    fn parameters() -> Vec<Parameter> {
        Self::default().parameters_as(Self::KEY)
    }
}

/// What a table is, for lists and schemas.
#[derive(Debug, Clone, Copy)]
pub struct TableDescription {
    /// Where it stands, as in `navigation.fog`.
    pub key: &'static str,
    /// What it is for.
    pub about: &'static str,
    list: fn(&str) -> Vec<Parameter>,
    check: fn(&str, &Value) -> Result<(), MakeError>,
}

impl TableDescription {
    /// That of a table.
    pub const fn of<T: Table>() -> Self {
        Self::at::<T>(T::KEY)
    }

    /// That of a table which stands at another key than its own.
    pub const fn at<T: Table>(key: &'static str) -> Self {
        Self {
            key,
            about: T::ABOUT,
            list: |key| T::default().parameters_as(key),
            check: |key, given| Ok(T::read_as(key, given)?.check_as(key)?),
        }
    }

    /// Its settings.
    pub fn parameters(&self) -> Vec<Parameter> {
        (self.list)(self.key)
    }

    /// What of its defaults is other for a robot of that size, as a table.
    pub fn defaults_at(&self, scale: &Scale) -> Value {
        if *scale == Scale::ONE {
            return Value::Object(Map::new());
        }
        scale.defaults_of(&self.parameters(), self.key)
    }

    /// Refuses settings that cannot be used; what they do not say has its default.
    pub fn check(&self, given: &Value) -> Result<(), MakeError> {
        (self.check)(self.key, given)
    }

    /// JSON schema of the table.
    pub fn schema(&self) -> Value {
        let mut schema = object(self.about);
        for parameter in self.parameters() {
            let below = &parameter.key[self.key.len() + 1..];
            let mut table = &mut schema;
            let mut names: Vec<_> = below.split('.').collect();
            let Some(last) = names.pop() else { continue };
            for name in names {
                table = &mut table["properties"][name];
                if table.is_null() {
                    *table = object("");
                }
            }
            table["properties"][last] = parameter.schema;
        }
        schema
    }
}

fn object(about: &str) -> Value {
    json!({
        "type": "object",
        "description": about,
        "properties": Map::new(),
        "additionalProperties": false,
    })
}

/// `[navigation.<name>]` as the user wrote them, by name.
pub type Tables = BTreeMap<String, Value>;

/// Reads the table `[navigation.<name>]`. What it does not say has its default, in tables within it too.
pub fn read<T: Table>(tables: &Tables, name: &str) -> Result<T, MakeError> {
    tables.get(name).map_or_else(
        || Ok(T::default()),
        |given| T::read_as(&format!("navigation.{name}"), given),
    )
}

/// Reads a table for `serde`.
#[doc(hidden)]
pub fn table_within<'de, T: Table, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
    let given = Value::deserialize(deserializer)?;
    T::read_as(T::KEY, &given).map_err(D::Error::custom)
}

/// Puts `given` over `settings`, key by key where both are tables.
pub fn overlay(settings: &mut Value, given: &Value) {
    match (settings, given) {
        (Value::Object(settings), Value::Object(given)) => {
            for (key, value) in given {
                overlay(settings.entry(key).or_insert(Value::Null), value);
            }
        }
        (settings, given) => settings.clone_from(given),
    }
}

/// The key of a setting of a table.
#[doc(hidden)]
pub fn key_of(table: &str, name: &str) -> String {
    format!("{table}.{name}")
}

/// A setting as it was declared.
#[doc(hidden)]
#[derive(Debug)]
pub struct Declared {
    /// Its dotted key.
    pub key: String,
    /// Its unit.
    pub unit: &'static str,
    /// What is allowed.
    pub bounds: Bounds,
    /// What it means, as the doc comment has it.
    pub meaning: &'static str,
    /// Paper and equation.
    pub source: Option<&'static str>,
    /// Whose it is, where it does not follow the robot's size.
    pub owner: Option<Owner>,
}

/// Puts what is known of a setting, or of all those of a table within the table, to a list.
#[doc(hidden)]
pub fn describe<T: Setting>(all: &mut Vec<Parameter>, default: &T, as_is: Declared) {
    let Declared {
        key,
        unit,
        bounds,
        meaning,
        source,
        owner,
    } = as_is;
    if let Some(inner) = default.parameters(&key) {
        all.extend(inner);
        return;
    }
    let meaning = meaning.split_whitespace().collect::<Vec<_>>().join(" ");
    let default = as_written(default.written());
    let mut schema = T::schema(&bounds);
    schema["description"] = json!(meaning);
    schema["default"] = default.clone();
    if !matches!(unit, "-" | "1") {
        schema["x-unit"] = json!(unit);
    }
    all.push(Parameter {
        scales: owner.is_none() && scale::follows(&key, unit, &default),
        tuning: key.contains(".tuning."),
        bounds: T::allowed(&bounds),
        key,
        default,
        unit,
        meaning,
        source,
        owner,
        schema,
    });
}

/// Numbers as they were written: those of 32 bits would show digits of 64 that nobody wrote.
fn as_written(value: Value) -> Value {
    match value {
        Value::Array(values) => values.into_iter().map(as_written).collect(),
        Value::Number(number) if number.is_f64() => number
            .as_f64()
            .filter(|&wide| f64::from(wide as f32) == wide)
            .and_then(|wide| (wide as f32).to_string().parse::<f64>().ok())
            .map_or(Value::Number(number), |short| json!(short)),
        other => other,
    }
}
