//! Settings of the scan-line segmenter: `[navigation.scan_line]`.

use serde::{Deserialize, Serialize};
use settings::{ConfigError, require, require_positive};

use super::strips::MAX_STRIP;

/// Settings of [`super::ScanLine`]. Thresholds in disparity are multiples of the local noise.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ScanLineConfig {
    /// Columns that are averaged before lines are fitted, pixels.
    pub strip: usize,
    /// Price of one more line on a strip, in squared noise; higher joins more.
    pub segment_price: f64,
    /// Shortest line, pixels.
    pub min_segment: usize,
    /// Neighbouring lines and regions are one surface when closer than this, in noise.
    pub join: f64,
    /// A pixel belongs to a surface when closer than this, in noise.
    pub accept: f64,
}

impl Default for ScanLineConfig {
    fn default() -> Self {
        Self {
            strip: 8,
            segment_price: 25.0,
            min_segment: 4,
            join: 1.2,
            accept: 2.5,
        }
    }
}

impl ScanLineConfig {
    /// Refuses what cannot be used, naming the key.
    pub fn check(&self) -> Result<(), ConfigError> {
        let key = |name: &str| format!("navigation.scan_line.{name}");
        for (name, value) in [
            ("segment_price", self.segment_price),
            ("join", self.join),
            ("accept", self.accept),
        ] {
            require_positive(&key(name), value)?;
        }
        require(
            (1..=MAX_STRIP).contains(&self.strip),
            &key("strip"),
            "> 0 and <= 32 pixels",
            self.strip,
        )?;
        require(
            self.min_segment > 0,
            &key("min_segment"),
            "> 0",
            self.min_segment,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_allowed() {
        assert_eq!(ScanLineConfig::default().check(), Ok(()));
    }

    #[test]
    fn a_bad_value_is_refused_by_its_key() {
        let config = ScanLineConfig {
            join: 0.0,
            ..ScanLineConfig::default()
        };
        assert_eq!(
            config.check().unwrap_err().to_string(),
            "navigation.scan_line.join must be finite and > 0, got 0"
        );
        let config = ScanLineConfig {
            strip: MAX_STRIP + 1,
            ..ScanLineConfig::default()
        };
        assert!(config.check().is_err());
    }
}
