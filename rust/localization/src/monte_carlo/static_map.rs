//! The map that is known beforehand, as the localizer reads it.

use settings::{ConfigError, Table};
use volume::{DistanceField, RangeField, SolidVoxels, Standing, standing};

use super::config::{MonteCarloConfig, RangeModel};

/// What does not change: how far rays get, how near surfaces are, and where one can stand.
#[derive(Debug, Clone)]
pub struct StaticMap {
    pub(super) ranges: RangeField,
    /// For the likelihood field alone.
    pub(super) distances: Option<DistanceField>,
    pub(super) places: Vec<Standing>,
}

impl StaticMap {
    /// The map of these voxels, the ground among them.
    pub fn new(solid: &SolidVoxels, config: &MonteCarloConfig) -> Result<Self, ConfigError> {
        config.check()?;
        let by_field = config.range_model == RangeModel::LikelihoodField;
        Ok(Self {
            ranges: RangeField::new(solid),
            distances: by_field.then(|| DistanceField::new(solid)),
            places: standing(solid, config.body),
        })
    }

    /// Side of a voxel, m.
    pub(super) fn resolution_m(&self) -> f64 {
        self.ranges.resolution_m()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_looked_at_before_the_map_is_made_with_them() {
        let ground = [[[0.0, 0.0, -0.04], [0.4, 0.4, 0.0]]];
        let solid = SolidVoxels::of_boxes(&ground, 0.04).unwrap();
        let config = MonteCarloConfig {
            body: [-0.1, 0.55],
            ..MonteCarloConfig::default()
        };
        let error = StaticMap::new(&solid, &config).unwrap_err();
        assert_eq!(error.key, "navigation.monte_carlo.body.0");
    }
}
