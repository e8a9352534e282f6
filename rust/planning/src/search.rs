//! A* on a grid with eight neighbours, links between cells, and flat arrays; a diagonal step needs both of its corners free.

use std::f64::consts::SQRT_2;

use crate::links::Links;
use crate::neighbours::{ANYWHERE, Heading, for_each_neighbour};

/// No cell before this one.
const NONE: u32 = u32::MAX;

/// The cheapest way that was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Route {
    /// Indices of its cells, from the start to the end; beyond the cells, a node at which a link ends.
    pub cells: Vec<u32>,
    /// Its cost in cells, what ending there costs included.
    pub cost: f64,
}

/// Octile distance: the shortest way between two points on an open grid with eight neighbours.
pub fn octile(dx: f64, dy: f64) -> f64 {
    let (dx, dy) = (dx.abs(), dy.abs());
    dx.max(dy) + (SQRT_2 - 1.0) * dx.min(dy)
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

/// Width of a bucket of the queue, in cells.
const BUCKET: f64 = 0.5;

/// Arrays of a search. Reused; nothing is cleared between searches.
#[derive(Debug, Clone, Default)]
pub struct Search {
    nodes: Vec<Node>,
    round: u32,
    /// Cells to expand, by the estimated cost through them; within a bucket the last one first. What is expanded too early
    /// in its bucket is expanded again, so that the result is exact.
    buckets: Vec<Vec<(f64, u32)>>,
    /// Cells expanded by the last search.
    pub expanded: usize,
}

/// What a search knows of a cell; valid where `round` is the search's.
#[derive(Debug, Clone, Copy)]
struct Node {
    cost: f64,
    heuristic: f64,
    parent: u32,
    round: u32,
    /// In which direction it was come upon.
    heading: Heading,
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
        let nodes = links.map_or(0, Links::nodes).max(weights.len());
        self.begin(nodes);
        let mut best: Option<(f64, usize)> = None;
        self.reach(start, 0.0, (NONE, ANYWHERE), heuristic(start), 0);
        let mut bucket = 0;
        while bucket < self.buckets.len() {
            if best.is_some_and(|(cost, _)| bucket as f64 * BUCKET >= cost) {
                break;
            }
            let Some((cost, cell)) = self.buckets[bucket].pop() else {
                bucket += 1;
                continue;
            };
            let here = cell as usize;
            let node = self.nodes[here];
            if cost > node.cost || best.is_some_and(|(b, _)| cost + node.heuristic >= b) {
                continue; // reached more cheaply since, or no use
            }
            self.expanded += 1;
            if let Some(end) = ending(here)
                && best.is_none_or(|(known, _)| cost + end < known)
            {
                best = Some((cost + end, here));
            }
            if here >= weights.len() {
                continue; // no cell: nothing leads on
            }
            let weight = if weights[here].is_finite() {
                weights[here]
            } else {
                1.0
            };
            let come = (here, node.heading);
            for_each_neighbour(weights, cols, come, |next, length, heading| {
                let through = cost + length * 0.5 * f64::from(weight + weights[next]);
                let known = self.nodes[next];
                if known.round != self.round {
                    self.reach(next, through, (cell, heading), heuristic(next), bucket);
                } else if through < known.cost {
                    self.reach(next, through, (cell, heading), known.heuristic, bucket);
                }
            });
            for (index, link) in links.into_iter().flat_map(|links| links.from(here)) {
                let (next, through) = (link.to as usize, cost + link.cost);
                let known = self.nodes[next];
                if open(index) && (known.round != self.round || through < known.cost) {
                    self.reach(next, through, (cell, ANYWHERE), heuristic(next), bucket);
                }
            }
        }
        best.map(|(cost, end)| Route {
            cells: self.back_from(end),
            cost,
        })
    }

    fn begin(&mut self, nodes: usize) {
        if self.nodes.len() < nodes || self.round == u32::MAX {
            let unreached = Node {
                cost: 0.0,
                heuristic: 0.0,
                parent: NONE,
                round: 0,
                heading: ANYWHERE,
            };
            self.nodes = vec![unreached; nodes];
            self.round = 0;
        }
        self.round += 1;
        for bucket in &mut self.buckets {
            bucket.clear();
        }
        self.expanded = 0;
    }

    #[inline]
    fn reach(
        &mut self,
        cell: usize,
        cost: f64,
        (parent, heading): (u32, Heading),
        heuristic: f64,
        now: usize,
    ) {
        self.nodes[cell] = Node {
            cost,
            heuristic,
            parent,
            round: self.round,
            heading,
        };
        // Rounding must not put it where the search has passed.
        let bucket = (((cost + heuristic) / BUCKET) as u32 as usize).max(now);
        if bucket >= self.buckets.len() {
            self.more_buckets(bucket + 1);
        }
        self.buckets[bucket].push((cost, cell as u32));
    }

    #[cold]
    fn more_buckets(&mut self, count: usize) {
        self.buckets.resize_with(count, Vec::new);
    }

    fn back_from(&self, end: usize) -> Vec<u32> {
        let mut cells = vec![end as u32];
        let mut parent = self.nodes[end].parent;
        while parent != NONE {
            cells.push(parent);
            parent = self.nodes[parent as usize].parent;
        }
        cells.reverse();
        cells
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
                    for_each_neighbour(&weights, COLS, (pair[0] as usize, ANYWHERE), |cell, _, _| {
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
