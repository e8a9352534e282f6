//! Rule: stairs overwrite the heights of their cells, but well inside the level that the robot stands on: the outline of the floor beyond
//! that level's side is a guess where it was seen in part, and may reach across it.

use geometry::two_levels;
use settings::{settings, within};

use crate::{Sight, Terrain, cells::around};

settings! {
    /// Where stairs overwrite the heights that were seen.
    pub struct LaidStairsConfig("navigation.terrain.laid_stairs") {
        /// A cell lies well inside a level where no other one was seen so many cells around it.
        inside: usize = 2, "1", within(0.0, 20.0);
        /// So many cells around it must have been seen for that: more than at a level's border, where the ground beyond is hidden.
        seen: usize = 16, "1", within(0.0, 2000.0);
    }
}

/// Keeps its buffer.
#[derive(Debug, Clone, Default)]
pub(super) struct LaidStairs {
    /// Cells well inside the robot's own level that a lower stair reaches over.
    inside: Vec<usize>,
}

impl LaidStairs {
    pub(super) fn apply(
        &mut self,
        terrain: &mut Terrain,
        sight: &Sight<'_>,
        config: &LaidStairsConfig,
    ) {
        let (heights_m, treads_m) = (&mut terrain.height_m, &mut terrain.stairs.height_m);
        if !terrain.stairs.any {
            return;
        }
        let (robot_m, floor_m) = (sight.stand.height_m, terrain.needs.limits.floor_m);
        let size = [terrain.cols, heights_m.len() / terrain.cols];
        let is_lower = |tread_m: f32| f64::from(tread_m) - robot_m < -floor_m;
        let lower = (0..heights_m.len()).filter(|&index| is_lower(treads_m[index]));
        let inside = lower.filter(|&index| {
            let around = around(index, config.inside, size);
            let mut seen = 0;
            let same = around.into_iter().all(|cell| {
                let height_m = f64::from(heights_m[cell]);
                seen += usize::from(!height_m.is_nan());
                !two_levels(height_m, robot_m, floor_m)
            });
            same && seen >= config.seen
        });
        self.inside.clear();
        self.inside.extend(inside);
        for &index in &self.inside {
            let seen_m = heights_m[index];
            treads_m[index] = if seen_m.is_nan() {
                robot_m as f32
            } else {
                seen_m
            };
        }
        let heights = heights_m.iter_mut().zip(&mut terrain.sigma_m);
        for ((height, sigma_m), &tread) in heights.zip(treads_m.iter()) {
            if !tread.is_nan() {
                (*height, *sigma_m) = (tread, 0.0);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use mapping::Surface;

    use crate::testing::{Floor, cell, stair};

    #[test]
    fn a_stair_lies_over_what_was_seen_but_not_inside_the_robots_own_level() {
        let mut floor = Floor::new();
        floor.stairs.stairs = vec![stair(0.5, 0.4, 0.04, 0.6), stair(-1.0, 0.4, -0.04, 0.6)];
        floor.paint([0.6, -0.3], [0.7, 0.3], Surface::Unknown);
        let terrain = floor.after("laid_stairs");
        let level_m = |x_m: f64| terrain.level_m(cell(&terrain, x_m, 0.025));
        let stair_m = Some(f64::from(0.04_f32));
        assert_eq!((level_m(0.525), level_m(0.625)), (stair_m, stair_m));
        assert_eq!(level_m(-0.825), Some(0.0));
        floor.paint([-2.0, -2.0], [-0.55, 2.0], Surface::Unknown);
        let terrain = floor.after("laid_stairs");
        let level_m = terrain.level_m(cell(&terrain, -0.825, 0.025));
        assert_eq!(level_m, Some(f64::from(-0.04_f32)));
    }
}
