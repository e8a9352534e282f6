//! Settings of the segmenter `scan_line_1994`.

use serde::{Deserialize, Serialize};
use settings::{ConfigError, require, require_positive};

/// Settings of [`super::ScanLine1994`]: `[navigation.scan_line_1994]`. The thresholds are fixed, whatever the local noise;
/// the defaults are those that tell most treads of 30 mm apart at a noise of 1/8 px.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ScanLine1994Config {
    /// Columns that are averaged to one scan line, pixels.
    pub strip: usize,
    /// A scan line is split where it lies further than this from the line between its ends, px of disparity.
    pub split: f64,
    /// Shortest line, pixels.
    pub min_segment: usize,
    /// A line belongs to a plane when its ends are closer to it than this, and so do pixels, px of disparity.
    pub accept: f64,
}

impl Default for ScanLine1994Config {
    fn default() -> Self {
        Self {
            strip: 8,
            split: 0.15,
            min_segment: 4,
            accept: 0.35,
        }
    }
}

impl ScanLine1994Config {
    /// Refuses what cannot be used, naming the key.
    pub fn check(&self) -> Result<(), ConfigError> {
        let key = |name: &str| format!("navigation.scan_line_1994.{name}");
        let (strip, least) = (self.strip, self.min_segment);
        require(
            (1..=32).contains(&strip),
            &key("strip"),
            "1 to 32 pixels",
            strip,
        )?;
        for (name, value) in [("split", self.split), ("accept", self.accept)] {
            require_positive(&key(name), value)?;
        }
        require(least >= 2, &key("min_segment"), ">= 2 pixels", least)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_allowed_and_bad_values_refused_by_their_keys() {
        let base = ScanLine1994Config::default;
        assert_eq!(base().check(), Ok(()));
        for (config, message) in [
            (
                ScanLine1994Config { strip: 0, ..base() },
                "strip must be 1 to 32 pixels, got 0",
            ),
            (
                ScanLine1994Config {
                    split: f64::NAN,
                    ..base()
                },
                "split must be finite and > 0, got NaN",
            ),
            (
                ScanLine1994Config {
                    min_segment: 1,
                    ..base()
                },
                "min_segment must be >= 2 pixels, got 1",
            ),
        ] {
            let error = config.check().unwrap_err().to_string();
            assert_eq!(error, format!("navigation.scan_line_1994.{message}"));
        }
    }
}
