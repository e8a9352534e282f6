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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_message_names_key_limit_and_value() {
        let error = require(false, "navigation.fog.cell", "> 0", 0).unwrap_err();
        assert_eq!(error.to_string(), "navigation.fog.cell must be > 0, got 0");
    }
}
