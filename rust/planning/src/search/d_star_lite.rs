//! D* Lite: the field of costs to the goal is kept, and where cells change, only what that changes of it is found anew.
//!
//! After Koenig and Likhachev 2002 (its optimized form), which the survey names with D* (004, refs 36.29 to 36.31). With `delayed`, after
//! Ferguson and Stentz 2005 (004, ref 36.29): what became dearer waits until it lies on the way.
//!
//! The search goes from the ends to the start, on the grid of [`super::Search`]: eight neighbours, a step costs its length times the mean
//! weight of its two cells, and a diagonal one needs both of its corners free. There are no links between cells here.

mod changes;
mod repair;

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use settings::{ANY, settings, within};

use super::fixed_cost::{Cost, NEVER, STRAIGHT, fixed, half_straight, octile, step};
use super::interpolation::Interpolation;
use super::neighbours::Cells;
use super::steps::ANYWHERE;
use super::{Route, cost_along};

settings! {
    /// D* Lite on the grid of `a_star`, whose settings count as well; plain A* where stairs or passages are part of the grid.
    pub struct DStarLiteConfig("navigation.d_star_lite") {
        /// Whether what became dearer waits until it lies on the way: Delayed D*.
        delayed: bool = false, "-", ANY, "Ferguson and Stentz 2005: The Delayed D* algorithm (004, ref 36.29)";
        /// Where more than this share of the cells has changed, the search begins anew.
        anew: f64 = 0.05, "1", within(0.0, 1.0);
    }
}

/// The order in which cells are looked at again: estimate of the whole way through a cell, then the way from it.
type QueueKey = (Cost, Cost);
/// Of a cell that is not to be looked at.
const NOT_QUEUED: QueueKey = (Cost::MAX, Cost::MAX);

/// What is known of a cell.
#[derive(Debug, Clone, Copy)]
struct CellCosts {
    /// Cost of the way from it to an end, as it was found.
    found: Cost,
    /// That cost by what its neighbours say; where the two differ, the cell is looked at again.
    ahead: Cost,
    /// Where it stands in the queue.
    key: QueueKey,
}

const UNKNOWN: CellCosts = CellCosts {
    found: NEVER,
    ahead: NEVER,
    key: NOT_QUEUED,
};

/// The grid that is searched, at one moment.
#[derive(Debug, Clone, Copy)]
pub struct Asked<'a> {
    /// Row by row, what a cell's length costs there: 1 or more, infinite where it may not be entered (the start always may).
    pub weights: &'a [f32],
    /// Cells a row.
    pub cols: usize,
    /// The cell where the way begins.
    pub start: usize,
    /// Where it may end, and what ending there costs, in cells; each cell once.
    pub ends: &'a [(u32, f64)],
}

/// The search, with what it knows of the grid. Reused.
#[derive(Debug, Clone, Default)]
pub struct DStarLite {
    delayed: bool,
    /// How ways lead between cells, where they are not bound to the eight steps.
    pub(super) interpolation: Option<Interpolation>,
    /// As they are at the moment; 1 at a start that may not be entered.
    pub(super) weights: Vec<f32>,
    pub(super) cols: usize,
    /// What ending in a cell costs; `NEVER` where no way ends.
    pub(super) ends: Vec<Cost>,
    /// The cells where a way may end.
    end_cells: Vec<(u32, f64)>,
    field: Vec<CellCosts>,
    /// Entries that are not what `field` says are out of date.
    queue: BinaryHeap<Reverse<(QueueKey, u32)>>,
    pub(super) start: usize,
    /// How far the start has moved: estimates of before are too high by no more than this.
    moved: Cost,
    /// Cells of which what their neighbours say may have changed.
    touched: Vec<u32>,
    /// Whether what became dearer is looked at, too.
    raising: bool,
    /// Cells looked at by the last search.
    pub expanded: usize,
}

impl DStarLite {
    /// A search that knows nothing yet.
    pub fn new(delayed: bool) -> Self {
        Self {
            delayed,
            ..Self::default()
        }
    }

    /// Forgets the grid.
    pub fn forget(&mut self) {
        *self = Self {
            interpolation: self.interpolation.take(),
            ..Self::new(self.delayed)
        };
    }

    /// The cheapest way on a grid: what was found before is repaired where that differs, unless the grid has another size or more than a
    /// share `anew` of its cells has changed.
    pub fn run(&mut self, asked: Asked<'_>, anew: f64) -> Option<Route> {
        self.take(asked, anew);
        self.route()
    }

