//! Steps from a cell to its eight neighbours.

use std::f64::consts::FRAC_1_SQRT_2;

use wide::f32x4;

use super::steps::{Block, EASTERN, MIDDLE, Steps, Trail, WESTERN};

/// Half of how long the eight steps are, cells: what each of their two cells has of it.
const HALF_LENGTHS: [f64; 8] = [
    0.5,
    0.5,
    0.5,
    0.5,
    FRAC_1_SQRT_2,
    FRAC_1_SQRT_2,
    FRAC_1_SQRT_2,
    FRAC_1_SQRT_2,
];

/// The up to eight cells around one of a grid with so many cells.
pub(crate) fn around(cell: usize, cols: usize, cells: usize) -> impl Iterator<Item = usize> {
    let (col, row) = (cell % cols, cell / cols);
    let rows = row.saturating_sub(1)..=(row + 1).min(cells / cols - 1);
    rows.flat_map(move |row| {
        let cols_of = col.saturating_sub(1)..=(col + 1).min(cols - 1);
        cols_of.map(move |col| row * cols + col)
    })
    .filter(move |&beside| beside != cell)
}

/// The cells of a grid, row by row, with what a length costs there: infinite where it may not be entered.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cells<'a> {
    weights: &'a [f32],
    cols: usize,
    /// One over the columns in units of 2^-64, rounded up: tells a row's first cell without a division.
    per_col: u64,
    /// What leads from a cell's index to those of its neighbours, wrapping around.
    offsets: [usize; 8],
}

impl<'a> Cells<'a> {
    pub(crate) fn new(weights: &'a [f32], cols: usize) -> Self {
        let per_col = (u64::MAX / cols.max(1) as u64).wrapping_add(1);
        let (below, above) = (cols.wrapping_neg(), cols);
        let beside = |row: usize| [row.wrapping_sub(1), row.wrapping_add(1)];
        let [west, east] = beside(0);
        let ([south_west, south_east], [north_west, north_east]) = (beside(below), beside(above));
        Self {
            weights,
            cols,
            per_col,
            offsets: [
                west, east, below, above, south_west, south_east, north_west, north_east,
            ],
        }
    }

    /// The cell so many columns and rows from another, where that may be entered, and what a length costs there.
    #[inline]
    pub(crate) fn free_at(&self, cell: usize, cols: isize, rows: isize) -> Option<(usize, f32)> {
        let col = (cell % self.cols).checked_add_signed(cols)?;
        let at = (cell / self.cols).checked_add_signed(rows)? * self.cols + col;
        let weight = *self.weights.get(at)?;
        (col < self.cols && weight.is_finite()).then_some((at, weight))
    }

    /// What a length costs in a cell, which may be where a way starts that nothing may enter.
    #[inline]
    pub(crate) fn weight_to_leave(&self, cell: usize) -> f32 {
        let weight = self.weights[cell];
        if weight.is_finite() { weight } else { 1.0 }
    }

    /// Whether a cell is the first of its row (Lemire, Kaser and Kurz 2019: exact for indices of 32 bits).
    #[inline]
    fn begins_row(&self, cell: usize) -> bool {
        (cell as u64).wrapping_mul(self.per_col) <= self.per_col.wrapping_sub(1)
    }

    /// Which cells about one are free, and whether all of them cost as much as it does.
    #[inline]
    fn about(&self, cell: usize) -> (Block, bool) {
        let [below, here, above] = [cell.wrapping_sub(self.cols), cell, cell + self.cols]
            .map(|middle| self.three_about(middle));
        let same = f32x4::splat(self.weights[cell]);
        let (mut free, mut alike) = (0, 0);
        for (row, weights) in [below, here, above].into_iter().enumerate() {
            let three = |lanes: f32x4| (lanes.to_bitmask() as usize & 0b111) << (3 * row);
            free |= three(weights.simd_lt(f32x4::splat(f32::INFINITY)));
            alike |= three(weights.simd_eq(same));
        }
        let alike = (free & !alike) & !MIDDLE == 0;
        if self.begins_row(cell) {
            free &= !WESTERN;
        }
        if self.begins_row(cell + 1) {
            free &= !EASTERN;
        }
        (free, alike)
    }

    /// The weights before, at and behind an index; the fourth is anything.
    #[inline]
    fn three_about(&self, index: usize) -> f32x4 {
        let first = index.wrapping_sub(1);
        // Row 0 has nothing below it: the index wraps around and is free nowhere.
        if let Some(four) = self.weights.get(first..first.wrapping_add(4))
            && let Some(&four) = four.first_chunk::<4>()
        {
            return f32x4::new(four);
        }
        self.at_end(first)
    }

