//! What the known map says of ground that was not seen yet (002, III.A: prior knowledge for planning).

use std::sync::Arc;

use volume::SolidVoxels;

use crate::{Floors, KnownMapTuning, PriorTuning, StandingRoom};

/// What the map has at a place for who stands on one of its levels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Expected {
    /// Nothing is to be said: the map ends before, or has another level there.
    Unknown,
    /// Floor of the same level.
    Floor,
    /// Something stands there.
    Obstacle,
}

/// What the map has on the level that the robot stands on, and where its steps are.
#[derive(Debug, Clone)]
pub struct Prior {
    solid: Arc<SolidVoxels>,
    /// Floors for a body without a width.
    floors: Floors,
    /// For each column whether steps of the map are near.
    has_steps: Vec<bool>,
    height_m: f64,
    tuning: PriorTuning,
}

impl Prior {
    /// What a robot of a height, m, needs where a floor is to be expected.
    pub(crate) const fn room(height_m: f64) -> StandingRoom {
        StandingRoom {
            radius_m: 0.0,
            height_m,
        }
    }

    /// What a map says to a robot of a height, m, for which it has these floors.
    pub(crate) fn new(
        solid: &Arc<SolidVoxels>,
        floors: Floors,
        height_m: f64,
        tuning: &KnownMapTuning,
    ) -> Self {
        Self {
            has_steps: floors.columns_near_steps(tuning.prior.stairs),
            floors,
            solid: Arc::clone(solid),
            height_m,
            tuning: tuning.prior.clone(),
        }
    }

    /// Height of the robot, m.
    pub const fn height_m(&self) -> f64 {
        self.height_m
    }

    /// Height of the map's floor on which the robot stands, m; none where the map has no floor there.
    pub fn level_under(&self, robot_m: [f64; 3]) -> Option<f64> {
        let under = self.floors.under(robot_m, |_| true)?;
        let [.., level_m] = self.floors.at_m(under);
        Some(level_m)
    }

    /// Whether steps of the map are near a place; true beyond the map, where nobody knows.
    pub fn has_steps(&self, at_m: [f64; 2]) -> bool {
        (self.floors.column_at(at_m)).is_none_or(|column| self.has_steps[column])
    }

    /// What the map has at a place for who stands on a level, m.
    pub fn at(&self, at_m: [f64; 2], level_m: f64) -> Expected {
        let Some(column) = self.floors.column_at(at_m) else {
            return Expected::Unknown;
        };
        let mut other = false;
        for height_m in self.floors.heights_m(column) {
            let off_m = (height_m - level_m).abs();
            if off_m <= self.tuning.level {
                return Expected::Floor;
            }
            other |= off_m <= self.tuning.other_level;
        }
        let layer = |height_m: f64| {
            ((level_m + height_m - self.solid.corner_m([0; 3])[2]) / self.solid.resolution_m)
                .floor() as i64
        };
        let [x, y] = self.floors.cell_of(column).map(|at| at as i64);
        let mut above = layer(self.tuning.step)..layer(self.height_m);
        let stands = above.any(|z| self.solid.is_solid([x, y, z]));
        if stands && !other {
            Expected::Obstacle
        } else {
            Expected::Unknown
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn prior(boxes: &[[[f64; 3]; 2]]) -> Prior {
        let solid = SolidVoxels::of_boxes(boxes, 0.04).unwrap();
        let tuning = KnownMapTuning::default();
        let floors = Floors::new((&solid, None), Prior::room(0.58), &tuning);
        Prior::new(&Arc::new(solid), floors, 0.58, &tuning)
    }

    #[test]
    fn the_robots_level_is_floor_walls_stand_and_other_levels_stay_unknown() {
        let prior = prior(&[
            [[0.0, 0.0, -0.04], [2.0, 1.0, 0.0]],
            // A wall, an upper level, a deck that one can walk under.
            [[0.96, 0.0, 0.0], [1.0, 1.0, 0.6]],
            [[0.0, 0.6, 0.0], [0.4, 1.0, 0.36]],
            [[1.4, 0.0, 0.72], [2.0, 1.0, 0.76]],
        ]);
        let below_m = prior.level_under([0.6, 0.3, 0.003]).unwrap();
        assert!(below_m.abs() < 1e-6);
        assert_eq!(prior.at([0.3, 0.3], below_m), Expected::Floor);
        assert_eq!(prior.at([0.98, 0.5], below_m), Expected::Obstacle);
        assert_eq!(prior.at([0.2, 0.8], below_m), Expected::Unknown);
        assert_eq!(prior.at([1.7, 0.5], below_m), Expected::Floor);
        assert_eq!(prior.at([3.0, 0.5], below_m), Expected::Unknown);
        let above_m = prior.level_under([0.2, 0.8, 0.36]).unwrap();
        assert!((above_m - 0.36).abs() < 1e-6);
        assert_eq!(prior.at([0.3, 0.7], above_m), Expected::Floor);
        assert_eq!(prior.at([0.3, 0.3], above_m), Expected::Unknown);
        assert_eq!(prior.level_under([3.0, 0.5, 0.0]), None);
    }

    #[test]
    fn steps_are_near_where_the_floor_rises_and_beyond_the_map() {
        let prior = prior(&[
            [[0.0, 0.0, -0.04], [2.0, 1.0, 0.0]],
            [[1.6, 0.0, 0.0], [2.0, 1.0, 0.04]],
        ]);
        assert!(prior.has_steps([1.5, 0.5]) && prior.has_steps([3.0, 0.5]));
        assert!(!prior.has_steps([1.0, 0.5]));
    }
}
