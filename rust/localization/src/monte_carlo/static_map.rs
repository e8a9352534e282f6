//! The known map as the localizer reads it.

use std::sync::Arc;

use known_map::{KnownMap, Standing, StandingRoom};
use settings::{ConfigError, Table};
use volume::{DistanceField, RangeField};

use super::config::{MonteCarloConfig, RangeModel};

/// What does not change: how far rays get, how near surfaces are, and where one can stand.
#[derive(Debug, Clone)]
pub struct StaticMap {
    pub(super) ranges: Arc<RangeField>,
    /// For the likelihood field alone.
    pub(super) distances: Option<Arc<DistanceField>>,
    pub(super) places: Vec<Standing>,
}

impl StaticMap {
    /// What the localizer needs of a map, the ground among it, where a robot has room to stand that needs so much.
    pub fn new(
        map: &KnownMap,
        room: StandingRoom,
        config: &MonteCarloConfig,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        let by_field = config.range_model == RangeModel::LikelihoodField;
        let distances = || map.distances().map(Arc::clone);
        Ok(Self {
            ranges: Arc::clone(map.ranges()?),
            distances: by_field.then(distances).transpose()?,
            places: map.standing(room)?,
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
        let map = KnownMap::of_boxes(&ground, 0.04).unwrap();
        let room = StandingRoom {
            radius_m: 0.1,
            height_m: 0.55,
        };
        let config = MonteCarloConfig {
            beams: 0,
            ..MonteCarloConfig::default()
        };
        let error = StaticMap::new(&map, room, &config).unwrap_err();
        assert_eq!(error.key, "navigation.monte_carlo.beams");
    }
}
