//! ARA*: a way that costs no more than a known multiple of the cheapest, soon, and cheaper ones for as long as the budget lasts.
//!
//! After Likhachev, Gordon and Thrun 2003, of which Anytime D* is made (004, ref 36.31): A* with the estimate of what remains weighed by
//! epsilon, which falls step by step to 1, and each pass goes on from what those before it found. The budget is counted in cells that are
//! expanded, never in time, so that the same question has the same answer everywhere.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use settings::{POSITIVE, at_least, settings};

use super::links::Links;
use super::neighbours::Cells;
use super::steps::ANYWHERE;
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
    open: BinaryHeap<Reverse<OpenCell>>,
    /// In which pass of which search a cell was expanded last.
    closed: Vec<u64>,
    /// Counts the passes of all searches.
    pass: u64,
    /// What was reached more cheaply after its expansion: a matter of the next pass.
    inconsistent: Vec<u32>,
    /// Cells expanded by the last search.
    pub expanded: usize,
}

/// A cell to expand: its estimate and what the way to it costs, as bits (numbers that are not negative are ordered like them).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct OpenCell {
    estimate: u64,
    cost: u64,
    cell: u32,
}

impl OpenCell {
    fn new(cell: u32, cost: f64, estimate: f64) -> Self {
        let [estimate, cost] = [estimate, cost].map(f64::to_bits);
        Self {
            estimate,
            cost,
            cell,
        }
    }
}

/// The cheapest end so far.
#[derive(Debug, Clone, Copy)]
struct Best {
    cost: f64,
    last: Option<u32>,
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
        self.closed.resize(nodes.max(self.closed.len()), 0);
        self.open.clear();
        self.inconsistent.clear();
        self.expanded = 0;
        let mut epsilon = config.epsilon;
        let first = OpenCell::new(start as u32, 0.0, epsilon * heuristic(start));
        self.open.push(Reverse(first));
        let mut best = Best {
            cost: f64::INFINITY,
            last: None,
        };
        let mut bound = f64::INFINITY;
        loop {
            self.pass += 1;
            let question = (graph, &open, &ending, &heuristic);
            let through = self.pass_with(question, &mut best, epsilon, (bound, config.expansions));
            let last = best.last?;
            if through {
                bound = epsilon.min(best.cost / self.least(&heuristic));
            }
            if !through || bound <= 1.0 || self.expanded >= config.expansions {
                let cells = self.known.back_from(last as usize);
                let route = Route {
                    cells,
                    cost: best.cost,
                    corners: Vec::new(),
                };
                return Some(BoundedRoute {
                    route,
                    epsilon: bound.max(1.0),
                });
            }
            epsilon = (bound - config.epsilon_step).max(1.0);
            self.begin_pass(epsilon, &heuristic);
        }
    }

    /// One pass; false where the budget ended it. A first way is found whatever the budget.
    fn pass_with(
        &mut self,
        (graph, open, ending, heuristic): (
            Graph<'_>,
            impl Fn(usize) -> bool,
            impl Fn(usize) -> Option<f64>,
            impl Fn(usize) -> f64,
        ),
        best: &mut Best,
        epsilon: f64,
        (bound, expansions): (f64, usize),
    ) -> bool {
        let cells = Cells::new(graph.weights, graph.cols);
        while let Some(&Reverse(entry)) = self.open.peek() {
            let (here, cost) = (entry.cell as usize, f64::from_bits(entry.cost));
            if best.cost <= f64::from_bits(entry.estimate) {
                return true;
            }
            if cost > self.known.cost(here) || self.closed[here] == self.pass {
                let _ = self.open.pop();
                continue; // reached more cheaply since
            }
            if bound.is_finite() && self.expanded >= expansions {
                return false;
            }
            let _ = self.open.pop();
            self.expanded += 1;
            self.closed[here] = self.pass;
            if let Some(end) = ending(here)
                && cost + end < best.cost
            {
                (best.cost, best.last) = (cost + end, Some(entry.cell));
            }
            if here >= graph.weights.len() {
                continue; // no cell: nothing leads on
            }
            let mut reach = |next: usize, cost: f64| {
                if cost >= self.known.cost(next) {
                    return;
                }
                self.known.reach(next, cost, entry.cell);
                if self.closed[next] == self.pass {
                    self.inconsistent.push(next as u32);
                } else {
                    let estimate = cost + epsilon * heuristic(next);
                    let entry = OpenCell::new(next as u32, cost, estimate);
                    self.open.push(Reverse(entry));
                }
            };
            let weight = cells.weight_to_leave(here);
            cells.for_each_neighbour((here, ANYWHERE), |next, half_length, _| {
                let step = half_length * f64::from(weight + graph.weights[next]);
                reach(next, cost + step);
            });
            for (index, link) in graph.links.into_iter().flat_map(|links| links.from(here)) {
                if open(index) {
                    reach(link.to as usize, cost + link.cost);
                }
            }
        }
        true
    }

    /// The least that a way may cost that was not looked at yet.
    fn least(&self, heuristic: &impl Fn(usize) -> f64) -> f64 {
        let left = self.open.iter().map(|entry| entry.0.cell);
        let left = left.chain(self.inconsistent.iter().copied());
        let through = left.map(|cell| self.known.cost(cell as usize) + heuristic(cell as usize));
        through.fold(f64::INFINITY, f64::min)
    }

    /// Sorts what is left by another epsilon.
    fn begin_pass(&mut self, epsilon: f64, heuristic: &impl Fn(usize) -> f64) {
        let left = std::mem::take(&mut self.open).into_vec();
        let mut cells: Vec<u32> = left.into_iter().map(|entry| entry.0.cell).collect();
        cells.append(&mut self.inconsistent);
        cells.sort_unstable();
        cells.dedup();
        let entry = |cell: u32| {
            let cost = self.known.cost(cell as usize);
            Reverse(OpenCell::new(
                cell,
                cost,
                cost + epsilon * heuristic(cell as usize),
            ))
        };
        self.open = cells.into_iter().map(entry).collect();
    }
}

#[cfg(test)]
mod tests;
