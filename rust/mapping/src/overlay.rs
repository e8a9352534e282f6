//! What the feet met, short slopes, and where things that move will be: the map keeps them whatever the camera makes of the place, since what is lower or shorter than a
//! picture tells apart looks like level floor. And what was free before it was blocked: it may be free again.
//!
//! Composed over any world model, which knows nothing of it: as long as there is nothing of it, the view is the model's own.

use geometry::{CellArea, Grid, Map, Pose, Robot, distance_m};
use meshes::TriangleMesh;
use segmentation::Planes;
use settings::{NOT_NEGATIVE, at_least, settings};

use crate::changing_places::{ChangingConfig, ChangingPlaces};
use crate::laid_bevels::lay;
use crate::{
    Bevel, FeltPlace, FloorView, ForeseenPlace, Insertion, MapError, Surface, Voxel, WorldModel,
};

settings! {
    /// What the map keeps of what the feet met.
    pub struct FeltConfig("navigation.felt") {
        /// What is met so near to a place where something was met before is the same thing.
        same_place: f64 = 0.04, "m", NOT_NEGATIVE;
        /// Places at which something was met are one thing where they are no further apart than this: a cable, not two toys.
        one_thing: f64 = 0.6, "m", NOT_NEGATIVE;
        /// So many places are kept; the oldest one is forgotten first.
        most: usize = 64, "1", at_least(1.0);
    }
}

/// A world model that keeps what the feet met, and short slopes.
pub struct Overlay {
    model: Box<dyn WorldModel>,
    config: FeltConfig,
    bevels: Vec<Bevel>,
    foreseen: Vec<ForeseenPlace>,
    changing: ChangingPlaces,
    /// The model's view with all that; `None` while there is nothing.
    view: Option<FloorView>,
}

impl Overlay {
    /// Over this model, for a robot of that height, m.
    pub fn new(
        model: Box<dyn WorldModel>,
        config: FeltConfig,
        changing: (ChangingConfig, f64),
    ) -> Self {
        Self {
            model,
            config,
            bevels: Vec::new(),
            foreseen: Vec::new(),
            changing: ChangingPlaces::new(changing.0, changing.1),
            view: None,
        }
    }

    /// Makes the view anew from the model's.
    fn renew(&mut self) {
        if let Some(view) = &mut self.view {
            let felt = std::mem::take(&mut view.felt);
            view.clone_from(self.model.view());
            view.felt = felt;
            self.changing.show(view);
            for bevel in &self.bevels {
                lay(bevel, view);
            }
            for place in &self.foreseen {
                block(place, view);
            }
        }
    }
}

/// Makes obstacles of the cells of a view that a place holds.
fn block(place: &ForeseenPlace, view: &mut FloorView) {
    let ([x_m, y_m], reach_m) = (place.at_m, place.radius_m);
    let lattice = view.lattice;
    let mut area = CellArea::of(lattice.cell_at(x_m - reach_m, y_m - reach_m));
    area.include(lattice.cell_at(x_m + reach_m, y_m + reach_m));
    for cell in area.within(view.cells.area()).cells() {
        let held = distance_m(lattice.center_of(cell), place.at_m) <= reach_m;
        if let Some(surface) = view.cells.get_mut(cell).filter(|_| held)
            && !matches!(surface, Surface::Obstacle(_))
        {
            *surface = Surface::Obstacle(place.top_m as f32);
        }
    }
}

/// Adds what was met, or what more is known of it where something was met before.
fn remember(places: &mut Vec<FeltPlace>, felt: FeltPlace, config: &FeltConfig) {
    let away_m = |known: &FeltPlace| distance_m(known.at_m, felt.at_m);
    if let Some(known) = (places.iter_mut()).find(|known| away_m(known) <= config.same_place) {
        known.top_m = known.top_m.max(felt.top_m);
        return;
    }
    if places.len() >= config.most {
        let _ = places.remove(0);
    }
    let beside = places
        .iter()
        .filter(|known| away_m(known) <= config.one_thing);
    let joined: Vec<usize> = beside.map(|known| known.thing).collect();
    let new = places.iter().map(|known| known.thing + 1).max();
    let thing = (joined.first().copied()).unwrap_or_else(|| new.unwrap_or(0));
    for known in places
        .iter_mut()
        .filter(|known| joined.contains(&known.thing))
    {
        known.thing = thing;
    }
    places.push(FeltPlace { thing, ..felt });
}

impl WorldModel for Overlay {
    fn insert(
        &mut self,
        planes: &Planes,
        map_from_robot: &Pose<Map, Robot>,
    ) -> Result<Insertion, MapError> {
        let insertion = self.model.insert(planes, map_from_robot)?;
        if self.changing.is_on() {
            let view = self.model.view();
            self.changing.see(view, planes, map_from_robot);
            if self.view.is_none() && self.changing.doubts(view) {
                self.view = Some(view.clone());
            }
        }
        self.renew();
        Ok(insertion)
    }

