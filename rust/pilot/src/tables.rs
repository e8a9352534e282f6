//! `[navigation.<name>]`: a component's parameters as the user wrote them, on top of their defaults.

use std::collections::BTreeMap;

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use crate::PilotError;

/// Reads `[navigation.<name>]`. What it does not say has its default, in tables within the table too.
pub(crate) fn table<T: DeserializeOwned + Serialize + Default>(
    tables: &BTreeMap<String, Value>,
    name: &str,
) -> Result<T, PilotError> {
    let Some(given) = tables.get(name) else {
        return Ok(T::default());
    };
    let refused = |key: &str, error: &dyn std::fmt::Display| {
        PilotError::Settings(format!("navigation.{name}{key}: {error}"))
    };
    let mut settings = serde_json::to_value(T::default()).map_err(|error| refused("", &error))?;
    overlay(&mut settings, given);
    serde_path_to_error::deserialize(settings).map_err(|error| {
        let key = match error.path().to_string().as_str() {
            "." => String::new(),
            path => format!(".{path}"),
        };
        refused(&key, error.inner())
    })
}

/// Puts `given` over `settings`, key by key where both are tables.
fn overlay(settings: &mut Value, given: &Value) {
    match (settings, given) {
        (Value::Object(settings), Value::Object(given)) => {
            for (key, value) in given {
                overlay(settings.entry(key).or_insert(Value::Null), value);
            }
        }
        (settings, given) => settings.clone_from(given),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;
    use stairs::ClimbingConfig;

    fn climbing(given: Value) -> Result<ClimbingConfig, String> {
        let tables = BTreeMap::from([("climbing".to_owned(), given)]);
        table(&tables, "climbing").map_err(|error| error.to_string())
    }

    #[test]
    fn what_a_table_within_a_table_does_not_say_has_its_default() {
        let mut expected = ClimbingConfig::default();
        assert_eq!(climbing(json!({})).unwrap(), expected);
        expected.ascend.approach_x = -0.02;
        let given = json!({"ascend": {"approach_x": -0.02}});
        assert_eq!(climbing(given).unwrap(), expected);
    }

    #[test]
    fn a_key_that_is_not_known_is_refused_with_those_that_are() {
        let outer = climbing(json!({"asend": {}})).unwrap_err();
        assert!(outer.contains("unknown field `asend`"), "{outer}");
        let inner = climbing(json!({"ascend": {"aproach_x": 0.0}})).unwrap_err();
        assert!(inner.starts_with("navigation.climbing.ascend"), "{inner}");
        assert!(inner.contains("unknown field `aproach_x`"), "{inner}");
        assert!(inner.contains("`approach_x`"), "{inner}");
    }

    #[test]
    fn a_value_of_the_wrong_kind_is_refused_by_its_key() {
        for (given, key) in [
            (
                json!({"tolerance": "wide"}),
                "navigation.climbing.tolerance: ",
            ),
            (
                json!({"ascend": {"step_max_z": []}}),
                "navigation.climbing.ascend.step_max_z: ",
            ),
            (json!({"ascend": 3}), "navigation.climbing.ascend: "),
            (json!(3), "navigation.climbing: "),
        ] {
            let error = climbing(given).unwrap_err();
            assert!(error.starts_with(key), "{error}");
        }
    }

    #[test]
    fn a_table_that_is_not_there_has_all_defaults() {
        let config: ClimbingConfig = table(&BTreeMap::new(), "climbing").unwrap();
        assert_eq!(config, ClimbingConfig::default());
    }
}
