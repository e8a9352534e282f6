//! A* on a grid with eight neighbours, links between cells, and flat arrays; a diagonal step needs both of its corners free.

pub mod ara_star;
pub mod d_star_lite;
pub mod field_d_star;
mod fixed_cost;
pub mod hierarchical;
mod interpolation;
pub mod kept;
mod known;
pub mod links;
pub(crate) mod neighbours;
mod queue;
pub(crate) mod steps;
#[cfg(test)]
pub(crate) mod testing;
pub mod voronoi_graph;

use std::f64::consts::SQRT_2;

use known::Known;
use links::Links;
use neighbours::Cells;
use queue::{Queue, QueueEntry};
use steps::ANYWHERE;

/// The cheapest way that was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Route {
    /// Indices of its cells, from the start to the end; beyond the cells, a node at which a link ends.
    pub cells: Vec<u32>,
    /// Its cost in cells, what ending there costs included.
    pub cost: f64,
    /// Where it is not bound to the middles of cells, its corners: column and row, whole numbers in the middle of a cell. Empty otherwise.
    pub corners: Vec<[f64; 2]>,
}

/// Octile distance: the shortest way between two points on an open grid with eight neighbours.
pub fn octile(dx: f64, dy: f64) -> f64 {
    let (dx, dy) = (dx.abs(), dy.abs());
    dx.max(dy) + (SQRT_2 - 1.0) * dx.min(dy)
}

/// What the steps from cell to cell along a way cost, in cells: what ending it costs is no part of it.
fn cost_along(cells: &[u32], weights: &[f32], cols: usize) -> f64 {
    let grid = Cells::new(weights, cols);
    let steps = cells.windows(2).map(|pair| {
        let [from, to] = [pair[0], pair[1]].map(|cell| cell as usize);
        let straight = from % cols == to % cols || from / cols == to / cols;
        let length = if straight { 1.0 } else { SQRT_2 };
        0.5 * length * f64::from(grid.weight_to_leave(from) + weights[to])
    });
    steps.sum()
}

/// What is searched.
#[derive(Debug, Clone, Copy)]
pub struct Graph<'a> {
    /// Row by row, what a cell's length costs there: 1 or more, infinite where it may not be entered (the start always may).
    pub weights: &'a [f32],
    /// Cells a row.
    pub cols: usize,
    /// Ways between cells that are no neighbours, and to nodes that are no cells.
    pub links: Option<&'a Links>,
}

/// Arrays of a search. Reused; only what the last search touched is cleared.
#[derive(Debug, Clone, Default)]
pub struct Search {
    known: Known,
    /// What is expanded too early in its bucket is expanded again, so that the result is exact.
    queue: Queue,
    /// Cells expanded by the last search.
    pub expanded: usize,
}

impl Search {
    /// The cheapest way over cells alone: [`Self::run_linked`] without links.
    pub fn run(
        &mut self,
        weights: &[f32],
        cols: usize,
        start: usize,
        ending: impl Fn(usize) -> Option<f64>,
        heuristic: impl Fn(usize) -> f64,
    ) -> Option<Route> {
        let graph = Graph {
            weights,
            cols,
            links: None,
        };
        self.run_linked(graph, |_| true, start, ending, heuristic)
    }

