//! Bad settings: the one error all stages refuse them with.

/// A setting that cannot be used. Refused when a stage is built, never repaired.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{key} must be {allowed}, got {found}")]
pub struct ConfigError {
    /// Dotted key as the user wrote it, as in `navigation.fog.cell`.
    pub key: String,
    /// What is allowed, as in `> 0`.
    pub allowed: String,
    /// What was found.
    pub found: String,
}

/// Why a part could not be made of what the user wrote.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum MakeError {
    /// A setting that cannot be used.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// A table that cannot be read, or something that is missing; says where.
    #[error("{0}")]
    Text(String),
}

/// `Ok` where `holds`, else the error `key must be allowed, got found`.
pub fn require(
    holds: bool,
    key: &str,
    allowed: &str,
    found: impl std::fmt::Display,
) -> Result<(), ConfigError> {
    if holds {
        Ok(())
    } else {
        Err(ConfigError {
            key: key.to_owned(),
            allowed: allowed.to_owned(),
            found: found.to_string(),
        })
    }
}

/// Refuses a setting that does not fit another one of its table: how both are written in the declaration, and their values.
#[doc(hidden)]
pub fn require_fit(
    holds: bool,
    table: &str,
    [one, than, other]: [&str; 3],
    [found, limit]: [&dyn std::fmt::Display; 2],
) -> Result<(), ConfigError> {
    let named = |path: &str| path.replace('[', ".").replace([']', ' '], "");
    let allowed = format!("{than} {} ({limit})", named(other));
    require(holds, &format!("{table}.{}", named(one)), &allowed, found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::POSITIVE;

    #[test]
    fn what_is_not_positive_or_no_number_is_refused() {
        for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let error = POSITIVE.check("a.key", value, value).unwrap_err();
            let said = format!("a.key must be > 0, got {value}");
            assert_eq!(error.to_string(), said);
        }
        assert_eq!(POSITIVE.check("a.key", 1e-9, 1e-9), Ok(()));
    }

    #[test]
    fn the_message_names_key_limit_and_value() {
        let error = require(false, "navigation.fog.cell", "> 0", 0).unwrap_err();
        assert_eq!(error.to_string(), "navigation.fog.cell must be > 0, got 0");
    }
}
