//! Places that are now free and now blocked (004, section 36.4: states of a dynamic environment): a door that was seen shut may be open again later.
//!
//! What was floor and is blocked has two states. Blocked is believed for a while after something was last seen there; then which of the two it is is not
//! known, and who plans reckons with unknown ground, and looks at it when the way leads there. Where the floor was seen again since, but not all above it,
//! the room for the head is what has to be looked at: of a door that was opened a camera that looks down does not see that its upper part is gone.

#[cfg(test)]
mod tests;

use geometry::{Grid, Lattice, Map, Point, Pose, Robot};
use segmentation::Planes;
use settings::{NOT_NEGATIVE, at_least, settings};

use crate::{FloorView, HeadRoom, Surface};

settings! {
    /// Places that are now free and now blocked.
    pub struct ChangingConfig("navigation.changing") {
        /// What was floor and is seen blocked is believed to be so for this long after it was seen last, and twice as long each time that it is found blocked
        /// again, or until the robot gets its next goal; then it is unknown. 0: for ever.
        believed: f64 = 0.0, "s" of world, NOT_NEGATIVE;
        /// So many frames must have seen a cell's floor before, and see it again until it is believed to be free.
        seen_often: u16 = 4, "1", at_least(1.0);
        /// A frame sees a cell blocked of which it has so many points above that floor.
        points: u32 = 2, "1", at_least(1.0);
        /// They are higher above it than this, and lower than the robot is high.
        above: f64 = 0.03, "m", NOT_NEGATIVE;
    }
}

/// What is known of a cell's past.
#[derive(Debug, Clone, Copy, PartialEq)]
struct ChangingPlace {
    /// Height of the floor that was seen there, m; NaN where none was.
    floor_m: f32,
    /// When something was last seen on it, nanoseconds since the start; `None` before the first time, and since it was free again.
    blocked_ns: Option<u64>,
    /// How often it was found blocked.
    times: u32,
    /// Points of the present frame above its floor.
    points: u32,
    /// How many frames saw its floor, by the model, at the last one.
    sightings: u16,
    /// Frames that saw its floor since something was last seen on it.
    seen_again: u16,
    /// Whether there was reason to doubt that it is blocked since something was last seen on it.
    doubted: bool,
}

const NEVER_SEEN: ChangingPlace = ChangingPlace {
    floor_m: f32::NAN,
    blocked_ns: None,
    times: 0,
    points: 0,
    sightings: 0,
    seen_again: 0,
    doubted: false,
};

/// Remembers which cells were floor and were then blocked, in the window of a view.
#[derive(Debug, Clone)]
pub(crate) struct ChangingPlaces {
    config: ChangingConfig,
    /// Height of the robot, m.
    height_m: f64,
    lattice: Lattice,
    places: Grid<ChangingPlace>,
    now_ns: u64,
}

impl ChangingPlaces {
    /// Nothing was seen yet by a robot of this height, m.
    pub(crate) fn new(config: ChangingConfig, height_m: f64) -> Self {
        Self {
            config,
            height_m,
            lattice: Lattice::default(),
            places: Grid::filled(0, 0, NEVER_SEEN),
            now_ns: 0,
        }
    }

    /// Whether anything is to be remembered.
    pub(crate) const fn is_on(&self) -> bool {
        self.config.believed > 0.0
    }

    pub(crate) fn forget(&mut self) {
        self.places = Grid::filled(0, 0, NEVER_SEEN);
    }

    /// Believes no longer that what was seen blocked still is, until it is seen so again.
    pub(crate) fn doubt(&mut self) {
        for place in self.places.values_mut() {
            place.doubted = place.blocked_ns.is_some();
        }
    }

