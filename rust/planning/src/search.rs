//! A* on a grid with eight neighbours and flat arrays; a diagonal step needs both of its corners free.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::f64::consts::SQRT_2;

/// No cell before this one.
const NONE: u32 = u32::MAX;

/// The cheapest way that was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Route {
    /// Indices of its cells, from the start to the end.
    pub cells: Vec<u32>,
    /// Its cost in cells, what ending there costs included.
    pub cost: f64,
}

/// Octile distance: the shortest way between two points on an open grid with eight neighbours.
pub fn octile(dx: f64, dy: f64) -> f64 {
    let (dx, dy) = (dx.abs(), dy.abs());
    dx.max(dy) + (SQRT_2 - 1.0) * dx.min(dy)
}

/// Arrays of a search. Reused; nothing is cleared between searches.
#[derive(Debug, Clone, Default)]
pub struct Search {
    /// Cost from the start, valid where `stamp` is of this search.
    cost: Vec<f64>,
    parent: Vec<u32>,
    stamp: Vec<u32>,
    search: u32,
    /// Cost and heuristic as bits (they are not negative, so that bits order as numbers), and the cell.
    open: BinaryHeap<Reverse<(u64, u32)>>,
    /// Cells expanded by the last search.
    pub expanded: usize,
}

impl Search {
    /// The cheapest way from `start` to a cell where `ending` gives a cost of ending there.
    ///
    /// `weights` says, row by row, what a cell's length costs there: 1 or more, infinite where it may not be entered (the
    /// start always may). A step costs its length times the mean weight of its two cells. `heuristic` never exceeds the
    /// remaining cost, ending included, and falls by no more than a step costs.
    pub fn run(
        &mut self,
        weights: &[f32],
        cols: usize,
        start: usize,
        ending: impl Fn(usize) -> Option<f64>,
        heuristic: impl Fn(usize) -> f64,
    ) -> Option<Route> {
        self.begin(weights.len());
        self.reach(start, 0.0, NONE, heuristic(start));
        let mut best: Option<(f64, usize)> = None;
        while let Some(Reverse((priority, cell))) = self.open.pop() {
            let priority = f64::from_bits(priority);
            if best.is_some_and(|(cost, _)| priority >= cost) {
                break;
            }
            let here = cell as usize;
            let cost = self.cost[here];
            if priority > cost + heuristic(here) {
                continue; // reached more cheaply since
            }
            self.expanded += 1;
            if let Some(end) = ending(here)
                && best.is_none_or(|(known, _)| cost + end < known)
            {
                best = Some((cost + end, here));
            }
            let from = weights[here].min(f32::MAX);
            let from = if from == f32::MAX {
                1.0
            } else {
                f64::from(from)
            };
            for (next, length) in neighbours(weights, cols, here) {
                let through = cost + length * 0.5 * (from + f64::from(weights[next]));
                if self.stamp[next] != self.search || through < self.cost[next] {
                    self.reach(next, through, cell, heuristic(next));
                }
            }
        }
        best.map(|(cost, end)| Route {
            cells: self.back_from(end),
            cost,
        })
    }

    fn begin(&mut self, cells: usize) {
        if self.stamp.len() != cells || self.search == u32::MAX {
            self.cost = vec![0.0; cells];
            self.parent = vec![NONE; cells];
            self.stamp = vec![0; cells];
            self.search = 0;
        }
        self.search += 1;
        self.open.clear();
        self.expanded = 0;
    }

    fn reach(&mut self, cell: usize, cost: f64, parent: u32, heuristic: f64) {
        self.cost[cell] = cost;
        self.parent[cell] = parent;
        self.stamp[cell] = self.search;
        self.open
            .push(Reverse(((cost + heuristic).to_bits(), cell as u32)));
    }

    fn back_from(&self, end: usize) -> Vec<u32> {
        let mut cells = vec![end as u32];
        let mut parent = self.parent[end];
        while parent != NONE {
            cells.push(parent);
            parent = self.parent[parent as usize];
        }
        cells.reverse();
        cells
    }
}

/// Free neighbours of a cell with the length of the step.
pub(crate) fn neighbours(
    weights: &[f32],
    cols: usize,
    cell: usize,
) -> impl Iterator<Item = (usize, f64)> {
    let (col, row) = (cell % cols, cell / cols);
    let rows = weights.len() / cols;
    let free = |index: usize| weights[index].is_finite();
    let west = col > 0 && free(cell - 1);
    let east = col + 1 < cols && free(cell + 1);
    let south = row > 0 && free(cell - cols);
    let north = row + 1 < rows && free(cell + cols);
    let of = |holds: bool, index: usize, length: f64| holds.then_some((index, length));
    let at = |holds: bool, index: usize| of(holds && free(index), index, SQRT_2);
    [
        of(west, cell.wrapping_sub(1), 1.0),
        of(east, cell + 1, 1.0),
        of(south, cell.wrapping_sub(cols), 1.0),
        of(north, cell + cols, 1.0),
        at(west && south, cell.wrapping_sub(cols + 1)),
        at(east && south, cell.wrapping_sub(cols).wrapping_add(1)),
        at(west && north, (cell + cols).wrapping_sub(1)),
        at(east && north, cell + cols + 1),
    ]
    .into_iter()
    .flatten()
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
                    let mut next = neighbours(&weights, COLS, pair[0] as usize);
                    prop_assert!(next.any(|(cell, _)| cell == pair[1] as usize));
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
