//! The known map laid under what was seen (002, III.A: prior knowledge for planning).

use known_map::{Expected, Prior};
use mapping::{FloorView, Surface};

/// Floor of the known map counts as seen so often.
const SIGHTINGS: u16 = u16::MAX;

/// A view, with the map's floor and obstacles where it is unknown. The floor has the height that the robot believes to stand on.
/// What stands on floor of the map, away from its steps, is as tall as the robot: who would have to come near to see that a low
/// thing is no riser sees someone who has stepped in the way too late.
pub(super) fn laid_under(prior: &Prior, view: &FloorView, robot_m: [f64; 3]) -> FloorView {
    let mut laid = view.clone();
    let Some(level_m) = prior.level_under(robot_m) else {
        return laid;
    };
    let area = laid.cells.area();
    for cell in area.cells() {
        let (Some(slot), Some(count)) = (laid.cells.get_mut(cell), laid.sightings.get_mut(cell))
        else {
            continue;
        };
        let at_m = laid.lattice.center_of(cell);
        let tall = Surface::Obstacle((robot_m[2] + prior.height_m()) as f32);
        match (*slot, prior.at(at_m, level_m)) {
            (Surface::Unknown, Expected::Floor) => {
                (*slot, *count) = (Surface::Floor(robot_m[2] as f32), SIGHTINGS);
            }
            (Surface::Unknown, Expected::Obstacle) => (*slot, *count) = (tall, 0),
            (Surface::Obstacle(_), Expected::Floor) if !prior.has_steps(at_m) => *slot = tall,
            _ => {}
        }
    }
    laid
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::{Grid, Lattice};
    use known_map::KnownMap;

    #[test]
    fn the_robots_level_is_floor_walls_stand_and_other_levels_stay_unknown() {
        let boxes = [
            [[0.0, 0.0, -0.04], [2.0, 1.0, 0.0]],
            // A wall, an upper level, a deck that one can walk under.
            [[0.96, 0.0, 0.0], [1.0, 1.0, 0.6]],
            [[0.0, 0.6, 0.0], [0.4, 1.0, 0.36]],
            [[1.4, 0.0, 0.72], [2.0, 1.0, 0.76]],
        ];
        let prior = KnownMap::of_boxes(&boxes, 0.04)
            .unwrap()
            .prior(0.58)
            .unwrap();
        let view = FloorView::new(
            Lattice {
                origin_m: [0.0, 0.0],
                cell_m: 0.04,
            },
            Grid::filled(50, 25, Surface::Unknown),
            0,
        );
        let below = laid_under(&prior, &view, [0.6, 0.3, 0.003]);
        assert_eq!(below.at(0.3, 0.3), Surface::Floor(0.003));
        assert!(matches!(below.at(0.98, 0.5), Surface::Obstacle(_)));
        assert_eq!(below.at(0.2, 0.8), Surface::Unknown);
        assert_eq!(below.at(1.7, 0.5), Surface::Floor(0.003));
        let above = laid_under(&prior, &view, [0.2, 0.8, 0.36]);
        assert_eq!(above.at(0.3, 0.7), Surface::Floor(0.36));
        assert_eq!(above.at(0.3, 0.3), Surface::Unknown);
        // What was seen stays.
        let mut seen = view;
        seen.cells.values_mut().fill(Surface::Floor(0.03));
        assert_eq!(laid_under(&prior, &seen, [0.6, 0.3, 0.0]), seen);
    }

    #[test]
    fn what_stands_on_the_maps_floor_is_no_riser_but_beside_steps_it_may_be() {
        let boxes = [
            [[0.0, 0.0, -0.04], [2.0, 1.0, 0.0]],
            [[1.6, 0.0, 0.0], [2.0, 1.0, 0.04]],
        ];
        let prior = KnownMap::of_boxes(&boxes, 0.04)
            .unwrap()
            .prior(0.58)
            .unwrap();
        let view = FloorView::new(
            Lattice {
                origin_m: [0.0, 0.0],
                cell_m: 0.04,
            },
            Grid::filled(50, 25, Surface::Obstacle(0.05)),
            3,
        );
        let laid = laid_under(&prior, &view, [0.6, 0.3, 0.0]);
        assert_eq!(laid.at(1.0, 0.5), Surface::Obstacle(0.58));
        assert_eq!(laid.at(1.5, 0.5), Surface::Obstacle(0.05));
        assert_eq!(laid.sightings, view.sightings);
    }
}
