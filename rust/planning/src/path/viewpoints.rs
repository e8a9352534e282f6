//! Where to go and look when no known way leads to the goal: unseen ground, edges of levels that nothing is known to join.

use terrain::Terrain;

use super::ends::PathEnds;
use crate::Goal;
use crate::climb_links::{ClimbLinks, Fit};
use crate::search::{Graph, Route, Search};
use crate::tuning::ViewpointsTuning;

/// The places that were looked from. Reused.
#[derive(Debug, Clone, Default)]
pub(crate) struct Viewpoints {
    tuning: ViewpointsTuning,
    looked_m: Vec<[f64; 2]>,
    goal: Option<Goal>,
    frames: u32,
    /// Cells from which something may be seen.
    worth: Vec<bool>,
}

impl Viewpoints {
    /// Nothing was looked at yet.
    pub(crate) fn new(tuning: ViewpointsTuning) -> Self {
        Self {
            tuning,
            ..Self::default()
        }
    }

    /// Forgets what was looked at.
    pub(crate) fn forget(&mut self) {
        *self = Self::new(self.tuning.clone());
    }

    /// Says that the robot stands at `at_m` on its way to look from `end_m`; true once it has seen what there is to see.
    pub(crate) fn arrive(&mut self, at_m: [f64; 2], end_m: [f64; 2]) -> bool {
        if geometry::hypot(at_m[0] - end_m[0], at_m[1] - end_m[1]) > self.tuning.there {
            self.frames = 0;
            return false;
        }
        self.frames += 1;
        if self.frames < self.tuning.frames {
            return false;
        }
        self.frames = 0;
        self.looked_m.push(end_m);
        true
    }

    /// Another goal is another search.
    pub(crate) fn begin(&mut self, goal: &Goal) {
        if self.goal != Some(*goal) {
            self.goal = Some(*goal);
            self.looked_m.clear();
            self.frames = 0;
        }
    }

    /// The places that were looked from, m.
    pub(crate) fn looked_m(&self) -> &[[f64; 2]] {
        &self.looked_m
    }

    /// The way to the best place to look from.
    pub(crate) fn route(
        &mut self,
        search: &mut Search,
        terrain: &Terrain,
        links: &ClimbLinks,
        ends: &PathEnds<'_>,
        start: usize,
    ) -> Option<Route> {
        self.read(terrain);
        let graph = Graph {
            weights: &terrain.weights,
            cols: terrain.cols,
            links: Some(&links.links),
        };
        // What ends a climb with nothing known behind it was no way to the goal: it has no place here.
        let open = |link: usize| {
            let way = links.way(link);
            way.fit == Fit::Holds && way.leave_m.is_some()
        };
        let ending = |cell: usize| self.cost(ends, cell);
        search.run_linked(graph, open, start, ending, |cell| ends.remaining(cell))
    }

    /// Finds the cells from which something may be seen.
    fn read(&mut self, terrain: &Terrain) {
        let (patch, seen_m) = (self.tuning.patch, self.tuning.seen);
        self.worth.clear();
        self.worth.resize(terrain.weights.len(), false);
        for index in 0..self.worth.len() {
            if terrain.is_open_edge(index) {
                self.mark_around(terrain, index);
            } else if terrain.unknown[index]
                && around(terrain, index, patch, |cell| terrain.unknown[cell])
            {
                self.worth[index] = true;
            }
        }
        for (index, worth) in self.worth.iter_mut().enumerate() {
            let place_m = terrain.center_m(index);
            let seen = |at_m: &[f64; 2]| {
                geometry::hypot(place_m[0] - at_m[0], place_m[1] - at_m[1]) <= seen_m
            };
            *worth =
                *worth && terrain.weights[index].is_finite() && !self.looked_m.iter().any(seen);
        }
    }

    fn mark_around(&mut self, terrain: &Terrain, index: usize) {
        let (worth, near) = (&mut self.worth, self.tuning.edge);
        let _ = around(terrain, index, near, |cell| {
            worth[cell] = true;
            true
        });
    }

    /// What ending in a cell costs, in cells; `None` where there is nothing to see.
    fn cost(&self, ends: &PathEnds<'_>, index: usize) -> Option<f64> {
        let worth = self.worth.get(index).is_some_and(|&worth| worth);
        worth.then(|| self.tuning.detour * ends.away(index))
    }
}

/// Whether something holds for all cells up to so many cells away.
fn around(
    terrain: &Terrain,
    index: usize,
    cells: usize,
    mut holds: impl FnMut(usize) -> bool,
) -> bool {
    let (cols, rows) = (terrain.cols, terrain.rows);
    let (col, row) = (index % cols, index / cols);
    let mut all = true;
    for r in row.saturating_sub(cells)..(row + cells + 1).min(rows) {
        for c in col.saturating_sub(cells)..(col + cells + 1).min(cols) {
            all &= holds(r * cols + c);
        }
    }
    all
}
