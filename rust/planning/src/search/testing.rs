//! Random grids that change, for the tests of the searches.

use geometry::SplitMix64;

use super::{Route, octile};

/// A grid with a start and ends.
#[derive(Debug, Clone)]
pub(crate) struct World {
    pub(crate) weights: Vec<f32>,
    pub(crate) cols: usize,
    pub(crate) start: usize,
    pub(crate) ends: Vec<(u32, f64)>,
}

/// A cell's new weight.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Change {
    pub(crate) cell: usize,
    pub(crate) weight: f32,
}

pub(crate) fn below(count: usize, random: &mut SplitMix64) -> usize {
    ((random.uniform() * count as f64) as usize).min(count - 1)
}

/// One in four blocked, one in three dear.
fn weight(random: &mut SplitMix64) -> f32 {
    match below(12, random) {
        0..3 => f32::INFINITY,
        3..7 => 1.0 + 4.0 * random.uniform() as f32,
        _ => 1.0,
    }
}

impl World {
    pub(crate) fn random(cols: usize, rows: usize, random: &mut SplitMix64) -> Self {
        let weights = (0..cols * rows).map(|_| weight(random)).collect();
        let mut world = Self {
            weights,
            cols,
            start: below(cols * rows, random),
            ends: vec![],
        };
        world.set_ends(random);
        world
    }

    /// Ends elsewhere: one, or a few that cost something.
    pub(crate) fn set_ends(&mut self, random: &mut SplitMix64) {
        let count = 1 + 3 * below(2, random);
        let mut ends: Vec<_> = (0..count)
            .map(|_| {
                (
                    below(self.weights.len(), random) as u32,
                    3.0 * random.uniform(),
                )
            })
            .collect();
        ends.sort_by_key(|end| end.0);
        ends.dedup_by_key(|end| end.0);
        self.ends = ends;
    }

    /// Changes one to twelve cells, half of them beside each other.
    pub(crate) fn change(&mut self, random: &mut SplitMix64) -> Vec<Change> {
        let first = below(self.weights.len(), random);
        let count = 1 + below(12, random);
        let cells = (0..count).map(|at| {
            if at % 2 == 0 {
                (first + at / 2 % 3 + at / 6 * self.cols) % self.weights.len()
            } else {
                below(self.weights.len(), random)
            }
        });
        let cells: Vec<_> = cells.collect();
        let changes = cells.into_iter().map(|cell| Change {
            cell,
            weight: weight(random),
        });
        let changes: Vec<_> = changes.collect();
        for change in &changes {
            self.weights[change.cell] = change.weight;
        }
        changes
    }

    /// Moves the start along a way, or anywhere where there is none or now and then.
    pub(crate) fn walk(&mut self, route: Option<&Route>, random: &mut SplitMix64) {
        let anywhere = below(self.weights.len(), random);
        self.start = match route {
            Some(route) if below(20, random) > 0 && route.cells.len() > 1 => {
                route.cells[(1 + below(3, random)).min(route.cells.len() - 1)] as usize
            }
            _ => anywhere,
        };
    }

    /// Blocks or opens a square of cells.
    pub(crate) fn set_box(&mut self, [col, row]: [usize; 2], side: usize, weight: f32) {
        for row in row..row + side {
            self.weights[row * self.cols + col..][..side].fill(weight);
        }
    }

    /// Moves the grid over the ground; what comes into it is random, and ends that leave it are none any more.
    pub(crate) fn shift(&mut self, cols: isize, rows: isize, random: &mut SplitMix64) {
        let (width, height) = (self.cols, self.weights.len() / self.cols);
        let moved = |cell: usize, [cols, rows]: [isize; 2]| {
            let col = (cell % width).checked_add_signed(cols);
            let row = (cell / width).checked_add_signed(rows);
            let at = col.zip(row);
            let at = at.filter(|&(col, row)| col < width && row < height);
            at.map(|(col, row)| row * width + col)
        };
        let before = std::mem::take(&mut self.weights);
        let of = |cell| moved(cell, [cols, rows]).map(|was| before[was]);
        let weights = (0..before.len()).map(|cell| of(cell).unwrap_or_else(|| weight(random)));
        self.weights = weights.collect();
        let after = |cell: u32| moved(cell as usize, [-cols, -rows]);
        let ends = self.ends.iter();
        self.ends = ends
            .filter_map(|&(cell, cost)| Some((after(cell)? as u32, cost)))
            .collect();
        if self.ends.is_empty() {
            self.set_ends(random);
        }
        self.start = after(self.start as u32).unwrap_or(0);
    }

    pub(crate) fn ending(&self, cell: usize) -> Option<f64> {
        let end = self.ends.iter().find(|end| end.0 as usize == cell);
        end.map(|end| end.1)
    }

    /// The least that a way from a cell to an end costs.
    pub(crate) fn remaining(&self, cell: usize) -> f64 {
        let off = |at: usize, end: usize| at as f64 - end as f64;
        let left = self.ends.iter().map(|&(end, cost)| {
            let end = end as usize;
            let cols = off(cell % self.cols, end % self.cols);
            octile(cols, off(cell / self.cols, end / self.cols)) + cost
        });
        left.fold(f64::INFINITY, f64::min)
    }
}
