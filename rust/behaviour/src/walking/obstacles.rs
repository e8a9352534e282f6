//! Obstacles: what was not on the way before and is now.

use geometry::{PlanarPose, distance_m};
use mapping::FloorView;
use planning::Path;
use stairs::Staircase;
use terrain::support::{ObstacleCell, is_riser, obstacles_within};

use crate::walking::WalkingConfig;

/// The way that was followed at the last frame: planned with room to all that was known then.
#[derive(Debug, Clone, Default)]
pub(crate) struct Followed {
    points_m: Vec<[f64; 2]>,
}

impl Followed {
    /// Keeps the points of the path from the robot on.
    pub(crate) fn keep(&mut self, path: &Path, nearest: usize) {
        self.points_m.clear();
        self.points_m.extend_from_slice(&path.points_m[nearest..]);
    }

    /// Nothing is followed.
    pub(crate) fn forget(&mut self) {
        self.points_m.clear();
    }

    /// A place within the stopping distance where an obstacle that reaches above `above_m` now stands on the robot's way, m.
    pub(crate) fn obstacle_m(
        &self,
        view: &FloorView,
        stairs: &Staircase,
        (robot, above_m): (&PlanarPose, f64),
        config: &WalkingConfig,
    ) -> Option<[f64; 2]> {
        let tuning = &config.tuning.obstacles;
        let edges = tuning.edges();
        let near = |place: &&[f64; 2]| {
            distance_m(**place, [robot.x_m, robot.y_m]) < config.stopping_distance
        };
        self.points_m
            .iter()
            .filter(near)
            .find(|place| {
                let cells = obstacles_within(view, **place, config.corridor);
                let above = |cell: &ObstacleCell| f64::from(cell.1) > above_m;
                cells
                    .filter(|cell| above(cell) && !is_riser(stairs, cell, edges))
                    .count()
                    >= tuning.cells
            })
            .copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::climbing::simulation::stair as stair_at;
    use crate::walking::track::tests::straight;
    use crate::walking::tuning::WayObstaclesTuning;
    use crate::walking::unknown::tests::{paint, view};
    use mapping::Surface;
    use terrain::support::is_roomy;

    #[test]
    fn only_an_obstacle_on_the_way_and_near_is_reported() {
        let config = WalkingConfig::default();
        let path = straight([0.0, 0.0], [1.0, 0.0]);
        let mut followed = Followed::default();
        followed.keep(&path, 0);
        let robot = PlanarPose::default();
        let found = |followed: &Followed, view: &FloorView, robot: &PlanarPose| {
            followed.obstacle_m(view, &Staircase::default(), (robot, 0.0), &config)
        };
        let mut view = view(Surface::Floor(0.0));
        assert_eq!(found(&followed, &view, &robot), None);
        paint(&mut view, 0.7, 0.8, Surface::Obstacle(0.3));
        assert_eq!(found(&followed, &view, &robot), None);
        let near = PlanarPose::new(0.4, 0.0, 0.0);
        assert!(found(&followed, &view, &near).is_some());
        followed.forget();
        assert_eq!(found(&followed, &view, &near), None);
    }

    #[test]
    fn what_ends_below_the_ground_that_the_robot_walks_on_is_no_obstacle() {
        let config = WalkingConfig::default();
        let mut followed = Followed::default();
        followed.keep(&straight([0.0, 0.0], [1.0, 0.0]), 0);
        let (robot, stairs) = (PlanarPose::default(), Staircase::default());
        let mut view = view(Surface::Floor(0.03));
        paint(&mut view, 0.2, 0.3, Surface::Obstacle(0.0));
        for (ground_m, stands) in [(0.03, false), (0.0, true), (-0.03, true)] {
            let found = followed.obstacle_m(&view, &stairs, (&robot, ground_m - 0.012), &config);
            assert_eq!(found.is_some(), stands, "{ground_m}");
        }
    }

    /// Cell by cell such an area would take for ever.
    #[test]
    fn no_more_than_the_window_is_searched_for_obstacles() {
        let mut view = view(Surface::Floor(0.0));
        assert!(is_roomy(&view, [0.0, 0.0], 1e9) && is_roomy(&view, [1e12, 0.0], 1e9));
        paint(&mut view, 0.7, 0.8, Surface::Obstacle(0.3));
        assert!(!is_roomy(&view, [0.0, 0.0], 1e9) && is_roomy(&view, [0.0, 0.0], 0.6));
    }

    #[test]
    fn a_riser_is_no_obstacle_and_what_stands_on_a_stair_is() {
        let stair = |x_m: f64, height_m: f64| {
            let back_m = x_m + 0.12;
            stair_at([x_m, 0.0, 0.0], [back_m, 0.0, 0.0], height_m, 0.5)
        };
        let stairs = Staircase {
            stairs: vec![stair(0.5, 0.05), stair(0.62, 0.1)],
            ..Staircase::default()
        };
        let edges = WayObstaclesTuning::default().edges();
        // The riser before the toes, one behind the heels, and boxes at the edge, on the tread and beside the stair.
        for (place_m, top_m, edge) in [
            ([0.63, 0.1], 0.11, true),
            ([0.48, -0.1], 0.06, true),
            ([0.62, 0.0], 0.25, false),
            ([0.69, 0.0], 0.15, true),
            ([0.8, 0.0], 0.15, false),
            ([0.62, 0.4], 0.11, false),
        ] {
            let found = is_riser(&stairs, &(place_m, top_m), edges);
            assert_eq!(found, edge, "{place_m:?}");
        }
    }
}
