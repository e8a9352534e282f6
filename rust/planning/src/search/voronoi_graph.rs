//! To the generalized Voronoi diagram, along it, and from it to the goal (004, section 36.2.3): the ground that is left of a grid when
//! nobody goes anywhere else.

use plan_view::VoronoiCells;
use settings::{between, settings};

use super::links::Links;
use super::neighbours::around;
use super::{Graph, Route};

settings! {
    /// The planner `voronoi_graph`, on the grid of `a_star`, whose settings count as well.
    pub struct VoronoiGraphPlannerConfig("navigation.voronoi_graph") {
        /// The diagram has no branch into a corner where the two nearest obstacles lie less than this apart, seen from it.
        angle: f64 = 2.4, "rad", between(0.0, std::f64::consts::PI);
    }
}

/// What a cell costs where the diagram and the ways to it are all that there is.
///
/// Of a way over the grid there is one over these, wherever stairs or passages between its cells are: from each of their ends leads
/// a way to the diagram, too. A cell to either side belongs to it, as a diagonal step needs both of its corners.
#[derive(Debug, Clone, Default)]
pub struct VoronoiGraphSearch {
    config: VoronoiGraphPlannerConfig,
    weights: Vec<f32>,
}

impl VoronoiGraphSearch {
    /// With settings.
    pub const fn new(config: VoronoiGraphPlannerConfig) -> Self {
        Self {
            config,
            weights: Vec::new(),
        }
    }

    /// Finds the diagram of a grid, and the ways to it from cells where ways begin and end and from both ends of all links. The weights are
    /// those of the grid there, infinite elsewhere.
    pub fn lay(&mut self, graph: Graph<'_>, begin_and_end: impl Iterator<Item = usize>) -> &[f32] {
        let Graph {
            weights,
            cols,
            links,
        } = graph;
        let free = weights.iter().map(|weight| weight.is_finite());
        let cells = VoronoiCells::new(free, cols, self.config.angle);
        self.weights.clear();
        self.weights.resize(weights.len(), f32::INFINITY);
        let mut keep = |cell: usize| {
            self.weights[cell] = weights[cell];
            for beside in around(cell, cols, weights.len()) {
                self.weights[beside] = weights[beside];
            }
        };
        cells.on_diagram().for_each(&mut keep);
        let links = links.into_iter().flat_map(Links::all);
        let joined = links.flat_map(|link| [link.from as usize, link.to as usize]);
        for cell in begin_and_end
            .chain(joined)
            .filter(|&cell| cell < weights.len())
        {
            // From a cell that is not free, as where the robot stands may be, the ways of those beside it lead on.
            for first in around(cell, cols, weights.len()).chain([cell]) {
                if weights[first].is_finite() {
                    cells.to_diagram(first).for_each(&mut keep);
                }
            }
        }
        &self.weights
    }

    /// Weights as they were laid last.
    pub fn weights(&self) -> &[f32] {
        &self.weights
    }

    /// Whether a route leads over what was laid last, its first cell apart, which may be where nothing may be entered.
    pub fn holds(&self, route: &Route) -> bool {
        let cell = |&cell: &u32| self.weights.get(cell as usize).copied();
        let mut weights = route.cells.iter().skip(1).filter_map(cell);
        weights.all(f32::is_finite)
    }
}

#[cfg(test)]
mod tests;