    /// Takes in what a model makes of the floor with a frame, and the frame itself.
    pub(crate) fn see(
        &mut self,
        view: &FloorView,
        planes: &Planes,
        map_from_robot: &Pose<Map, Robot>,
    ) {
        self.now_ns = planes.exposure_ns;
        self.follow_window(view);
        let seen = view.cells.values().iter().zip(view.sightings.values());
        for (place, (surface, &sightings)) in self.places.values_mut().iter_mut().zip(seen) {
            if sightings > place.sightings {
                place.seen_again = place.seen_again.saturating_add(1);
            }
            place.sightings = sightings;
            if let Surface::Floor(height_m) = surface
                && sightings >= self.config.seen_often
            {
                (place.floor_m, place.blocked_ns) = (*height_m, None);
                place.doubted = false;
            }
        }
        if planes.reliable {
            self.see_points(planes, map_from_robot);
        }
    }

    /// Shows in a view what is no longer believed to be blocked.
    pub(crate) fn show(&self, view: &mut FloorView) {
        let cells = view.cells.values_mut().iter_mut();
        let cells = cells.zip(view.head.values_mut());
        for (place, (surface, head)) in self.places.values().iter().zip(cells) {
            if !matches!(surface, Surface::Obstacle(_)) || !self.is_doubted(place) {
                continue;
            }
            if place.seen_again >= self.config.seen_often {
                (*surface, *head) = (Surface::Floor(place.floor_m), HeadRoom::Unseen);
            } else {
                *surface = Surface::Unknown;
            }
        }
    }

    /// Whether anything is not believed that the model has blocked.
    pub(crate) fn doubts(&self, view: &FloorView) -> bool {
        let mut places = self.places.values().iter().zip(view.cells.values());
        places.any(|(place, surface)| {
            matches!(surface, Surface::Obstacle(_)) && self.is_doubted(place)
        })
    }

    /// Whether it is not known if a place is blocked where the model has it so: nothing was seen there, or that was long ago, or the floor was seen since.
    fn is_doubted(&self, place: &ChangingPlace) -> bool {
        let believed_s = self.config.believed * libm::exp2(f64::from(place.times.max(1) - 1));
        let since_s = |blocked_ns| self.now_ns.saturating_sub(blocked_ns) as f64 * 1e-9;
        place.floor_m.is_finite()
            && (place.doubted
                || place.seen_again >= self.config.seen_often
                || place
                    .blocked_ns
                    .is_none_or(|blocked_ns| since_s(blocked_ns) > believed_s))
    }

    /// Moves with the window of a view.
    fn follow_window(&mut self, view: &FloorView) {
        let [cols, rows] = view.size();
        let same = (self.places.cols(), self.places.rows()) == (cols, rows)
            && self.lattice.cell_m == view.lattice.cell_m;
        if same {
            let [across, along] = [0, 1].map(|axis| {
                let by_m = view.lattice.origin_m[axis] - self.lattice.origin_m[axis];
                (by_m / view.lattice.cell_m).round() as i32
            });
            self.places.shift(across, along, &NEVER_SEEN);
        } else {
            self.places = Grid::filled(cols, rows, NEVER_SEEN);
        }
        self.lattice = view.lattice;
    }

    /// Notes which of the blocked cells a frame sees blocked.
    fn see_points(&mut self, planes: &Planes, map_from_robot: &Pose<Map, Robot>) {
        let heights_m = self.config.above..self.height_m;
        for point_m in &planes.points_in_robot_m {
            let [x, y, z] = point_m.map(f64::from);
            if !z.is_finite() {
                continue;
            }
            let at = (*map_from_robot * Point::<Robot>::new(x, y, z)).inner;
            let cell = self.lattice.cell_at(at.x, at.y);
            if let Some(place) = self.places.get_mut(cell)
                && heights_m.contains(&(at.z - f64::from(place.floor_m)))
            {
                place.points += 1;
            }
        }
        for index in 0..self.places.values().len() {
            let mut place = self.places.values()[index];
            if place.points >= self.config.points {
                let found = place.blocked_ns.is_none() || self.is_doubted(&place);
                place.times += u32::from(found);
                (place.blocked_ns, place.seen_again) = (Some(self.now_ns), 0);
                place.doubted = false;
            }
            place.points = 0;
            self.places.values_mut()[index] = place;
        }
    }
}
