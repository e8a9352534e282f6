//! What lies ahead on the path: the unknown, and what was not there before.

use geometry::PlanarPose;
use mapping::{FloorView, Surface};
use planning::Path;
use stairs::Staircase;

use crate::walking::WalkingConfig;
use crate::walking::track::{Track, length};

/// A place that is still unknown after it was looked at counts as looked at within this distance, m.
const LOOKED_RADIUS_M: f64 = 0.12;
const LOOKED_PLACES: usize = 32;
/// Half the distance between the outer edges of the feet, m, as far as the ground matters.
const FOOT_SIDE_M: f64 = 0.06;
/// What is no higher above a stair than this, m,
const RISER_M: f64 = 0.06;
/// and no further from its edge than this, m, is the edge.
const BESIDE_M: f64 = 0.06;
/// What ends further than this below the ground that the robot walks on does not stand in its way, m.
const BELOW_M: f64 = 0.015;

/// The places looked at lately, in a ring.
#[derive(Debug, Clone, Default)]
pub(crate) struct Looked {
    places_m: Vec<[f64; 2]>,
    next: usize,
}

impl Looked {
    /// Whether this place was looked at.
    pub(crate) fn holds(&self, place_m: [f64; 2]) -> bool {
        self.places_m
            .iter()
            .any(|p| (p[0] - place_m[0]).hypot(p[1] - place_m[1]) < LOOKED_RADIUS_M)
    }

    fn add(&mut self, place_m: [f64; 2]) {
        if self.holds(place_m) {
            return;
        }
        if self.places_m.len() < LOOKED_PLACES {
            self.places_m.push(place_m);
        } else {
            self.places_m[self.next] = place_m;
            self.next = (self.next + 1) % LOOKED_PLACES;
        }
    }

    /// Marks everything unknown ahead: it has been looked at now.
    pub(crate) fn mark(
        &mut self,
        path: &Path,
        track: &Track,
        view: &FloorView,
        config: &WalkingConfig,
    ) {
        for place_m in unknown_places(path, track, view, config) {
            self.add(place_m);
        }
    }
}

/// Unknown places of the path from where the camera can see the ground to the distance in which it has to be known.
fn unknown_places<'a>(
    path: &'a Path,
    track: &Track,
    view: &'a FloorView,
    config: &'a WalkingConfig,
) -> impl Iterator<Item = [f64; 2]> + 'a {
    let [x, y] = track.offset_m;
    let mut along_m = x.hypot(y);
    let nearest = track.nearest;
    (nearest + 1..path.points_m.len())
        .map(move |index| {
            along_m += length(path, index);
            (index, along_m)
        })
        .skip_while(|&(_, along_m)| along_m < config.unseen_radius)
        .take_while(|&(_, along_m)| along_m <= config.look_distance)
        .filter(|&(index, _)| is_unknown(path, index, view))
        .map(|(index, _)| path.points_m[index])
}

/// Whether most of the ground across the path is unknown here.
fn is_unknown(path: &Path, index: usize, view: &FloorView) -> bool {
    let ([x0, y0], [x, y]) = (path.points_m[index - 1], path.points_m[index]);
    let heading = PlanarPose::new(x, y, (y - y0).atan2(x - x0));
    let unknown = [-FOOT_SIDE_M, 0.0, FOOT_SIDE_M]
        .into_iter()
        .filter(|&side_m| {
            let (x, y) = heading.apply(0.0, side_m);
            view.at(x, y) == Surface::Unknown
        });
    unknown.count() >= 2
}

/// The first unknown place ahead that has not been looked at, and whether there is one that has.
pub(crate) fn unknown_ahead(
    path: &Path,
    track: &Track,
    view: &FloorView,
    looked: &Looked,
    config: &WalkingConfig,
) -> (Option<[f64; 2]>, bool) {
    let mut stays_unknown = false;
    for place_m in unknown_places(path, track, view, config) {
        if !looked.holds(place_m) {
            return (Some(place_m), stays_unknown);
        }
        stays_unknown = true;
    }
    (None, stays_unknown)
}

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

    /// A place within the stopping distance where an obstacle now stands on the way of a robot on this ground, m.
    pub(crate) fn obstacle_m(
        &self,
        view: &FloorView,
        stairs: &Staircase,
        (robot, ground_m): (&PlanarPose, f64),
        config: &WalkingConfig,
    ) -> Option<[f64; 2]> {
        let near = |place: &&[f64; 2]| {
            (place[0] - robot.x_m).hypot(place[1] - robot.y_m) < config.stopping_distance
        };
        self.points_m
            .iter()
            .filter(near)
            .find(|place| {
                let cells = obstacles(view, **place, config.corridor);
                let above = |cell: &Obstacle| f64::from(cell.1) > ground_m - BELOW_M;
                cells
                    .filter(|cell| above(cell) && !is_edge(stairs, cell))
                    .count()
                    >= 2
            })
            .copied()
    }
}

