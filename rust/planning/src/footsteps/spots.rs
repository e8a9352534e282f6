//! Places of feet on the lattice.

use geometry::{Cell, PlanarPose};
use robot::Side;
use rustc_hash::FxHashMap;
use terrain::footholds::{Foothold, SoleSize};

/// A foot at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct StandingFoot {
    pub(super) side: Side,
    pub(super) pose: PlanarPose,
    /// The cell of its middle: in its centre, but at the start.
    pub(super) cell: Cell,
    pub(super) heading: usize,
    pub(super) foothold: Foothold,
}

impl StandingFoot {
    /// How much lower than its middle the lowest corner of a sole is that is as tilted as the ground under this one, m.
    pub(super) fn hangs_m(&self, sole: SoleSize) -> f64 {
        let [ahead, left] = self.foothold.slope.map(|rise| f64::from(rise).abs());
        0.5 * (ahead * sole.length_m + left * sole.width_m)
    }
}

/// A place on the lattice: cell of the map, and heading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FootSpot {
    pub(super) cell: Cell,
    pub(super) heading: usize,
    /// `None` where no sole stands.
    pub(super) foothold: Option<Foothold>,
}

/// Places that were come upon. Used again.
#[derive(Debug, Clone, Default)]
pub(super) struct Spots {
    pub(super) by_place: FxHashMap<(Cell, usize), u32>,
    pub(super) all: Vec<FootSpot>,
    /// From which node each one was reached as it was expanded last: the steps from it were looked at with the other foot there.
    pub(super) came_from: Vec<u32>,
}

impl Spots {
    /// Forgets all.
    pub(super) fn clear(&mut self) {
        self.by_place.clear();
        self.all.clear();
        self.came_from.clear();
    }
}
