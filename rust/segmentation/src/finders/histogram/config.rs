//! Settings of the segmenter `histogram`.

use serde::{Deserialize, Serialize};
use settings::{ConfigError, require, require_positive};

/// Settings of [`super::Histogram`]: `[navigation.histogram]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct HistogramConfig {
    /// Height of a bin, m.
    pub bin: f64,
    /// Peaks closer to a higher one than this are part of it, m.
    pub apart: f64,
    /// A pixel belongs to a peak when closer than this, px of disparity.
    pub accept: f64,
}

impl Default for HistogramConfig {
    fn default() -> Self {
        Self {
            bin: 0.004,
            apart: 0.012,
            accept: 0.3,
        }
    }
}

impl HistogramConfig {
    /// Refuses what cannot be used, naming the key.
    pub fn check(&self) -> Result<(), ConfigError> {
        let key = |name: &str| format!("navigation.histogram.{name}");
        let allowed = "0.001 to 0.1";
        require(
            (0.001..=0.1).contains(&self.bin),
            &key("bin"),
            allowed,
            self.bin,
        )?;
        for (name, value) in [("apart", self.apart), ("accept", self.accept)] {
            require_positive(&key(name), value)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_allowed_and_bad_values_refused_by_their_keys() {
        let base = HistogramConfig::default;
        assert_eq!(base().check(), Ok(()));
        for (config, message) in [
            (
                HistogramConfig { bin: 0.0, ..base() },
                "bin must be 0.001 to 0.1, got 0",
            ),
            (
                HistogramConfig {
                    apart: f64::NAN,
                    ..base()
                },
                "apart must be finite and > 0, got NaN",
            ),
        ] {
            let error = config.check().unwrap_err().to_string();
            assert_eq!(error, format!("navigation.histogram.{message}"));
        }
    }
}