    #[cold]
    fn at_end(&self, first: usize) -> f32x4 {
        let at = |index: usize| self.weights.get(index).copied().unwrap_or(f32::INFINITY);
        f32x4::new(std::array::from_fn(|lane| at(first.wrapping_add(lane))))
    }

    /// Calls `visit` with every free neighbour of a cell, half the length of the step and its trail; but for those that another way
    /// reaches for less.
    #[inline]
    pub(crate) fn for_each_neighbour(
        &self,
        (cell, trail): (usize, Trail),
        mut visit: impl FnMut(usize, f64, Trail),
    ) {
        let (free, alike) = self.about(cell);
        for (at, trail) in Steps::from(free, alike, trail) {
            visit(cell.wrapping_add(self.offsets[at]), HALF_LENGTHS[at], trail);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::{HashSet, VecDeque};

    use super::*;
    use proptest::prelude::*;

    use crate::search::steps::ANYWHERE;

    const COLS: usize = 5;

    /// What the ways from a cell cost, by all steps there are.
    fn costs_from(start: usize, weights: &[f32]) -> Vec<f64> {
        let cells = Cells::new(weights, COLS);
        let mut costs = vec![f64::INFINITY; weights.len()];
        costs[start] = 0.0;
        let mut queue = VecDeque::from([start]);
        while let Some(cell) = queue.pop_front() {
            cells.for_each_neighbour((cell, ANYWHERE), |next, half_length, _| {
                let through = costs[cell] + half_length * f64::from(weights[cell] + weights[next]);
                if through < costs[next] - 1e-9 {
                    costs[next] = through;
                    queue.push_back(next);
                }
            });
        }
        costs
    }

    proptest! {
        #[test]
        fn what_is_left_out_costs_half_a_cell_more(
            blocked in prop::collection::vec(prop::bool::weighted(0.2), COLS * 7),
            dear in 0..COLS * 7,
            start in 0..COLS * 7,
        ) {
            // Two regions of one weight each.
            let weight = |(cell, &blocked): (usize, &bool)| match (blocked && cell != start, cell < dear) {
                (true, _) => f32::INFINITY,
                (_, true) => 1.0,
                (_, false) => 1.5,
            };
            let weights: Vec<f32> = blocked.iter().enumerate().map(weight).collect();
            let (cells, costs) = (Cells::new(&weights, COLS), costs_from(start, &weights));
            // Every trail by which a cheapest way comes to a cell.
            let (mut seen, mut queue) = (HashSet::new(), vec![(start, ANYWHERE)]);
            while let Some((cell, trail)) = queue.pop() {
                let mut ahead = vec![];
                cells.for_each_neighbour((cell, trail), |next, _, trail| ahead.push((next, trail)));
                cells.for_each_neighbour((cell, ANYWHERE), |next, half_length, _| {
                    let through = costs[cell] + half_length * f64::from(weights[cell] + weights[next]);
                    match ahead.iter().find(|on| on.0 == next) {
                        Some(&on) if through < costs[next] + 1e-9 && seen.insert(on) => queue.push(on),
                        Some(_) => {}
                        None => assert!(through > costs[next] + 0.5 || next == start),
                    }
                });
            }
        }

        #[test]
        fn what_is_behind_was_nearer_from_the_cell_before(
            weights in prop::collection::vec(prop_oneof![4 => 1.0..9.0f32, 1 => Just(f32::INFINITY)], COLS * 4),
            before in 0..COLS * 4,
        ) {
            let cost = |from: usize, to: usize, half_length: f64| half_length * f64::from(weights[from] + weights[to]);
            prop_assume!(weights[before].is_finite());
            let cells = Cells::new(&weights, COLS);
            let mut from_before = vec![];
            cells.for_each_neighbour((before, ANYWHERE), |next, half_length, heading| from_before.push((next, half_length, heading)));
            for &(cell, half_length, heading) in &from_before {
                let (mut ahead, mut all) = (vec![], vec![]);
                cells.for_each_neighbour((cell, heading), |next, _, _| ahead.push(next));
                cells.for_each_neighbour((cell, ANYWHERE), |next, half_length, _| all.push((next, half_length)));
                for (next, on) in all.into_iter().filter(|(next, _)| !ahead.contains(next) && *next != before) {
                    let straight = from_before.iter().find(|step| step.0 == next).unwrap();
                    let by_cell = cost(before, cell, half_length) + cost(cell, next, on);
                    prop_assert!(cost(before, next, straight.1) < by_cell);
                }
            }
        }
    }
}
