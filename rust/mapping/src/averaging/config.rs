//! Parameters of the averaged height map, checked once.

use serde::{Deserialize, Serialize};
use settings::{ConfigError, require};

use crate::surface::require_usable_side;

/// Parameters of the averaged height map: `[navigation.averaging]`. Where a key is one of `[navigation.fog]`, too, it means the
/// same and has the same default, so that both are compared on equal terms.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct AveragingConfig {
    /// Side of a cell, m.
    pub cell: f64,
    /// Cells along each side of the window.
    pub cells: usize,
    /// A cell that lies more than this above one beside it is an obstacle, m; what is lower can be climbed (003, Table I:
    /// steps up to 50 mm).
    pub rise: f64,
    /// Points further away than this are left out, m.
    pub max_range: f64,
    /// Frames are shifted in height to fit the known heights by at most this, m.
    pub match_gate: f64,
    /// Points that must fit the known heights before a frame is shifted, or used without a ground plane.
    pub min_pairs: usize,
    /// Radius around the robot in which unseen cells are shown as floor at its height (it stands there), m.
    pub footprint: f64,
}

impl Default for AveragingConfig {
    fn default() -> Self {
        Self {
            cell: 0.04,
            cells: 100,
            rise: 0.05,
            max_range: 4.0,
            match_gate: 0.02,
            min_pairs: 150,
            footprint: 0.12,
        }
    }
}

impl AveragingConfig {
    /// Refuses what cannot be used, naming the key.
    pub fn check(&self) -> Result<(), ConfigError> {
        let name = |key: &str| format!("navigation.averaging.{key}");
        for (key, value) in [
            ("cell", self.cell),
            ("rise", self.rise),
            ("max_range", self.max_range),
        ] {
            require(value > 0.0 && value.is_finite(), &name(key), "> 0", value)?;
        }
        require_usable_side(&name("cell"), self.cell)?;
        for (key, value) in [
            ("match_gate", self.match_gate),
            ("footprint", self.footprint),
        ] {
            require(value >= 0.0 && value.is_finite(), &name(key), ">= 0", value)?;
        }
        require(
            (4..=2000).contains(&self.cells),
            &name("cells"),
            "4 to 2000",
            self.cells,
        )?;
        require(
            self.min_pairs > 0,
            &name("min_pairs"),
            "> 0",
            self.min_pairs,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FogConfig;

    #[test]
    fn the_defaults_are_allowed() {
        assert_eq!(AveragingConfig::default().check(), Ok(()));
    }

    #[test]
    fn a_bad_value_is_refused_by_its_key() {
        let base = AveragingConfig::default;
        let refused = |config: AveragingConfig| config.check().unwrap_err().to_string();
        assert_eq!(
            refused(AveragingConfig {
                rise: f64::NAN,
                ..base()
            }),
            "navigation.averaging.rise must be > 0, got NaN"
        );
        for (config, key) in [
            (
                AveragingConfig {
                    footprint: -0.1,
                    ..base()
                },
                "footprint",
            ),
            (AveragingConfig { cells: 3, ..base() }, "cells"),
            (
                AveragingConfig {
                    min_pairs: 0,
                    ..base()
                },
                "min_pairs",
            ),
        ] {
            assert!(refused(config).starts_with(&format!("navigation.averaging.{key} must be")));
        }
    }

    #[test]
    fn what_both_maps_have_is_the_same_by_default() {
        let ours = serde_json::to_value(FogConfig::default()).unwrap();
        let theirs = serde_json::to_value(AveragingConfig::default()).unwrap();
        let theirs = theirs.as_object().unwrap();
        let shared = theirs.iter().filter(|(key, _)| ours.get(key).is_some());
        assert_eq!(shared.clone().count(), theirs.len() - 1);
        for (key, value) in shared {
            assert_eq!(ours.get(key), Some(value), "{key}");
        }
    }
}