    /// The cheapest way from `start` to a node where `ending` gives a cost of ending there.
    ///
    /// A step costs its length times the mean weight of its two cells. Of the links those are used that `open` says, by
    /// index. `heuristic` never exceeds the remaining cost, ending included, and falls by no more than a step or link costs.
    pub fn run_linked(
        &mut self,
        graph: Graph<'_>,
        open: impl Fn(usize) -> bool,
        start: usize,
        ending: impl Fn(usize) -> Option<f64>,
        heuristic: impl Fn(usize) -> f64,
    ) -> Option<Route> {
        let Graph {
            weights,
            cols,
            links,
        } = graph;
        let cells = Cells::new(weights, cols);
        let nodes = links.map_or(0, Links::nodes).max(weights.len());
        let Self {
            known,
            queue,
            expanded,
        } = self;
        known.begin(nodes, start);
        *expanded = 0;
        let first = QueueEntry {
            cost: 0.0,
            cell: start as u32,
            trail: ANYWHERE,
        };
        queue.begin(heuristic(start), first);
        let (mut best, mut last) = (f64::INFINITY, None);
        while let Some(QueueEntry { cost, cell, trail }) = queue.pop() {
            let here = cell as usize;
            if cost > known.cost(here) || last.is_some() && cost + heuristic(here) >= best {
                continue; // reached more cheaply since, or no use
            }
            *expanded += 1;
            if let Some(end) = ending(here)
                && cost + end < best
            {
                (best, last) = (cost + end, Some(here));
                queue.end_at(best);
            }
            if here >= weights.len() {
                continue; // no cell: nothing leads on
            }
            let mut reach = |next: usize, cost: f64, trail| {
                if cost < known.cost(next) {
                    known.reach(next, cost, cell);
                    let cell = next as u32;
                    queue.push(cost + heuristic(next), QueueEntry { cost, cell, trail });
                }
            };
            let weight = cells.weight_to_leave(here);
            cells.for_each_neighbour((here, trail), |next, half_length, trail| {
                let step = half_length * f64::from(weight + weights[next]);
                reach(next, cost + step, trail);
            });
            for (index, link) in links.into_iter().flat_map(|links| links.from(here)) {
                if open(index) {
                    reach(link.to as usize, cost + link.cost, ANYWHERE);
                }
            }
        }
        last.map(|end| Route {
            cells: known.back_from(end),
            cost: best,
            corners: Vec::new(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const COLS: usize = 20;

    fn to(goal: usize) -> impl Fn(usize) -> f64 {
        move |cell| {
            octile(
                (cell % COLS) as f64 - (goal % COLS) as f64,
                (cell / COLS) as f64 - (goal / COLS) as f64,
            )
        }
    }

    proptest! {
        #[test]
        fn the_cost_equals_dijkstras(
            weights in prop::collection::vec(prop_oneof![3 => 1.0..4.0f32, 1 => Just(f32::INFINITY)], COLS * 15),
            start in 0..COLS * 15, goal in 0..COLS * 15,
        ) {
            let ending = |cell: usize| (cell == goal).then_some(0.0);
            let mut search = Search::default();
            let found = search.run(&weights, COLS, start, ending, to(goal));
            let expanded = search.expanded;
            let reference = search.run(&weights, COLS, start, ending, |_| 0.0);
            prop_assert_eq!(found.is_some(), reference.is_some());
            if let (Some(found), Some(reference)) = (found, reference) {
                prop_assert!((found.cost - reference.cost).abs() < 1e-9);
                prop_assert!(expanded <= search.expanded + COLS);
                for pair in found.cells.windows(2) {
                    let mut adjacent = false;
                    Cells::new(&weights, COLS).for_each_neighbour((pair[0] as usize, ANYWHERE), |cell, _, _| {
                        adjacent |= cell == pair[1] as usize;
                    });
                    prop_assert!(adjacent);
                }
            }
        }

        #[test]
        fn the_best_ending_is_chosen(ends in prop::collection::vec((0..COLS * 15, 0.0..30.0f64), 1..10)) {
            let weights = [1.0; COLS * 15];
            let ending = |cell: usize| {
                ends.iter().filter(|&&(end, _)| end == cell).map(|&(_, cost)| cost).reduce(f64::min)
            };
            let found = Search::default().run(&weights, COLS, 0, ending, |_| 0.0).unwrap();
            let best = ends.iter().map(|&(end, cost)| to(end)(0) + cost).fold(f64::INFINITY, f64::min);
            prop_assert!((found.cost - best).abs() < 1e-9);
        }
    }

    #[test]
    fn no_corner_is_cut() {
        let mut weights = [1.0; 4];
        weights[1] = f32::INFINITY;
        let ending = |cell: usize| (cell == 3).then_some(0.0);
        let found = Search::default()
            .run(&weights, 2, 0, ending, |_| 0.0)
            .unwrap();
        assert_eq!(found.cells, [0, 2, 3]);
    }
}
