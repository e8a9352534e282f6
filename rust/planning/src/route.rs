//! Where a path may end: in the goal's disc, or at the window's border when the goal lies outside.

use crate::Goal;
use crate::search::octile;
use crate::terrain::Terrain;

/// How much worse a place off the goal's middle is than walking there: above 1.09, so that the octile distance to the
/// middle stays below the cost.
pub(crate) const PULL: f64 = 2.0;
/// A floor this far from the goal's height is another level, m.
pub(crate) const LEVEL_M: f64 = 0.02;
/// What is paid for a goal on another level that nothing known leads to, m, and again for each `RISE_M` of height.
const BLIND_M: f64 = 1.0;
const RISE_M: f64 = 0.03;

/// The ends of a search.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ends<'a> {
    terrain: &'a Terrain,
    goal: Goal,
    /// What ending where nothing was seen costs on top, in cells: the level is another one there, and no way up is known.
    blind: f64,
    /// Cell that holds the goal's middle.
    middle: Option<usize>,
    /// Whether the goal's middle lies in the window.
    pub(crate) inside: bool,
}

impl<'a> Ends<'a> {
    /// Ends for a robot that stands `height_m` high, m; `climb_cost` as configured.
    pub(crate) fn new(terrain: &'a Terrain, goal: &Goal, height_m: f64, climb_cost: f64) -> Self {
        let missing_m = goal
            .height_m
            .map_or(0.0, |goal_m| (goal_m - height_m).abs());
        let blind_m = if missing_m > LEVEL_M {
            BLIND_M + climb_cost * missing_m / RISE_M
        } else {
            0.0
        };
        let middle = terrain.index_at([goal.x_m, goal.y_m]);
        Self {
            terrain,
            blind: blind_m / terrain.lattice.cell_m,
            goal: *goal,
            middle,
            inside: middle.is_some(),
        }
    }

    /// What ending in a cell costs, in cells; `None` where a path may not end.
    pub(crate) fn cost(&self, index: usize) -> Option<f64> {
        if index >= self.terrain.weights.len() {
            return Some(0.0); // the end of a climb; its link has the cost
        }
        if !self.inside {
            return self.terrain.on_border(index).then(|| self.remaining(index));
        }
        let [x, y] = self.terrain.center_m(index);
        let (dx, dy) = (x - self.goal.x_m, y - self.goal.y_m);
        let away = (dx * dx + dy * dy).sqrt();
        if away > self.goal.radius_m && self.middle != Some(index) {
            return None;
        }
        let on_level = match (self.goal.height_m, self.terrain.level_m(index)) {
            (Some(height), Some(level)) => (level - height).abs() <= LEVEL_M,
            _ => true,
        };
        let blind = if self.terrain.unknown[index] {
            self.blind
        } else {
            0.0
        };
        // A path is followed to a centimetre or two: stay off the disc's rim where there is room.
        on_level.then(|| PULL * away / self.terrain.lattice.cell_m + blind)
    }

    /// Whether ending in a cell is but a hope: the goal's level was not seen there.
    pub(crate) fn is_blind(&self, index: usize) -> bool {
        self.blind > 0.0
            && self
                .terrain
                .unknown
                .get(index)
                .is_some_and(|&unknown| unknown)
    }

    /// Octile distance from a cell to the goal's middle, in cells.
    pub(crate) fn remaining(&self, index: usize) -> f64 {
        if index >= self.terrain.weights.len() {
            return 0.0;
        }
        let [x, y] = self.terrain.center_m(index);
        octile(x - self.goal.x_m, y - self.goal.y_m) / self.terrain.lattice.cell_m
    }
}
