//! Where a path may end: in the goal's disc, or at the window's border when the goal lies outside.

use mapping::{FloorView, Surface};

use crate::Goal;
use crate::search::octile;
use crate::terrain::Terrain;

/// How much worse a place off the goal's middle is than walking there: above 1.09, so that the octile distance to the
/// middle stays below the cost.
const PULL: f64 = 2.0;
/// A floor this far from the goal's height is another level, m.
const LEVEL: f32 = 0.02;

/// The ends of a search.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ends<'a> {
    terrain: &'a Terrain,
    view: &'a FloorView,
    goal: Goal,
    /// Cell that holds the goal's middle.
    middle: Option<usize>,
    /// Whether the goal's middle lies in the window.
    pub(crate) inside: bool,
}

impl<'a> Ends<'a> {
    pub(crate) fn new(terrain: &'a Terrain, view: &'a FloorView, goal: &Goal) -> Self {
        let middle = terrain.index_at([goal.x_m, goal.y_m]);
        Self {
            terrain,
            view,
            goal: *goal,
            middle,
            inside: middle.is_some(),
        }
    }

    /// What ending in a cell costs, in cells; `None` where a path may not end.
    pub(crate) fn cost(&self, index: usize) -> Option<f64> {
        if !self.inside {
            return self.terrain.on_border(index).then(|| self.remaining(index));
        }
        let [x, y] = self.terrain.center_m(index);
        let (dx, dy) = (x - self.goal.x_m, y - self.goal.y_m);
        let away = (dx * dx + dy * dy).sqrt();
        if away > self.goal.radius_m && self.middle != Some(index) {
            return None;
        }
        let on_level = match (self.goal.height_m, self.view.cells.values()[index]) {
            (Some(height), Surface::Floor(floor)) => (floor - height as f32).abs() <= LEVEL,
            _ => true,
        };
        // A path is followed to a centimetre or two: stay off the disc's rim where there is room.
        on_level.then(|| PULL * away / self.terrain.lattice.cell_m)
    }

    /// Octile distance from a cell to the goal's middle, in cells.
    pub(crate) fn remaining(&self, index: usize) -> f64 {
        let [x, y] = self.terrain.center_m(index);
        octile(x - self.goal.x_m, y - self.goal.y_m) / self.terrain.lattice.cell_m
    }
}
