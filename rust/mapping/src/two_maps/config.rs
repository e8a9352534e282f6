//! Parameters of the two maps, checked once.

use serde::{Deserialize, Serialize};
use settings::{ConfigError, require, require_positive};

use crate::FogConfig;
use volume::octree::{LAYERS, OctreeConfig};

/// How far above and below what the robot stands on floors of other levels are looked for at least, m.
const LEVELS_M: f64 = 0.3;

/// Parameters of the two maps: `[navigation.octree]`. Floors, cells, ranges and `delta` are those of `[navigation.fog]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TwoMapsConfig {
    /// Side of a voxel, m; a cell is a whole number of them wide.
    pub resolution: f64,
    /// P(n|z) of equation (1) of 002 for the voxel in which a beam ends.
    pub p_hit: f64,
    /// P(n|z) of a voxel that a beam passes: what fewer than half of the frames hit is not occupied.
    pub p_miss: f64,
    /// From where on a voxel counts as occupied: with the others, one frame is not enough, where nothing was known or it was free,
    /// and two are.
    pub p_occ: f64,
    /// So many voxels in a cell and around it, as likely occupied as not, are believed by one frame.
    pub large: u32,
    /// No voxel is less likely occupied than this: how soon what appears is believed.
    pub p_min: f64,
    /// Nor more likely than this: how soon what went away is forgotten; three frames, half a second at 6 Hz.
    pub p_max: f64,
    /// Vertical extent of the robot, m: what begins this high above the floor is passed under.
    pub height: f64,
    /// Surfaces of the static map are joined by steps of at most this, m.
    pub rise: f64,
    /// A line of sight on which nothing was seen, though nothing hides what is there, is free so far, m; 0: it tells nothing.
    pub unseen_range: f64,
    /// What is nearer than this the camera may be blind to, m.
    pub blind_range: f64,
}

impl Default for TwoMapsConfig {
    fn default() -> Self {
        Self {
            resolution: 0.04,
            p_hit: 0.7,
            p_miss: 0.28,
            p_occ: 0.71,
            large: 16,
            p_min: 0.32,
            p_max: 0.97,
            height: 0.61,
            rise: 0.07,
            unseen_range: 3.0,
            blind_range: 0.6,
        }
    }
}

impl TwoMapsConfig {
    /// Refuses what cannot be used, also together with the parameters of the floors.
    pub fn check(&self, floors: &FogConfig) -> Result<(), ConfigError> {
        let positive = |key: &str, value: f64| require_positive(&name(key), value);
        let probability = |key: &str, value: f64, low: f64, high: f64| {
            let allowed = format!("> {low} and < {high}");
            require(value > low && value < high, &name(key), &allowed, value)
        };
        positive("resolution", self.resolution)?;
        probability("p_hit", self.p_hit, 0.5, 1.0)?;
        probability("p_miss", self.p_miss, 0.0, 0.5)?;
        probability("p_min", self.p_min, 0.0, 0.5)?;
        probability("p_max", self.p_max, 0.5, 1.0)?;
        require(
            self.p_occ >= 0.5 && self.p_occ < self.p_max,
            &name("p_occ"),
            &format!(">= 0.5 and < {}", self.p_max),
            self.p_occ,
        )?;
        positive("height", self.height)?;
        positive("rise", self.rise)?;
        positive("blind_range", self.blind_range)?;
        let range = self.unseen_range;
        let usable = range.is_finite() && range >= 0.0;
        require(usable, &name("unseen_range"), "finite and >= 0", range)?;
        let finest = (self.height + 2.0 * LEVELS_M) / f64::from(LAYERS);
        let allowed = format!(">= {finest:.4} for the robot's height");
        require(
            self.resolution >= finest,
            &name("resolution"),
            &allowed,
            self.resolution,
        )?;
        let voxels = floors.cell / self.resolution;
        let allowed = format!(
            "navigation.fog.cell ({}) divided by 1, 2, 3...",
            floors.cell
        );
        let whole = voxels > 0.5 && (voxels - voxels.round()).abs() < 1e-6;
        require(whole, &name("resolution"), &allowed, self.resolution)
    }

    /// Those of the local map.
    pub(super) fn octree(&self) -> OctreeConfig {
        OctreeConfig {
            resolution: self.resolution,
            p_hit: self.p_hit,
            p_miss: self.p_miss,
            p_min: self.p_min,
            p_max: self.p_max,
        }
    }

    /// Room below what the robot stands on that is looked at, m; as much as its height leaves, but no more than it can see of.
    pub(super) fn below_m(&self) -> f64 {
        let all_m = f64::from(LAYERS) * self.resolution;
        (all_m - self.height - LEVELS_M).min(1.0)
    }
}

fn name(key: &str) -> String {
    format!("navigation.octree.{key}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(change: impl Fn(&mut TwoMapsConfig)) -> String {
        let mut config = TwoMapsConfig::default();
        change(&mut config);
        let refused = config.check(&FogConfig::default());
        refused.map_or_else(|error| error.to_string(), |()| "accepted".to_owned())
    }

    #[test]
    fn a_bad_value_is_refused_by_its_key() {
        assert_eq!(refused(|_| {}), "accepted");
        assert_eq!(refused(|config| config.resolution = 0.02), "accepted");
        for (found, said) in [
            (
                refused(|config| config.resolution = 0.03),
                "navigation.octree.resolution must be navigation.fog.cell (0.04) divided by 1, 2, 3..., got 0.03",
            ),
            (
                refused(|config| config.resolution = 0.01),
                "navigation.octree.resolution must be >= 0.0189 for the robot's height, got 0.01",
            ),
            (
                refused(|config| config.p_max = 0.5),
                "navigation.octree.p_max must be > 0.5 and < 1, got 0.5",
            ),
            (
                refused(|config| config.height = f64::NAN),
                "navigation.octree.height must be finite and > 0, got NaN",
            ),
            (
                refused(|config| config.unseen_range = -1.0),
                "navigation.octree.unseen_range must be finite and >= 0, got -1",
            ),
        ] {
            assert_eq!(found, said);
        }
    }

    #[test]
    fn an_unknown_key_is_refused() {
        let error = serde_json::from_str::<TwoMapsConfig>(r#"{"delta": 0.1}"#).unwrap_err();
        assert!(error.to_string().contains("unknown field `delta`"));
    }
}
