//! Parameters of the two maps, checked once.

use settings::{
    ConfigError, NOT_NEGATIVE, POSITIVE, Table, between, from_below, require, settings,
};
use volume::octree::{LAYERS, OctreeConfig};

use super::TwoMapsTuning;
use crate::FogConfig;

settings! {
    /// The static and the local map of Maier, Hornung and Bennewitz 2012 (002). Floors, cells, ranges and `delta` are those of
    /// `[navigation.fog]`.
    pub struct TwoMapsConfig("navigation.octree") {
        /// Side of a voxel; a cell is a whole number of them wide.
        resolution: f64 = 0.04, "m", POSITIVE;
        /// Probability by the sensor that the voxel in which a beam ends is occupied.
        p_hit: f64 = 0.7, "1", between(0.5, 1.0), "002, equation (1): P(n|z)";
        /// Probability by the sensor that a voxel which a beam passes is occupied: what fewer than half of the frames hit is not.
        p_miss: f64 = 0.28, "1", between(0.0, 0.5), "002, equation (1): P(n|z)";
        /// A voxel that is as likely occupied as this counts as occupied: with the other probabilities, one frame is not enough where
        /// nothing was known or the voxel was free, and two are.
        p_occ: f64 = 0.71, "1", from_below(0.5, 1.0);
        /// So many voxels in a cell and around it, as likely occupied as not, are believed by one frame.
        large: u32 = 16, "1", NOT_NEGATIVE;
        /// No voxel is less likely occupied than this: how soon what appears is believed.
        p_min: f64 = 0.32, "1", between(0.0, 0.5);
        /// No voxel is more likely occupied than this: how soon what went away is forgotten; three frames, half a second at 6 Hz.
        p_max: f64 = 0.97, "1", between(0.5, 1.0);
        /// Vertical extent of the robot: what begins this high above the floor is passed under.
        height: f64 = 0.61, "m", POSITIVE, "002, section III.D";
        /// Surfaces of the static map are joined by steps of at most this.
        rise: f64 = 0.07, "m", POSITIVE;
        /// A line of sight on which nothing was seen, though nothing hides what is there, is free so far. 0: it tells nothing.
        unseen_range: f64 = 3.0, "m" of camera, NOT_NEGATIVE;
        /// The camera may be blind to what is nearer than this.
        blind_range: f64 = 0.6, "m" of camera, POSITIVE;
        /// Numbers that few will want to turn.
        tuning: TwoMapsTuning;
    }
    require (p_occ) < (p_max);
    check TwoMapsConfig::is_fine_enough;
}

impl TwoMapsConfig {
    fn is_fine_enough(&self, key: &str) -> Result<(), ConfigError> {
        let finest = (self.height + 2.0 * self.tuning.levels) / f64::from(LAYERS);
        let allowed = format!(">= {finest:.4} for the robot's height");
        let name = format!("{key}.resolution");
        require(self.resolution >= finest, &name, &allowed, self.resolution)
    }

    /// Refuses what cannot be used, also together with the settings of the floors.
    pub fn check_with(&self, floors: &FogConfig) -> Result<(), ConfigError> {
        self.check()?;
        let voxels = floors.cell / self.resolution;
        let allowed = format!(
            "navigation.fog.cell ({}) divided by 1, 2, 3...",
            floors.cell
        );
        let whole = voxels > 0.5 && (voxels - voxels.round()).abs() < 1e-6;
        let name = format!("{}.resolution", Self::KEY);
        require(whole, &name, &allowed, self.resolution)
    }

    /// Settings of the local map.
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
        (all_m - self.height - self.tuning.levels).min(self.tuning.deepest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(change: impl Fn(&mut TwoMapsConfig)) -> String {
        let mut config = TwoMapsConfig::default();
        change(&mut config);
        let refused = config.check_with(&FogConfig::default());
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
                "navigation.octree.height must be > 0, got NaN",
            ),
            (
                refused(|config| config.unseen_range = -1.0),
                "navigation.octree.unseen_range must be >= 0, got -1",
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
