//! Routes to the goal: where they may end, in the goal's disc, or at the window's border when the goal lies outside.

use crate::Goal;
use crate::beyond::Beyond;
use crate::keep::End;
use crate::legs::link_between;
use crate::portals::{Fit, Portals};
use crate::search::{Graph, Route, Search, octile};
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
    beyond: &'a Beyond,
    goal: Goal,
    /// What ending where nothing was seen costs on top, in cells: the level is another one there, and no way up is known.
    blind: f64,
    /// Cell that holds the goal's middle.
    middle: Option<usize>,
    /// Whether the goal's middle lies in the window.
    pub(crate) inside: bool,
    /// Whether a way may lead out of the window all the same, and back into it.
    pub(crate) around: bool,
}

impl<'a> Ends<'a> {
    /// Ends for a robot that stands `height_m` high, m; `climb_cost` as configured.
    pub(crate) fn new(
        terrain: &'a Terrain,
        beyond: &'a Beyond,
        goal: &Goal,
        height_m: f64,
        climb_cost: f64,
    ) -> Self {
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
            beyond,
            blind: blind_m / terrain.lattice.cell_m,
            goal: *goal,
            middle,
            inside: middle.is_some(),
            around: false,
        }
    }

    /// What ending in a cell costs, in cells; `None` where a path may not end.
    pub(crate) fn cost(&self, index: usize) -> Option<f64> {
        if index >= self.terrain.weights.len() {
            return Some(0.0); // the end of a climb; its link has the cost
        }
        if !self.holds(index) || !self.inside {
            let outward = (self.around || !self.inside) && self.terrain.on_border(index);
            return outward
                .then(|| self.left(index))
                .filter(|left| left.is_finite());
        }
        let on_level = match (self.goal.height_m, self.terrain.level_m(index)) {
            (Some(height), Some(level)) => (level - height).abs() <= LEVEL_M,
            _ => true,
        };
        let blind = if self.is_blind(index) {
            self.blind
        } else {
            0.0
        };
        // A path is followed to a centimetre or two: stay off the disc's rim where there is room.
        on_level.then(|| PULL * self.away_m(index) / self.terrain.lattice.cell_m + blind)
    }

    /// Whether a cell lies in the goal's disc.
    pub(crate) fn holds(&self, index: usize) -> bool {
        self.away_m(index) <= self.goal.radius_m || self.middle == Some(index)
    }

    fn away_m(&self, index: usize) -> f64 {
        let [x, y] = self.terrain.center_m(index);
        let (dx, dy) = (x - self.goal.x_m, y - self.goal.y_m);
        (dx * dx + dy * dy).sqrt()
    }

    /// Whether the goal lies on another level than the robot stands on.
    pub(crate) fn on_another_level(&self) -> bool {
        self.blind > 0.0
    }

    /// Whether ending in a cell is but a hope: the goal's level was not seen there.
    pub(crate) fn is_blind(&self, index: usize) -> bool {
        let seen = |index| self.terrain.level_m(index).is_some();
        self.blind > 0.0 && index < self.terrain.weights.len() && !seen(index)
    }

    /// The least that a way from a node on costs: octile distance to the goal's middle, in cells; 0 at the end of a climb.
    pub(crate) fn remaining(&self, index: usize) -> f64 {
        if index >= self.terrain.weights.len() {
            return 0.0;
        }
        self.away(index)
    }

    /// How long the way from the window's border on is, in cells.
    fn left(&self, index: usize) -> f64 {
        let left_m = self.beyond.left_m(self.terrain.center_m(index), &self.goal);
        self.remaining(index)
            .max(left_m / self.terrain.lattice.cell_m)
    }

    /// Octile distance from a cell to the goal's middle, in cells.
    pub(crate) fn away(&self, index: usize) -> f64 {
        let [x, y] = self.terrain.center_m(index);
        octile(x - self.goal.x_m, y - self.goal.y_m) / self.terrain.lattice.cell_m
    }
}

/// The cheapest route to the goal over ways that fit as well as `worst`.
pub(crate) fn run(
    search: &mut Search,
    terrain: &Terrain,
    portals: &Portals,
    ends: &Ends<'_>,
    start: usize,
    worst: Fit,
) -> Option<Route> {
    let graph = Graph {
        weights: &terrain.weights,
        cols: terrain.cols,
        links: Some(&portals.links),
    };
    search.run_linked(
        graph,
        |link| portals.way(link).fit <= worst,
        start,
        |cell| ends.cost(cell),
        |cell| ends.remaining(cell),
    )
}

/// Where a route ends.
pub(crate) fn end_of(route: &Route, terrain: &Terrain, portals: &Portals, ends: &Ends<'_>) -> End {
    let last_way = match route.cells[..] {
        [.., from, to] => link_between(terrain, portals, from, to, Fit::Holds),
        _ => None,
    };
    let climbed = last_way.filter(|way| way.leave_m.is_none());
    let blind = route
        .cells
        .last()
        .is_some_and(|&cell| ends.is_blind(cell as usize));
    let in_disc = (route.cells.last()).is_some_and(|&cell| ends.holds(cell as usize));
    match climbed {
        Some(way) if way.at_goal => End::Goal,
        Some(_) => End::Hope,
        None if blind => End::Hope,
        None if ends.inside && in_disc => End::Goal,
        None => End::Border,
    }
}
