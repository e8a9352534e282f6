//! Settings of the segmenter `hough`.

use serde::{Deserialize, Serialize};
use settings::{ConfigError, require, require_positive};

/// Settings of [`super::Hough`]: `[navigation.hough]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct HoughConfig {
    /// Triples of pixels that vote for each plane.
    pub samples: usize,
    /// The pixels of a triple are at most this far from each other, pixels along rows and columns.
    pub window: usize,
    /// Size of a cell of the accumulator in the normal's two angles, rad.
    pub angle: f64,
    /// Size of a cell in the distance from the camera, m.
    pub distance: f64,
    /// A pixel belongs to a plane when closer than this, px of disparity.
    pub accept: f64,
    /// Smallest plane, pixels.
    pub min_plane: usize,
}

impl Default for HoughConfig {
    fn default() -> Self {
        Self {
            samples: 3000,
            window: 16,
            angle: 0.07,
            distance: 0.02,
            accept: 0.25,
            min_plane: 150,
        }
    }
}

impl HoughConfig {
    /// Refuses what cannot be used, naming the key.
    pub fn check(&self) -> Result<(), ConfigError> {
        let key = |name: &str| format!("navigation.hough.{name}");
        for (name, value, most) in [
            ("samples", self.samples, 100_000),
            ("window", self.window, 1000),
        ] {
            let allowed = format!("1 to {most}");
            require((1..=most).contains(&value), &key(name), &allowed, value)?;
        }
        // Smaller cells would need an accumulator of more than 40 MB.
        for (name, value, least, most) in [
            ("angle", self.angle, 0.03, 0.5),
            ("distance", self.distance, 0.01, 0.5),
        ] {
            let allowed = format!("{least} to {most}");
            require((least..=most).contains(&value), &key(name), &allowed, value)?;
        }
        require_positive(&key("accept"), self.accept)?;
        let least = self.min_plane;
        require(least >= 3, &key("min_plane"), ">= 3 pixels", least)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_allowed_and_bad_values_refused_by_their_keys() {
        let base = HoughConfig::default;
        assert_eq!(base().check(), Ok(()));
        for (config, message) in [
            (
                HoughConfig {
                    samples: 0,
                    ..base()
                },
                "samples must be 1 to 100000, got 0",
            ),
            (
                HoughConfig {
                    angle: f64::NAN,
                    ..base()
                },
                "angle must be 0.03 to 0.5, got NaN",
            ),
            (
                HoughConfig {
                    distance: 0.0,
                    ..base()
                },
                "distance must be 0.01 to 0.5, got 0",
            ),
            (
                HoughConfig {
                    min_plane: 2,
                    ..base()
                },
                "min_plane must be >= 3 pixels, got 2",
            ),
        ] {
            let error = config.check().unwrap_err().to_string();
            assert_eq!(error, format!("navigation.hough.{message}"));
        }
    }
}
