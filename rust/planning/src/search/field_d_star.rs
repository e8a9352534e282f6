//! Field D*: ways that are not bound to eight directions, repaired like those of D* Lite where cells change.
//!
//! After Ferguson and Stentz 2005 (004, ref 36.30). The nodes are the middles of the cells, not their corners, so that the ways of the grid
//! are ways here. Between nodes costs are interpolated; see [`super::interpolation`]. Where a way of the grid meets another one, that says
//! less than is so, and the way down the field may cost more than it promised: then the grid's cheapest way is looked for, too, and the
//! cheaper of both is taken.

mod line;

use settings::{settings, within};

use super::d_star_lite::{Asked, DStarLite};
use super::fixed_cost::{NEVER, between, in_cells};
use super::interpolation::Interpolation;
use super::{Route, Search, octile};
use line::{Line, candidates};

settings! {
    /// Field D* on the grid of `a_star`, whose settings count as well; plain A* where stairs or passages are part of the grid.
    pub struct FieldDStarConfig("navigation.field_d_star") {
        /// Into how many pieces the places part the line between two cells' middles at which a way may cross it.
        pieces: usize = 8, "1", within(1.0, 64.0), "Ferguson and Stentz 2005: Field D* (004, ref 36.30), there without pieces";
        /// Where more than this share of the cells has changed, the search begins anew.
        anew: f64 = 0.05, "1", within(0.0, 1.0);
    }
}

/// The search, with what it knows of the grid. Reused.
#[derive(Debug, Clone)]
pub struct FieldDStar {
    search: DStarLite,
    grid: Search,
    pieces: usize,
}

impl FieldDStar {
    /// A search that knows nothing yet; lines are parted into so many pieces.
    pub fn new(pieces: usize) -> Self {
        let mut search = DStarLite::new(false);
        search.interpolation = Some(Interpolation::new(pieces));
        Self {
            search,
            grid: Search::default(),
            pieces,
        }
    }

    /// Forgets the grid.
    pub fn forget(&mut self) {
        self.search.forget();
    }

    /// Cells looked at by the last search.
    pub const fn expanded(&self) -> usize {
        self.search.expanded
    }

    /// Moves the grid over the ground, as [`DStarLite::shift`].
    pub fn shift(&mut self, cols: isize, rows: isize) {
        self.search.shift(cols, rows);
    }

    /// The cheapest way that is found on a grid, as [`DStarLite::run`] has it.
    pub fn run(&mut self, asked: Asked<'_>, anew: f64) -> Option<Route> {
        self.search.take(asked, anew);
        self.search.update();
        let promised = in_cells(self.search.ahead(self.search.start));
        let way = self.way();
        match &way {
            Some(way) if way.cost <= promised => {}
            None if promised >= in_cells(NEVER) => {}
            _ => {
                let grid = self.along_grid(asked)?;
                let dearer = (way.as_ref()).is_none_or(|way| way.cost > grid.cost);
                return if dearer { Some(grid) } else { way };
            }
        }
        way
    }

    /// The cheapest way by the grid's eight steps.
    fn along_grid(&mut self, asked: Asked<'_>) -> Option<Route> {
        let at = |cell: usize| [cell % asked.cols, cell / asked.cols].map(|at| at as f64);
        let mut bounds = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for end in asked.ends {
            let end = at(end.0 as usize);
            bounds[0] = [0, 1].map(|axis| bounds[0][axis].min(end[axis]));
            bounds[1] = [0, 1].map(|axis| bounds[1][axis].max(end[axis]));
        }
        // To the rectangle that holds all ends.
        let remaining = |cell: usize| {
            let here = at(cell);
            let off =
                [0, 1].map(|axis| here[axis] - here[axis].clamp(bounds[0][axis], bounds[1][axis]));
            octile(off[0], off[1])
        };
        let ends = asked.ends;
        let ending = |cell: usize| {
            ends.iter()
                .find(|end| end.0 as usize == cell)
                .map(|end| end.1)
        };
        let (weights, cols, start) = (asked.weights, asked.cols, asked.start);
        let mut route = (self.grid).run(weights, cols, start, ending, remaining)?;
        route.corners = route.cells.iter().map(|&cell| at(cell as usize)).collect();
        Some(route)
    }

    /// The way down the field, from line to line.
    fn way(&self) -> Option<Route> {
        let search = &self.search;
        let start = search.start;
        let at = |cell: usize| [(cell % search.cols) as f64, (cell / search.cols) as f64];
        let (mut here, mut cost) = (at(start), 0.0);
        let mut left = self.left(here)?;
        let (mut corners, mut cells) = (vec![here], vec![start as u32]);
        loop {
            if let Some(end) = self.end(here, left) {
                cost += end;
                return Some(Route {
                    cells,
                    cost,
                    corners,
                });
            }
            let (next, line) = self.onward(here, left)?;
            cost += line.cost;
            let crossed = line
                .cells
                .iter()
                .map(|&[col, row]| (row * search.cols + col) as u32);
            cells.extend(crossed);
            cells.dedup();
            here = next;
            left = self.left(here)?;
            corners.push(here);
        }
    }

    /// What ending here costs, where the way ends.
    fn end(&self, [col, row]: [f64; 2], left: f64) -> Option<f64> {
        if col.fract() != 0.0 || row.fract() != 0.0 {
            return None;
        }
        let end = self.search.ends[row as usize * self.search.cols + col as usize];
        (end < NEVER && in_cells(end) <= left).then(|| in_cells(end))
    }

    /// What the way from a place on a line costs, by interpolation.
    fn left(&self, [col, row]: [f64; 2]) -> Option<f64> {
        let [across, along] = [col.fract(), row.fract()];
        let cell = row as usize * self.search.cols + col as usize;
        let next = match (across > 0.0, along > 0.0) {
            (true, _) => cell + 1,
            (_, true) => cell + self.search.cols,
            _ => cell,
        };
        let share = across.max(along);
        let costs = [cell, next].map(|cell| self.search.found(cell));
        if cell == self.search.start && next == cell {
            let ahead = self.search.ahead(cell);
            return (ahead < NEVER).then(|| in_cells(ahead));
        }
        let known = costs[0] < NEVER && costs[1] < NEVER;
        known.then(|| in_cells(between(costs[0], costs[1], share)))
    }

    /// The best place on a line around to go on to, of those from which less is left than from here.
    fn onward(&self, here: [f64; 2], left: f64) -> Option<([f64; 2], Line)> {
        let (weights, cols) = (&self.search.weights[..], self.search.cols);
        let mut best: Option<(f64, [f64; 2], Line)> = None;
        candidates(here, self.pieces, |to| {
            let rows = weights.len() / cols;
            let inside = to[0] >= 0.0 && to[1] >= 0.0;
            if !inside || to[0] > (cols - 1) as f64 || to[1] > (rows - 1) as f64 {
                return;
            }
            let Some(after) = self.left(to).filter(|&after| after < left) else {
                return;
            };
            if let Some(line) = Line::between(here, to, weights, cols) {
                let through = line.cost + after;
                if best.as_ref().is_none_or(|best| through < best.0) {
                    best = Some((through, to, line));
                }
            }
        });
        best.map(|(_, to, line)| (to, line))
    }
}

#[cfg(test)]
mod tests;
