//! What the map that is known beforehand says of ground that was not seen yet (002, III.A: prior knowledge for planning).

use mapping::{FloorView, Surface};
use volume::SolidVoxels;

use super::floors::Floors;

/// Floor of the map that differs by no more than this from the robot's is its level, m.
const LEVEL_M: f64 = 0.02;
/// Where the map has floor within this above or below the robot's nothing stands: it is another level, m.
const OTHER_LEVEL_M: f64 = 0.5;
/// What is lower above the robot's floor is no obstacle, m.
const STEP_M: f64 = 0.1;
/// So far from the map's steps nothing that is seen is a riser, m: the robot may be as far off, and its camera at an angle.
const STAIRS_M: f64 = 0.25;
/// Prior floor counts as seen so often.
const SIGHTINGS: u16 = u16::MAX;

/// Lays the map's floor and obstacles, on the robot's level, under what was seen, and says of what was seen that it is no riser.
#[derive(Debug, Clone)]
pub(super) struct Prior {
    solid: SolidVoxels,
    /// Of a body without a width.
    floors: Floors,
    /// For each column whether steps of the map are near.
    has_steps: Vec<bool>,
    height_m: f64,
}

impl Prior {
    pub(super) fn new(solid: &SolidVoxels, height_m: f64) -> Self {
        let floors = Floors::new(solid, [0.0, height_m]);
        Self {
            has_steps: floors.columns_near_steps(STAIRS_M),
            floors,
            solid: solid.clone(),
            height_m,
        }
    }

    /// A view, with the map's floor and obstacles where it is unknown. The floor has the height that the robot believes to stand on.
    /// What stands on floor of the map, away from its steps, is as tall as the robot: who would have to come near to see that a low
    /// thing is no riser sees someone who has stepped in the way too late.
    pub(super) fn laid_under(&self, view: &FloorView, robot_m: [f64; 3]) -> FloorView {
        let mut laid = view.clone();
        let Some(under) = self.floors.under(robot_m, |_| true) else {
            return laid;
        };
        let [.., level_m] = self.floors.at_m(under);
        let area = laid.cells.area();
        for cell in area.cells() {
            let (Some(slot), Some(count)) =
                (laid.cells.get_mut(cell), laid.sightings.get_mut(cell))
            else {
                continue;
            };
            let at_m = laid.lattice.center_of(cell);
            let tall = Surface::Obstacle((robot_m[2] + self.height_m) as f32);
            match (*slot, self.surface(at_m, level_m)) {
                (Surface::Unknown, Surface::Floor(_)) => {
                    (*slot, *count) = (Surface::Floor(robot_m[2] as f32), SIGHTINGS);
                }
                (Surface::Unknown, Surface::Obstacle(_)) => (*slot, *count) = (tall, 0),
                (Surface::Obstacle(_), Surface::Floor(_)) if !self.has_steps(at_m) => *slot = tall,
                _ => {}
            }
        }
        laid
    }

    /// Whether steps of the map are near a place.
    fn has_steps(&self, at_m: [f64; 2]) -> bool {
        (self.floors.column_at(at_m)).is_none_or(|column| self.has_steps[column])
    }

    /// What the map has at a place for who stands on a level, m.
    fn surface(&self, at_m: [f64; 2], level_m: f64) -> Surface {
        let Some(column) = self.floors.column_at(at_m) else {
            return Surface::Unknown;
        };
        let mut other = false;
        for height_m in self.floors.heights_m(column) {
            let off_m = (height_m - level_m).abs();
            if off_m <= LEVEL_M {
                return Surface::Floor(height_m as f32);
            }
            other |= off_m <= OTHER_LEVEL_M;
        }
        let layer = |height_m: f64| {
            ((level_m + height_m - self.solid.corner_m([0; 3])[2]) / self.solid.resolution_m())
                .floor() as i64
        };
        let [x, y] = self.floors.cell_of(column).map(|at| at as i64);
        let stands = (layer(STEP_M)..layer(self.height_m)).any(|z| self.solid.is_solid([x, y, z]));
        if stands && !other {
            Surface::Obstacle((level_m + self.height_m) as f32)
        } else {
            Surface::Unknown
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::{Grid, Lattice};

    #[test]
    fn the_robots_level_is_floor_walls_stand_and_other_levels_stay_unknown() {
        let boxes = [
            [[0.0, 0.0, -0.04], [2.0, 1.0, 0.0]],
            // A wall, an upper level, a deck that one can walk under.
            [[0.96, 0.0, 0.0], [1.0, 1.0, 0.6]],
            [[0.0, 0.6, 0.0], [0.4, 1.0, 0.36]],
            [[1.4, 0.0, 0.72], [2.0, 1.0, 0.76]],
        ];
        let prior = Prior::new(&SolidVoxels::of_boxes(&boxes, 0.04).unwrap(), 0.58);
        let view = FloorView {
            lattice: Lattice {
                origin_m: [0.0, 0.0],
                cell_m: 0.04,
            },
            cells: Grid::filled(50, 25, Surface::Unknown),
            sightings: Grid::filled(50, 25, 0),
            gradients: Grid::filled(50, 25, [0.0; 2]),
        };
        let below = prior.laid_under(&view, [0.6, 0.3, 0.003]);
        assert_eq!(below.at(0.3, 0.3), Surface::Floor(0.003));
        assert!(matches!(below.at(0.98, 0.5), Surface::Obstacle(_)));
        assert_eq!(below.at(0.2, 0.8), Surface::Unknown);
        assert_eq!(below.at(1.7, 0.5), Surface::Floor(0.003));
        let above = prior.laid_under(&view, [0.2, 0.8, 0.36]);
        assert_eq!(above.at(0.3, 0.7), Surface::Floor(0.36));
        assert_eq!(above.at(0.3, 0.3), Surface::Unknown);
        // What was seen stays.
        let mut seen = view;
        seen.cells.values_mut().fill(Surface::Floor(0.03));
        assert_eq!(prior.laid_under(&seen, [0.6, 0.3, 0.0]), seen);
    }

    #[test]
    fn what_stands_on_the_maps_floor_is_no_riser_but_beside_steps_it_may_be() {
        let boxes = [
            [[0.0, 0.0, -0.04], [2.0, 1.0, 0.0]],
            [[1.6, 0.0, 0.0], [2.0, 1.0, 0.04]],
        ];
        let prior = Prior::new(&SolidVoxels::of_boxes(&boxes, 0.04).unwrap(), 0.58);
        let view = FloorView {
            lattice: Lattice {
                origin_m: [0.0, 0.0],
                cell_m: 0.04,
            },
            cells: Grid::filled(50, 25, Surface::Obstacle(0.05)),
            sightings: Grid::filled(50, 25, 3),
            gradients: Grid::filled(50, 25, [0.0; 2]),
        };
        let laid = prior.laid_under(&view, [0.6, 0.3, 0.0]);
        assert_eq!(laid.at(1.0, 0.5), Surface::Obstacle(0.58));
        assert_eq!(laid.at(1.5, 0.5), Surface::Obstacle(0.05));
        assert_eq!(laid.sightings, view.sightings);
    }
}
