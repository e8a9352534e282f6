//! Routes to the goal: where they may end, in the goal's disc, or at the window's border when the goal lies outside.

use geometry::{same_level, two_levels};
use stairs::LevelsConfig;
use terrain::Terrain;

use crate::climb_links::{ClimbLinks, Fit};
use crate::outside_window::OutsideWindow;
use crate::search::{Graph, Route, Search, octile};
use crate::{AStarConfig, Goal, PathEnd};

/// The ends of a search.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PathEnds<'a> {
    terrain: &'a Terrain,
    outside: &'a OutsideWindow,
    goal: Goal,
    /// How much worse a place off the goal's middle is than walking there.
    pull: f64,
    /// How much heights of the goal's level may differ from its own, m.
    tolerance_m: f64,
    /// What ending where nothing was seen costs on top, in cells: the level is another one there, and no way up is known.
    blind: f64,
    /// Cell that holds the goal's middle.
    middle: Option<usize>,
    /// Whether the goal's middle lies in the window.
    pub(crate) inside: bool,
    /// Whether a way may lead out of the window all the same, and back into it.
    pub(crate) around: bool,
}

impl<'a> PathEnds<'a> {
    /// Ends for a robot that stands `height_m` high, m.
    pub(crate) fn new(
        terrain: &'a Terrain,
        outside: &'a OutsideWindow,
        goal: &Goal,
        height_m: f64,
        (config, levels): (&AStarConfig, &LevelsConfig),
    ) -> Self {
        let tuning = &config.tuning.ends;
        let missing_m = goal
            .height_m
            .map_or(0.0, |goal_m| (goal_m - height_m).abs());
        let blind_m = if two_levels(missing_m, 0.0, levels.told) {
            tuning.blind + config.climb_cost * missing_m / tuning.rise
        } else {
            0.0
        };
        let middle = terrain.index_at([goal.x_m, goal.y_m]);
        Self {
            terrain,
            outside,
            blind: blind_m / terrain.lattice.cell_m,
            goal: *goal,
            pull: tuning.pull,
            tolerance_m: levels.told,
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
            (Some(height), Some(level)) => same_level(level, height, self.tolerance_m),
            _ => true,
        };
        let blind = if self.is_blind(index) {
            self.blind
        } else {
            0.0
        };
        // A path is followed to a centimetre or two: stay off the disc's rim where there is room.
        on_level.then(|| self.pull * self.away_m(index) / self.terrain.lattice.cell_m + blind)
    }

    /// All cells where a path may end, with what that costs, in cells.
    pub(crate) fn all(&self) -> Vec<(u32, f64)> {
        let terrain = self.terrain;
        let side_m = self.goal.radius_m + terrain.lattice.cell_m;
        let middle_m = [self.goal.x_m, self.goal.y_m];
        let [low, high] = [-side_m, side_m].map(|by_m| {
            let corner = terrain
                .lattice
                .cell_at(middle_m[0] + by_m, middle_m[1] + by_m);
            let within = |at: i32, count: usize| usize::try_from(at).unwrap_or(0).min(count - 1);
            [
                within(corner.col, terrain.cols),
                within(corner.row, terrain.rows),
            ]
        });
        let cell = |row: usize, col: usize| row * terrain.cols + col;
        let square =
            (low[1]..=high[1]).flat_map(|row| (low[0]..=high[0]).map(move |col| (row, col)));
        let mut cells: Vec<usize> = square.map(|(row, col)| cell(row, col)).collect();
        if self.around || !self.inside {
            cells = (0..terrain.weights.len()).collect();
        }
        let end = |cell: usize| Some((cell as u32, self.cost(cell)?));
        cells.into_iter().filter_map(end).collect()
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
        let left_m = self
            .outside
            .left_m(self.terrain.center_m(index), &self.goal);
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
    links: &ClimbLinks,
    ends: &PathEnds<'_>,
    start: usize,
    worst: Fit,
) -> Option<Route> {
    let graph = Graph {
        weights: &terrain.weights,
        cols: terrain.cols,
        links: Some(&links.links),
    };
    search.run_linked(
        graph,
        |link| links.way(link).fit <= worst,
        start,
        |cell| ends.cost(cell),
        |cell| ends.remaining(cell),
    )
}

/// Where a route ends.
pub(crate) fn end_of(
    route: &Route,
    terrain: &Terrain,
    links: &ClimbLinks,
    ends: &PathEnds<'_>,
) -> PathEnd {
    let last_way = match route.cells[..] {
        [.., from, to] => links.between(terrain, from, to, Fit::Holds),
        _ => None,
    };
    let climbed = last_way.filter(|way| way.leave_m.is_none());
    let blind = route
        .cells
        .last()
        .is_some_and(|&cell| ends.is_blind(cell as usize));
    let in_disc = (route.cells.last()).is_some_and(|&cell| ends.holds(cell as usize));
    match climbed {
        Some(way) if way.at_goal => PathEnd::Goal,
        Some(_) => PathEnd::Hope,
        None if !(ends.inside && in_disc) => PathEnd::Border,
        None if blind => PathEnd::Hope,
        None => PathEnd::Goal,
    }
}