    fn view(&self) -> &FloorView {
        self.view.as_ref().unwrap_or_else(|| self.model.view())
    }

    fn feel(&mut self, felt: FeltPlace) {
        let view = self.view.get_or_insert_with(|| self.model.view().clone());
        remember(&mut view.felt, felt, &self.config);
    }

    fn lay(&mut self, bevels: &[Bevel]) {
        // What came in last has the same ones laid into it.
        if bevels == self.bevels {
            return;
        }
        self.bevels.clear();
        self.bevels.extend_from_slice(bevels);
        let _ = (self.view).get_or_insert_with(|| self.model.view().clone());
        self.renew();
    }

    fn foresee(&mut self, places: &[ForeseenPlace]) {
        if places == self.foreseen {
            return;
        }
        self.foreseen.clear();
        self.foreseen.extend_from_slice(places);
        let _ = (self.view).get_or_insert_with(|| self.model.view().clone());
        self.renew();
    }

    fn doubt(&mut self) {
        self.changing.doubt();
    }

    fn forget(&mut self) {
        self.view = None;
        self.foreseen.clear();
        self.bevels.clear();
        self.changing.forget();
        self.model.forget();
    }

    fn ceilings(&self) -> Option<Grid<f32>> {
        self.model.ceilings()
    }

    fn occupied(&self) -> Vec<Voxel> {
        self.model.occupied()
    }

    fn surface(&self) -> Option<TriangleMesh> {
        self.model.surface()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::felt_place::tests::MET;
    use crate::{Fog, FogConfig};

    fn model() -> Overlay {
        let fog = Fog::new(FogConfig::default()).unwrap();
        Overlay::new(
            Box::new(fog),
            FeltConfig::default(),
            (ChangingConfig::default(), 0.6),
        )
    }

    fn blank() -> Planes {
        Planes::new(0)
    }

    #[test]
    fn what_was_felt_stays_in_the_view_whatever_is_seen() {
        let mut map = model();
        assert!(map.view().felt.is_empty());
        map.feel(MET);
        for _ in 0..20 {
            let _ = map.insert(&blank(), &Pose::identity());
        }
        assert_eq!(map.view().felt, vec![MET]);
        assert_eq!(map.view().cells, map.model.view().cells);
        assert_eq!(map.view().at(0.5, 0.1), Surface::Unknown);
    }

    #[test]
    fn what_is_foreseen_is_an_obstacle_until_the_next_time_and_then_as_before() {
        let (mut map, mut without) = (model(), model());
        let place = ForeseenPlace {
            at_m: [0.5, 0.1],
            radius_m: 0.15,
            top_m: 1.0,
        };
        map.foresee(&[place]);
        let _ = map.insert(&blank(), &Pose::identity());
        assert_eq!(map.view().at(0.5, 0.2), Surface::Obstacle(1.0));
        assert_eq!(map.view().at(0.5, 0.3), Surface::Unknown);
        map.foresee(&[]);
        let _ = without.insert(&blank(), &Pose::identity());
        assert!(map.view().cells == without.view().cells);
    }

    #[test]
    fn who_found_itself_elsewhere_forgets_what_it_felt() {
        let mut map = model();
        map.feel(MET);
        map.forget();
        assert!(map.view().felt.is_empty());
    }

    #[test]
    fn the_same_place_is_kept_once_with_the_greatest_height_and_no_more_than_so_many() {
        let config = FeltConfig {
            most: 3,
            ..FeltConfig::default()
        };
        let mut places = Vec::new();
        let higher = FeltPlace {
            at_m: [0.51, 0.12],
            top_m: 0.02,
            ..MET
        };
        remember(&mut places, MET, &config);
        remember(&mut places, higher, &config);
        assert_eq!(places.len(), 1);
        assert_eq!((places[0].top_m, places[0].at_m), (0.02, MET.at_m));
        for far in 1..9 {
            let at_m = [0.5, 0.1 + f64::from(far)];
            remember(&mut places, FeltPlace { at_m, ..MET }, &config);
        }
        assert_eq!(places.len(), 3);
        assert_eq!(places[2].at_m, [0.5, 8.1]);
    }

    #[test]
    fn places_near_to_each_other_are_one_thing_and_one_between_two_things_joins_them() {
        let config = FeltConfig::default();
        let mut places = Vec::new();
        let mut things = |y_m: f64| {
            let at_m = [0.5, y_m];
            remember(&mut places, FeltPlace { at_m, ..MET }, &config);
            places.iter().map(|known| known.thing).collect::<Vec<_>>()
        };
        assert_eq!(things(0.0), [0]);
        assert_eq!(things(1.0), [0, 1], "two toys");
        assert_eq!(things(1.5), [0, 1, 1]);
        assert_eq!(things(0.5), [0, 0, 0, 0], "a cable");
    }
}
