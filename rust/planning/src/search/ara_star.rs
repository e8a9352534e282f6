//! ARA*: a way that costs no more than a known multiple of the cheapest, soon, and cheaper ones for as long as the budget lasts.
//!
//! After Likhachev, Gordon and Thrun 2003, of which Anytime D* is made (004, ref 36.31): A* with the estimate of what remains weighed by
//! epsilon, which falls step by step to 1, and each pass goes on from what those before it found. The budget is counted in cells that are
//! expanded, never in time, so that the same question has the same answer everywhere. It searches a grid, or whatever is a [`Space`].

mod grid_space;

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use settings::{POSITIVE, at_least, settings};

use grid_space::GridSpace;

use super::links::Links;
use super::neighbours::Cells;
use super::{Graph, Known, Route};

settings! {
    /// ARA* on the grid of `a_star`, whose settings count as well.
    pub struct AraStarConfig("navigation.ara_star") {
        /// The first way costs no more than so many times the cheapest.
        epsilon: f64 = 3.0, "1", at_least(1.0), "Likhachev et al. 2003: ARA*: anytime A* with provable bounds on sub-optimality";
        /// By how much that falls from pass to pass.
        epsilon_step: f64 = 0.5, "1", POSITIVE;
        /// Cells that a search expands before the best way so far is taken; beyond that only for a first one.
        expansions: usize = 20_000, "1", at_least(1.0);
    }
}

/// A way, and how good it is known to be.
#[derive(Debug, Clone, PartialEq)]
pub struct BoundedRoute {
    /// The way.
    pub route: Route,
    /// It costs no more than so many times the cheapest.
    pub epsilon: f64,
}

/// Arrays of a search. Reused.
#[derive(Debug, Clone, Default)]
pub struct AraStar {
    known: Known,
    /// What is to be expanded in this pass, by estimate; what is dearer than `known` says is out of date.
    open: BinaryHeap<Reverse<OpenNode>>,
    /// In which pass of which search a node was expanded last.
    closed: Vec<u64>,
    /// Counts the passes of all searches.
    pass: u64,
    /// What was reached more cheaply after its expansion: a matter of the next pass.
    inconsistent: Vec<u32>,
    /// What the steps from one node reach more cheaply than was known, and the cost.
    steps: Vec<(u32, f64)>,
    /// Nodes expanded by the last search.
    pub expanded: usize,
}

/// How far a search has come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchProgress {
    /// The last node of the best way so far.
    pub last: u32,
    /// What that costs, ending included.
    pub cost: f64,
    /// It costs no more than so many times the cheapest.
    pub epsilon: f64,
    /// Nodes expanded until it was found.
    pub expanded: usize,
}

/// A node to expand: its estimate and what the way to it costs, as bits (numbers that are not negative are ordered like them).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct OpenNode {
    estimate: u64,
    cost: u64,
    node: u32,
}

impl OpenNode {
    fn new(node: u32, cost: f64, estimate: f64) -> Self {
        let [estimate, cost] = [estimate, cost].map(f64::to_bits);
        Self {
            estimate,
            cost,
            node,
        }
    }
}

/// The cheapest end so far.
#[derive(Debug, Clone, Copy)]
struct Best {
    cost: f64,
    last: Option<u32>,
}

/// What is searched: nodes by number, as many as are come upon.
pub trait Space {
    /// Tells of every node that a step from this one leads to, and what the step costs. `parent` is the node before it on the way.
    fn for_each_step(&mut self, node: u32, parent: Option<u32>, reach: impl FnMut(u32, f64));

    /// What it costs to end at a node that was reached from `parent`, if a way may end there.
    fn ending(&mut self, node: u32, parent: Option<u32>) -> Option<f64>;

    /// What the way from a node costs at least, ending included.
    fn remaining(&self, node: u32) -> f64;
}

impl AraStar {
    /// A way from `start` to a node where `ending` gives a cost of ending there, and how good it is known to be, as
    /// [`super::Search::run_linked`] has its question; `None` where there is none.
    pub fn run(
        &mut self,
        graph: Graph<'_>,
        open: impl Fn(usize) -> bool,
        start: usize,
        (ending, heuristic): (impl Fn(usize) -> Option<f64>, impl Fn(usize) -> f64),
        config: &AraStarConfig,
    ) -> Option<BoundedRoute> {
        let nodes = (graph.links)
            .map_or(0, Links::nodes)
            .max(graph.weights.len());
        self.known.begin(nodes, start);
        let mut cells = GridSpace {
            cells: Cells::new(graph.weights, graph.cols),
            graph,
            open,
            ending,
            heuristic,
        };
        self.improve(&mut cells, start as u32, config, |_, _| {})
    }

