//! The map that is known beforehand, as the localizer reads it.

use mapping::volume::{DistanceField, RangeField, SolidVoxels, Standing, standing};

use super::{MonteCarloConfig, RangeModel};

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
    pub fn new(solid: &SolidVoxels, config: &MonteCarloConfig) -> Self {
        let by_field = config.range_model == RangeModel::LikelihoodField;
        Self {
            ranges: RangeField::new(solid),
            distances: by_field.then(|| DistanceField::new(solid)),
            places: standing(solid, config.body),
        }
    }

    /// Side of a voxel, m.
    pub(super) fn resolution_m(&self) -> f64 {
        self.ranges.resolution_m()
    }
}
