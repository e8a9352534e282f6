//! Settings of the segmenter `scan_line_adaptive`.

use serde::{Deserialize, Serialize};
use settings::{ConfigError, require};

/// Settings of [`super::ScanLineAdaptive`]: `[navigation.scan_line_adaptive]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ScanLineAdaptiveConfig {
    /// Columns of a scan line, pixels.
    pub strip: usize,
    /// What one more plane costs: by how much twice the logarithm of the likelihood must rise.
    pub price: f64,
    /// Shortest piece of a scan line, pixels.
    pub min_segment: usize,
    /// How far real surfaces are from planes: mean square, as a multiple of the noise's.
    pub uneven: f64,
    /// Pixels that err alike: of a matching window all tell little more than one.
    pub alike: f64,
    /// A pixel belongs to a plane when it is closer than this, in noises of the plane.
    pub accept: f64,
}

impl Default for ScanLineAdaptiveConfig {
    fn default() -> Self {
        Self {
            strip: 8,
            price: 12.0,
            min_segment: 3,
            uneven: 1.0,
            alike: 4.0,
            accept: 4.0,
        }
    }
}

impl ScanLineAdaptiveConfig {
    /// Refuses what cannot be used, naming the key.
    pub fn check(&self) -> Result<(), ConfigError> {
        let key = |name: &str| format!("navigation.scan_line_adaptive.{name}");
        let (strip, least) = (self.strip, self.min_segment);
        // One column alone does not tell how a plane lies across.
        require(
            (2..=32).contains(&strip),
            &key("strip"),
            "2 to 32 pixels",
            strip,
        )?;
        for (name, value) in [("price", self.price), ("accept", self.accept)] {
            let usable = value > 0.0 && value.is_finite();
            require(usable, &key(name), "finite and > 0", value)?;
        }
        let uneven = self.uneven;
        let usable = uneven >= 0.0 && uneven.is_finite();
        require(usable, &key("uneven"), "finite and >= 0", uneven)?;
        let usable = self.alike >= 1.0 && self.alike.is_finite();
        require(usable, &key("alike"), "finite and >= 1", self.alike)?;
        require(least >= 2, &key("min_segment"), ">= 2 pixels", least)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_allowed_and_bad_values_refused_by_their_keys() {
        let base = ScanLineAdaptiveConfig::default;
        assert_eq!(base().check(), Ok(()));
        for (config, message) in [
            (
                ScanLineAdaptiveConfig { strip: 1, ..base() },
                "strip must be 2 to 32 pixels, got 1",
            ),
            (
                ScanLineAdaptiveConfig {
                    price: f64::NAN,
                    ..base()
                },
                "price must be finite and > 0, got NaN",
            ),
            (
                ScanLineAdaptiveConfig {
                    alike: 0.5,
                    ..base()
                },
                "alike must be finite and >= 1, got 0.5",
            ),
            (
                ScanLineAdaptiveConfig {
                    uneven: -1.0,
                    ..base()
                },
                "uneven must be finite and >= 0, got -1",
            ),
            (
                ScanLineAdaptiveConfig {
                    min_segment: 1,
                    ..base()
                },
                "min_segment must be >= 2 pixels, got 1",
            ),
        ] {
            let error = config.check().unwrap_err().to_string();
            assert_eq!(error, format!("navigation.scan_line_adaptive.{message}"));
        }
    }
}
