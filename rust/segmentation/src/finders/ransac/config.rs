//! Settings of the segmenter `ransac`.

use serde::{Deserialize, Serialize};
use settings::{ConfigError, require, require_positive};

/// Settings of [`super::Ransac`]: `[navigation.ransac]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RansacConfig {
    /// Triples of pixels that are tried for each plane.
    pub samples: usize,
    /// A pixel belongs to a plane when closer than this, px of disparity.
    pub accept: f64,
    /// Smallest plane, pixels: of what is left at the end some always lie on one by chance.
    pub min_plane: usize,
}

impl Default for RansacConfig {
    fn default() -> Self {
        Self {
            samples: 300,
            accept: 0.25,
            min_plane: 150,
        }
    }
}

impl RansacConfig {
    /// Refuses what cannot be used, naming the key.
    pub fn check(&self) -> Result<(), ConfigError> {
        let key = |name: &str| format!("navigation.ransac.{name}");
        let (samples, accept, least) = (self.samples, self.accept, self.min_plane);
        let allowed = "1 to 100000";
        require(
            (1..=100_000).contains(&samples),
            &key("samples"),
            allowed,
            samples,
        )?;
        require_positive(&key("accept"), accept)?;
        require(least >= 3, &key("min_plane"), ">= 3 pixels", least)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_allowed_and_bad_values_refused_by_their_keys() {
        let base = RansacConfig::default;
        assert_eq!(base().check(), Ok(()));
        for (config, message) in [
            (
                RansacConfig {
                    samples: 0,
                    ..base()
                },
                "samples must be 1 to 100000, got 0",
            ),
            (
                RansacConfig {
                    accept: f64::NAN,
                    ..base()
                },
                "accept must be finite and > 0, got NaN",
            ),
            (
                RansacConfig {
                    min_plane: 2,
                    ..base()
                },
                "min_plane must be >= 3 pixels, got 2",
            ),
        ] {
            let error = config.check().unwrap_err().to_string();
            assert_eq!(error, format!("navigation.ransac.{message}"));
        }
    }
}