    /// Forgets what was found and takes over a grid.
    pub fn begin(&mut self, asked: Asked<'_>) {
        let count = asked.weights.len();
        (self.cols, self.start, self.moved) = (asked.cols, asked.start, 0);
        self.weights.clear();
        self.weights.extend_from_slice(asked.weights);
        self.free_start();
        self.field.clear();
        self.field.resize(count, UNKNOWN);
        self.ends.clear();
        self.ends.resize(count, NEVER);
        self.end_cells.clear();
        self.queue.clear();
        self.touched.clear();
        self.set_ends(asked.ends);
    }

    /// The cheapest way on the grid as it is by now.
    pub fn route(&mut self) -> Option<Route> {
        self.update();
        self.way()
    }

    /// Finds out what changed of the costs, as far as the way from the start needs it.
    pub(super) fn update(&mut self) {
        self.expanded = 0;
        self.raising = !self.delayed;
        self.look_at_touched();
        self.repair();
        while self.delayed && self.raise_on_way() {
            self.raising = true;
            self.repair();
            self.raising = false;
        }
    }

    /// Takes over a grid; with a share `anew` as [`Self::run`] has it.
    pub(super) fn take(&mut self, asked: Asked<'_>, anew: f64) {
        let fits = self.cols == asked.cols && self.weights.len() == asked.weights.len();
        if !fits || !self.take_changes(asked, (anew * asked.weights.len() as f64) as usize) {
            self.begin(asked);
        }
    }

    /// What the way from a cell costs by what its neighbours say.
    pub(super) fn ahead(&self, cell: usize) -> Cost {
        self.field[cell].ahead
    }

    /// What the way from a cell costs as far as it was found.
    pub(super) fn found(&self, cell: usize) -> Cost {
        self.field[cell].found
    }

    /// The way along the field; `None` where none leads to an end.
    fn way(&self) -> Option<Route> {
        if self.field[self.start].ahead >= NEVER {
            return None;
        }
        let mut cells = vec![self.start as u32];
        let mut here = self.start;
        while let Some(next) = self.next(here).1 {
            here = next;
            cells.push(here as u32);
        }
        let end = self.end_cells.iter().find(|end| end.0 as usize == here)?.1;
        let cost = cost_along(&cells, &self.weights, self.cols) + end;
        Some(Route {
            cells,
            cost,
            corners: Vec::new(),
        })
    }

    /// What the way from a cell costs by what its neighbours say, and over which it leads; over none where it ends.
    fn next(&self, cell: usize) -> (Cost, Option<usize>) {
        let weight = self.weights[cell];
        if weight.is_infinite() {
            return (NEVER, None);
        }
        let (mut best, mut over) = (self.ends[cell], None);
        let cells = Cells::new(&self.weights, self.cols);
        cells.for_each_neighbour((cell, ANYWHERE), |next, half_length, _| {
            let cost = self.field[next].found + step(half_length, weight + self.weights[next]);
            if cost < best {
                (best, over) = (cost, Some(next));
            }
        });
        if let Some(interpolation) = &self.interpolation {
            let found = |cell: usize| self.field[cell].found;
            best = best.min(interpolation.ahead(&cells, cell, found));
        }
        (best, over)
    }

    /// The least that a way from the start to a cell costs, or less.
    fn away(&self, cell: usize) -> Cost {
        let [here, start] = [cell, self.start].map(|at| (at % self.cols, at / self.cols));
        let [cols, rows] = [here.0.abs_diff(start.0), here.1.abs_diff(start.1)];
        if self.interpolation.is_some() {
            half_straight(cols, rows)
        } else {
            octile(cols, rows)
        }
    }

    fn key(&self, cell: usize) -> QueueKey {
        let CellCosts { found, ahead, .. } = self.field[cell];
        let least = found.min(ahead);
        (least + self.away(cell) + self.moved, least)
    }
}

/// A cell and those beside it.
fn around(cell: usize, cols: usize, count: usize) -> impl Iterator<Item = usize> {
    let (col, row) = (cell % cols, cell / cols);
    let all_cols = col.saturating_sub(1)..(col + 2).min(cols);
    let rows = row.saturating_sub(1)..(row + 2).min(count / cols);
    rows.flat_map(move |row| all_cols.clone().map(move |col| row * cols + col))
}

#[cfg(test)]
mod tests;
