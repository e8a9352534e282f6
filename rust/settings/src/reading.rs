//! What a user wrote, read setting by setting; what cannot be read is refused by its key.

use serde::de::{DeserializeOwned, Error as _};
use serde_json::{Map, Value};

use crate::MakeError;

/// What was given for the setting `key`, read as one value.
#[doc(hidden)]
pub fn value_of<T: DeserializeOwned>(given: &Value, key: &str) -> Result<T, MakeError> {
    T::deserialize(given).map_err(|error| not_read(key, &error))
}

/// What was given for the table `key`.
#[doc(hidden)]
pub fn entries<'a>(given: &'a Value, key: &str) -> Result<&'a Map<String, Value>, MakeError> {
    given
        .as_object()
        .ok_or_else(|| MakeError::Text(format!("{key}: expected a table, got {given}")))
}

/// Why a table has no setting `name`, which was given as `key`.
#[doc(hidden)]
pub fn unknown(key: &str, name: &str, known: &'static [&'static str]) -> MakeError {
    not_read(key, &serde_json::Error::unknown_field(name, known))
}

/// Why a setting cannot be read, in words of who writes settings and not of the code that reads them.
pub(crate) fn not_read(key: &str, error: &serde_json::Error) -> MakeError {
    let (whole, number) = ("expected a whole number", "expected a number");
    let names = ["usize", "u64", "u32", "u16", "u8", "i64", "i32"];
    let whole_said = names.iter().fold(error.to_string(), |said, name| {
        said.replace(&format!("expected {name}"), whole)
    });
    let said = ["f64", "f32"].iter().fold(whole_said, |said, name| {
        said.replace(&format!("expected {name}"), number)
    });
    MakeError::Text(format!("{key}: {said}"))
}