/// Whether no obstacle is known within this distance of a place.
pub(crate) fn is_roomy(view: &FloorView, place_m: [f64; 2], radius_m: f64) -> bool {
    obstacles(view, place_m, radius_m).next().is_none()
}

/// An obstacle cell: its middle and its height, m.
pub(crate) type Obstacle = ([f64; 2], f32);

fn obstacles(
    view: &FloorView,
    [x, y]: [f64; 2],
    radius_m: f64,
) -> impl Iterator<Item = Obstacle> + '_ {
    let (low, high) = (
        view.lattice.cell_at(x - radius_m, y - radius_m),
        view.lattice.cell_at(x + radius_m, y + radius_m),
    );
    let area = geometry::CellArea {
        min: low,
        max: high,
    };
    // Settings may ask for more room than the window shows: beyond it nothing is known.
    area.within(view.cells.area())
        .cells()
        .filter_map(|cell| match view.cell(cell) {
            Surface::Obstacle(top_m) => Some((view.lattice.center_of(cell), top_m)),
            _ => None,
        })
        .filter(move |([cx, cy], _)| (cx - x).hypot(cy - y) < radius_m)
}

/// Whether an obstacle is only the riser of a stair, or what the depth image makes of its edge.
pub(crate) fn is_edge(stairs: &Staircase, (place_m, top_m): &Obstacle) -> bool {
    stairs.stairs.iter().any(|stair| {
        let low = f64::from(*top_m) < stair.height_m() + RISER_M;
        low && [&stair.front, &stair.back].into_iter().any(|edge| {
            let middle = edge.middle().inner;
            let along_m = (place_m[0] - middle.x).hypot(place_m[1] - middle.y);
            edge.beyond_m(*place_m).abs() < BESIDE_M && along_m < 0.5 * edge.length_m() + BESIDE_M
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::climbing::simulation::stair as stair_at;
    use crate::walking::track::tests::straight;
    use geometry::{Grid, Lattice};

    fn view(surface: Surface) -> FloorView {
        FloorView {
            lattice: Lattice {
                origin_m: [-2.0, -2.0],
                cell_m: 0.04,
            },
            cells: Grid::filled(100, 100, surface),
            sightings: Grid::filled(100, 100, 1),
            gradients: Grid::filled(100, 100, [0.0; 2]),
        }
    }

    fn paint(view: &mut FloorView, from_x_m: f64, to_x_m: f64, surface: Surface) {
        for cell in view.cells.area().cells() {
            let [x, _] = view.lattice.center_of(cell);
            if x > from_x_m && x < to_x_m {
                *view.cells.get_mut(cell).unwrap() = surface;
            }
        }
    }

    #[test]
    fn unknown_ground_is_found_until_it_was_looked_at() {
        let config = WalkingConfig::default();
        let mut view = view(Surface::Floor(0.0));
        paint(&mut view, 0.3, 0.4, Surface::Unknown);
        let path = straight([0.0, 0.0], [1.0, 0.0]);
        let track = Track::new(&path, &PlanarPose::default(), 0.25).unwrap();
        let mut looked = Looked::default();
        let (place, stays) = unknown_ahead(&path, &track, &view, &looked, &config);
        assert!(place.is_some_and(|p| p[0] > 0.27 && p[0] < 0.42) && !stays);
        looked.mark(&path, &track, &view, &config);
        assert_eq!(
            unknown_ahead(&path, &track, &view, &looked, &config),
            (None, true)
        );
    }

    #[test]
    fn far_unknown_ground_and_the_ground_below_the_view_are_left_alone() {
        let config = WalkingConfig::default();
        let mut view = view(Surface::Floor(0.0));
        paint(&mut view, -1.0, 0.14, Surface::Unknown);
        paint(&mut view, 0.6, 1.5, Surface::Unknown);
        let path = straight([0.0, 0.0], [1.0, 0.0]);
        let track = Track::new(&path, &PlanarPose::default(), 0.25).unwrap();
        let found = unknown_ahead(&path, &track, &view, &Looked::default(), &config);
        assert_eq!(found, (None, false));
    }

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
            let found = followed.obstacle_m(&view, &stairs, (&robot, ground_m), &config);
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
        // The riser before the toes, one behind the heels, and boxes at the edge, on the tread and beside the stair.
        for (place_m, top_m, edge) in [
            ([0.63, 0.1], 0.11, true),
            ([0.48, -0.1], 0.06, true),
            ([0.62, 0.0], 0.25, false),
            ([0.69, 0.0], 0.15, true),
            ([0.8, 0.0], 0.15, false),
            ([0.62, 0.4], 0.11, false),
        ] {
            assert_eq!(is_edge(&stairs, &(place_m, top_m)), edge, "{place_m:?}");
        }
    }
}
