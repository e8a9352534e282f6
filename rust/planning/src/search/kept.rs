//! Which way stands when cells change: the one that is provably still a cheapest one.
//!
//! A way was a cheapest one from its start to its end. It still is from any of its cells onward when
//!
//! 1. no cell of it that is ahead became dearer or blocked, and no cell that a diagonal step ahead passes became so, and
//! 2. for every cell that became cheaper, octile(start, cell) + remaining(cell) + (weight - 1) / 2 is no less than what the way costs; for
//!    every cell that was blocked and is open now, octile(start, cell) + remaining(cell) - (2 - sqrt(2)) is not.
//!
//! Why: by the first the way costs what it did, and what became dearer makes no other way cheaper. A way that became cheaper leads over a
//! cell that did, or past the corner of one that has opened. Over the cell it costs at least the two distances, and half a step more at the
//! cell's weight. Past its corner it goes one diagonal step where the two distances have two straight ones: 2 - sqrt(2) less. Without that
//! the rule would keep ways that a corner which has opened makes shorter.

use std::f64::consts::SQRT_2;

use super::{Route, cost_along, octile};

/// What the corner of a cell is shorter than the way over it, cells.
const CORNER: f64 = 2.0 - SQRT_2;

/// A cell's weight before and after.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeightChange {
    /// Its index.
    pub cell: usize,
    /// What a length cost there; infinite where it could not be entered.
    pub before: f32,
    /// What it costs by now.
    pub after: f32,
}

/// A way that was found, with what it rests on. Reused.
#[derive(Debug, Clone, Default)]
pub struct KeptRoute {
    cells: Vec<u32>,
    /// For each cell of the way, what is left from there, ending included, in cells.
    left: Vec<f64>,
    /// For each cell of the grid, one more than the last of the way's cells that it is, or from which a diagonal step passes it; 0 for none.
    rests_on: Vec<u32>,
    cols: usize,
}

impl KeptRoute {
    /// Keeps a way that is a cheapest one on these weights.
    pub fn keep(&mut self, route: &Route, weights: &[f32], cols: usize) {
        self.forget();
        self.rests_on.resize(weights.len(), 0);
        self.cols = cols;
        self.cells.extend_from_slice(&route.cells);
        let mut left = route.cost;
        self.left.push(left);
        for (at, pair) in route.cells.windows(2).enumerate() {
            let [from, to] = [pair[0], pair[1]].map(|cell| cell as usize);
            left -= cost_along(pair, weights, cols);
            self.left.push(left);
            let (corner, other) = (
                from / cols * cols + to % cols,
                to / cols * cols + from % cols,
            );
            for cell in [from, corner, other] {
                self.rests_on[cell] = at as u32 + 1;
            }
        }
        if let Some(&last) = route.cells.last() {
            self.rests_on[last as usize] = route.cells.len() as u32;
        }
    }

    /// Forgets the way.
    pub fn forget(&mut self) {
        let (cells, cols) = (std::mem::take(&mut self.cells), self.cols);
        for pair in cells.windows(2) {
            let [from, to] = [pair[0], pair[1]].map(|cell| cell as usize);
            let (corner, other) = (
                from / cols * cols + to % cols,
                to / cols * cols + from % cols,
            );
            for cell in [from, corner, other, to] {
                self.rests_on[cell] = 0;
            }
        }
        if let [only] = cells[..] {
            self.rests_on[only as usize] = 0;
        }
        self.left.clear();
        self.cells = cells;
        self.cells.clear();
    }

    /// What is left of the way from a cell on, where it is provably a cheapest one after these changes; otherwise it is to be found anew.
    /// `remaining` never exceeds what a way from a cell on costs, ending included, and falls by no more than its length over a step; where
    /// ways end and what that costs is as it was.
    pub fn stands(
        &self,
        start: usize,
        changes: impl IntoIterator<Item = WeightChange>,
        remaining: impl Fn(usize) -> f64,
    ) -> Option<Route> {
        let at = (*self.rests_on.get(start)?).checked_sub(1)? as usize;
        if self.cells[at] as usize != start {
            return None;
        }
        let cost = self.left[at];
        let [col, row] = [start % self.cols, start / self.cols];
        for WeightChange {
            cell,
            before,
            after,
        } in changes
        {
            if after > before {
                if self.rests_on[cell] as usize > at {
                    return None;
                }
            } else if after < before {
                let off = |a: usize, b: usize| a as f64 - b as f64;
                let away = octile(off(cell % self.cols, col), off(cell / self.cols, row));
                let more = if before.is_infinite() {
                    -CORNER
                } else {
                    0.5 * (f64::from(after) - 1.0)
                };
                if away + remaining(cell) + more < cost {
                    return None;
                }
            }
        }
        Some(Route {
            cells: self.cells[at..].to_vec(),
            cost,
            corners: Vec::new(),
        })
    }
}

#[cfg(test)]
mod tests;