    /// A way through any space from node `start`, as [`Self::run`]. `found` is told of the best way so far at the end of each pass.
    pub fn run_in<S: Space>(
        &mut self,
        space: &mut S,
        start: u32,
        config: &AraStarConfig,
        found: impl FnMut(&mut S, &SearchProgress),
    ) -> Option<BoundedRoute> {
        self.known.begin(start as usize + 1, start as usize);
        self.improve(space, start, config, found)
    }

    fn improve<S: Space>(
        &mut self,
        space: &mut S,
        start: u32,
        config: &AraStarConfig,
        mut found: impl FnMut(&mut S, &SearchProgress),
    ) -> Option<BoundedRoute> {
        self.open.clear();
        self.inconsistent.clear();
        self.expanded = 0;
        let mut epsilon = config.epsilon;
        let first = OpenNode::new(start, 0.0, epsilon * space.remaining(start));
        self.open.push(Reverse(first));
        let mut best = Best {
            cost: f64::INFINITY,
            last: None,
        };
        let mut bound = f64::INFINITY;
        loop {
            self.pass += 1;
            let through = self.pass_with(space, &mut best, epsilon, (bound, config.expansions));
            let last = best.last?;
            if through {
                bound = epsilon.min(best.cost / self.least(space));
            }
            let progress = SearchProgress {
                last,
                cost: best.cost,
                epsilon: bound.max(1.0),
                expanded: self.expanded,
            };
            found(space, &progress);
            if !through || bound <= 1.0 || self.expanded >= config.expansions {
                let route = Route {
                    cells: self.known.back_from(last as usize),
                    cost: best.cost,
                    corners: Vec::new(),
                };
                return Some(BoundedRoute {
                    route,
                    epsilon: progress.epsilon,
                });
            }
            epsilon = (bound - config.epsilon_step).max(1.0);
            self.begin_pass(epsilon, space);
        }
    }

    /// One pass; false where the budget ended it. A first way is found whatever the budget.
    fn pass_with<S: Space>(
        &mut self,
        space: &mut S,
        best: &mut Best,
        epsilon: f64,
        (bound, expansions): (f64, usize),
    ) -> bool {
        while let Some(&Reverse(entry)) = self.open.peek() {
            let (here, cost) = (entry.node as usize, f64::from_bits(entry.cost));
            if best.cost <= f64::from_bits(entry.estimate) {
                return true;
            }
            if cost > self.known.cost(here) || self.closed.get(here) == Some(&self.pass) {
                let _ = self.open.pop();
                continue; // reached more cheaply since
            }
            if bound.is_finite() && self.expanded >= expansions {
                return false;
            }
            let _ = self.open.pop();
            self.expanded += 1;
            self.close(here);
            let parent = self.known.parent(here);
            if let Some(end) = space.ending(entry.node, parent)
                && cost + end < best.cost
            {
                (best.cost, best.last) = (cost + end, Some(entry.node));
            }
            // What the steps lead to is sorted once all are known: the space may not be asked while it tells.
            let Self { steps, known, .. } = self;
            steps.clear();
            space.for_each_step(entry.node, parent, |next, step| {
                if known.reach_cheaper(next, cost + step, entry.node) {
                    steps.push((next, cost + step));
                }
            });
            for &(next, cost) in &self.steps {
                if self.closed.get(next as usize) == Some(&self.pass) {
                    self.inconsistent.push(next);
                } else {
                    let estimate = cost + epsilon * space.remaining(next);
                    self.open.push(Reverse(OpenNode::new(next, cost, estimate)));
                }
            }
        }
        true
    }

    fn close(&mut self, node: usize) {
        if self.closed.len() <= node {
            self.closed.resize(node + 1, 0);
        }
        self.closed[node] = self.pass;
    }

    /// The least that a way may cost that was not looked at yet.
    fn least(&self, space: &impl Space) -> f64 {
        let left = self.open.iter().map(|entry| entry.0.node);
        let left = left.chain(self.inconsistent.iter().copied());
        let through = left.map(|node| self.known.cost(node as usize) + space.remaining(node));
        through.fold(f64::INFINITY, f64::min)
    }

    /// Sorts what is left by another epsilon.
    fn begin_pass(&mut self, epsilon: f64, space: &impl Space) {
        let left = std::mem::take(&mut self.open).into_vec();
        let mut nodes: Vec<u32> = left.into_iter().map(|entry| entry.0.node).collect();
        nodes.append(&mut self.inconsistent);
        nodes.sort_unstable();
        nodes.dedup();
        let entry = |node: u32| {
            let cost = self.known.cost(node as usize);
            let estimate = cost + epsilon * space.remaining(node);
            Reverse(OpenNode::new(node, cost, estimate))
        };
        self.open = nodes.into_iter().map(entry).collect();
    }
}

#[cfg(test)]
mod tests;
