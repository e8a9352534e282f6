//! Unknown ground ahead on the path: it is looked at before it is walked on.

use geometry::{PlanarPose, distance_m};
use mapping::FloorView;
use planning::Path;
use terrain::support::unknown_across;

use crate::walking::WalkingConfig;
use crate::walking::track::{Track, length};
use crate::walking::tuning::UnknownGroundTuning;

/// The places looked at lately, in a ring.
#[derive(Debug, Clone, Default)]
pub(crate) struct Looked {
    places_m: Vec<[f64; 2]>,
    next: usize,
}

impl Looked {
    /// Whether this place was looked at.
    pub(super) fn holds(&self, place_m: [f64; 2], radius_m: f64) -> bool {
        self.places_m
            .iter()
            .any(|&looked_m| distance_m(looked_m, place_m) < radius_m)
    }

    pub(super) fn add(&mut self, place_m: [f64; 2], tuning: &UnknownGroundTuning) {
        if self.holds(place_m, tuning.looked_radius) {
            return;
        }
        if self.places_m.len() < tuning.looked_places {
            self.places_m.push(place_m);
        } else {
            self.places_m[self.next] = place_m;
            self.next = (self.next + 1) % tuning.looked_places;
        }
    }

    /// Marks everything unknown ahead: it has been looked at now.
    pub(crate) fn mark(
        &mut self,
        path: &Path,
        track: &Track,
        view: &FloorView,
        config: &WalkingConfig,
        foot_side_m: f64,
    ) {
        for place_m in unknown_places(path, track, view, config, foot_side_m) {
            self.add(place_m, &config.tuning.unknown);
        }
    }
}

/// Unknown places of the path from where the camera can see the ground to the distance in which it has to be known.
fn unknown_places<'a>(
    path: &'a Path,
    track: &Track,
    view: &'a FloorView,
    config: &'a WalkingConfig,
    foot_side_m: f64,
) -> impl Iterator<Item = [f64; 2]> + 'a {
    let [x, y] = track.offset_m;
    let mut along_m = geometry::hypot(x, y);
    let nearest = track.nearest;
    let across = config.tuning.unknown.across;
    (nearest + 1..path.points_m.len())
        .map(move |index| {
            along_m += length(path, index);
            (index, along_m)
        })
        .skip_while(|&(_, along_m)| along_m < config.unseen_radius)
        .take_while(|&(_, along_m)| along_m <= config.look_distance)
        .filter(move |&(index, _)| is_unknown(path, index, view, foot_side_m, across))
        .map(|(index, _)| path.points_m[index])
}

/// Whether the ground here is unknown at so many of three places across the path.
fn is_unknown(
    path: &Path,
    index: usize,
    view: &FloorView,
    foot_side_m: f64,
    across: usize,
) -> bool {
    let ([x0, y0], [x, y]) = (path.points_m[index - 1], path.points_m[index]);
    let heading = PlanarPose::new(x, y, libm::atan2(y - y0, x - x0));
    unknown_across(view, &heading, &[-foot_side_m, 0.0, foot_side_m]) >= across
}

/// The first unknown place ahead that has not been looked at, and whether there is one that has.
pub(crate) fn unknown_ahead(
    path: &Path,
    track: &Track,
    view: &FloorView,
    looked: &Looked,
    config: &WalkingConfig,
    foot_side_m: f64,
) -> (Option<[f64; 2]>, bool) {
    let mut stays_unknown = false;
    for place_m in unknown_places(path, track, view, config, foot_side_m) {
        if !looked.holds(place_m, config.tuning.unknown.looked_radius) {
            return (Some(place_m), stays_unknown);
        }
        stays_unknown = true;
    }
    (None, stays_unknown)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::walking::track::tests::{config_of_tests, straight};
    use geometry::{Grid, Lattice};
    use mapping::Surface;

    const FOOT_SIDE_M: f64 = 0.06;

    pub(crate) fn view(surface: Surface) -> FloorView {
        FloorView::new(
            Lattice {
                origin_m: [-2.0, -2.0],
                cell_m: 0.04,
            },
            Grid::filled(100, 100, surface),
            1,
        )
    }

    pub(crate) fn paint(view: &mut FloorView, from_x_m: f64, to_x_m: f64, surface: Surface) {
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
        let track = Track::new(&path, &PlanarPose::default(), &config_of_tests()).unwrap();
        let mut looked = Looked::default();
        let (place, stays) = unknown_ahead(&path, &track, &view, &looked, &config, FOOT_SIDE_M);
        assert!(place.is_some_and(|p| p[0] > 0.27 && p[0] < 0.42) && !stays);
        looked.mark(&path, &track, &view, &config, FOOT_SIDE_M);
        assert_eq!(
            unknown_ahead(&path, &track, &view, &looked, &config, FOOT_SIDE_M),
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
        let track = Track::new(&path, &PlanarPose::default(), &config_of_tests()).unwrap();
        let found = unknown_ahead(
            &path,
            &track,
            &view,
            &Looked::default(),
            &config,
            FOOT_SIDE_M,
        );
        assert_eq!(found, (None, false));
    }
}
