//! The second pass of the distance transform: a row at a time, the lower envelope of one parabola a column.

use super::NOTHING_NEAR;

/// No blocked cell in the column.
pub(super) const FAR: i16 = 1 << 14;
/// So many columns to each side tell which ones can be left out.
const BESIDE: usize = 3;
/// So many columns are left out at once where all can be.
const TOGETHER: usize = 8;
/// Where more than one column in so many is left, distances are short as a rule.
const CROWDED: usize = 3;
/// Where one is still longer after so many columns, the others are not tried.
const SOON: usize = 6;
/// Distances of up to so many cells are short.
const SHORT: usize = 12;
/// Whose square and that of a short one fit into 16 bits together.
const BEYOND: i16 = 127;

/// Distances along the columns of a row, and what the squared distances of its cells are found with.
#[derive(Debug, Clone, Default)]
pub(super) struct Row {
    /// Distances along the columns, with far columns before and behind them.
    heights: Vec<i16>,
    /// Whether a column may have a part in the envelope, 0 or 1, and those that may.
    counts: Vec<u8>,
    columns: Vec<u16>,
    arcs: Vec<Arc>,
    /// Squares of a row with far columns before and behind them, and the least ones.
    squares: Vec<i16>,
    least: Vec<i16>,
}

/// A parabola where it is the lowest.
#[derive(Debug, Clone, Copy)]
struct Arc {
    column: i32,
    /// The first x that it is the lowest at.
    begin: i32,
    /// Where it would be at x = 0.
    offset: i32,
}

impl Row {
    /// Before the rows of a grid, from the last to the first.
    pub(super) fn begin(&mut self, cols: usize) {
        self.heights.clear();
        self.heights.resize(cols + 2 * BESIDE, FAR);
        self.counts.clear();
        self.counts.resize(cols.next_multiple_of(TOGETHER), 0);
        self.columns.resize(self.counts.len() + TOGETHER, 0);
    }

    /// Distances along the columns.
    pub(super) fn heights(&self) -> &[i16] {
        &self.heights[BESIDE..self.heights.len() - BESIDE]
    }

    /// From the row below to this one.
    pub(super) fn rise(&mut self, from_above: &[i16]) {
        for (here, &above) in self.heights[BESIDE..].iter_mut().zip(from_above) {
            *here = above.min(*here + 1);
        }
    }

    /// Squared distances of the row's cells: by few parabolas, and by each column's own distance.
    pub(super) fn transform(&mut self, squared: &mut [u32]) {
        let count = self.choose(squared.len());
        if count * CROWDED > squared.len() && self.step_by_step(squared) {
            return;
        }
        let heights = &self.heights[BESIDE..][..squared.len()];
        self.arcs.clear();
        for &column in &self.columns[..count] {
            let (column, height) = (i32::from(column), i32::from(heights[usize::from(column)]));
            let offset = height * height + column * column;
            let mut begin = 0;
            while let Some(last) = self.arcs.last() {
                // Before this x `last` is nearer than `column`, or as near.
                begin = last.met_by(column, offset) + 1;
                if begin > last.begin {
                    break;
                }
                let _ = self.arcs.pop();
                begin = 0;
            }
            if (begin as usize) < heights.len() {
                self.arcs.push(Arc {
                    column,
                    begin,
                    offset,
                });
            }
        }
        if self.arcs.is_empty() {
            squared.fill(NOTHING_NEAR);
        }
        let mut end = squared.len();
        for arc in self.arcs.iter().rev() {
            let height = arc.offset - arc.column * arc.column;
            let begin = arc.begin as usize;
            let cells = squared[begin..end].iter_mut().zip(&heights[begin..end]);
            for (off, (squared, &own)) in (begin as i16 - arc.column as i16..).zip(cells) {
                let off = i32::from(off) * i32::from(off) + height;
                let own = i32::from(own) * i32::from(own);
                *squared = off.min(own) as u32;
            }
            end = begin;
        }
    }

    /// Squared distances of a row where all are short, each column compared with those one off, then two and so on; whether they are.
    fn step_by_step(&mut self, squared: &mut [u32]) -> bool {
        let cols = squared.len();
        let heights = &self.heights[BESIDE..][..cols];
        self.squares.resize(cols + 2 * SHORT, 0);
        self.squares.fill(BEYOND * BEYOND);
        let middle = &mut self.squares[SHORT..][..cols];
        for (square, &height) in middle.iter_mut().zip(heights) {
            let height = height.min(BEYOND);
            *square = height * height;
        }
        self.least.clear();
        self.least.extend_from_slice(middle);
        for off in 1..=SHORT {
            let square = (off * off) as i16;
            let beside = |from: usize| &self.squares[from..][..cols];
            let [left, right] = [beside(SHORT - off), beside(SHORT + off)];
            let mut greatest = 0;
            for ((least, &left), &right) in self.least.iter_mut().zip(left).zip(right) {
                *least = (*least).min(left.min(right) + square);
                greatest = greatest.max(*least);
            }
            if usize::from(greatest as u16) <= (off + 1) * (off + 1) {
                for (squared, &least) in squared.iter_mut().zip(&self.least) {
                    *squared = least as u32;
                }
                return true;
            }
            if off >= SOON && usize::from(greatest as u16) > SHORT * SHORT {
                return false;
            }
        }
        false
    }

    /// Squared distances of a row up to a reach, which is so short that to compare with every column within it is the fastest.
    pub(super) fn transform_within(&mut self, squared: &mut [u32], reach: i16) {
        let (cols, beyond) = (squared.len(), reach + 1);
        let heights = &self.heights[BESIDE..][..cols];
        let nearest = heights.iter().fold(FAR, |least, &height| least.min(height));
        if nearest > reach {
            squared.fill(NOTHING_NEAR);
            return;
        }
        let width = reach as usize;
        self.squares.resize(cols + 2 * width, 0);
        self.squares[..width].fill(beyond * beyond);
        self.squares[width + cols..].fill(beyond * beyond);
        let middle = &mut self.squares[width..][..cols];
        for (square, &height) in middle.iter_mut().zip(heights) {
            let height = height.min(beyond);
            *square = height * height;
        }
        self.least.clear();
        self.least.resize(cols, i16::MAX);
        for (from, off) in (-reach..=reach).enumerate() {
            let columns = &self.squares[from..][..cols];
            for (least, &square) in self.least.iter_mut().zip(columns) {
                *least = (*least).min(square + off * off);
            }
        }
        for (squared, &least) in squared.iter_mut().zip(&self.least) {
            let near = least <= reach * reach;
            *squared = if near { least as u32 } else { NOTHING_NEAR };
        }
    }

    #[expect(
        clippy::needless_bitwise_bool,
        reason = "without a branch, several columns at a time"
    )]
    /// Leaves out columns whose parabola nobody needs but the column itself: one to the left is no higher from the next column
    /// leftwards, and one to the right from the next rightwards. Returns how many are left.
    fn choose(&mut self, cols: usize) -> usize {
        let beside = |on: usize| &self.heights[on..][..cols];
        let [left, right] = [
            [beside(2), beside(1), beside(0)],
            [beside(4), beside(5), beside(6)],
        ];
        let heights = beside(BESIDE);
        for (col, count) in self.counts[..cols].iter_mut().enumerate() {
            let here = heights[col];
            // One k columns away is lower a column off where (k - 1)^2 + (h - 1)^2 < 1 + h^2. The next one may be as high: no
            // column lies between that would need either of the two if each was left out for the other.
            let lower = |[by_1, by_2, by_3]: [&[i16]; BESIDE]| {
                (by_1[col] <= here) | (by_2[col] < here) | ((by_3[col] < here) & (here >= 3))
            };
            *count = u8::from(!(lower(left) & lower(right)) & (here < FAR));
        }
        let mut chosen = 0;
        for (index, counts) in self.counts.chunks_exact(TOGETHER).enumerate() {
            if counts == [0; TOGETHER] {
                continue;
            }
            for (col, &count) in (index * TOGETHER..).zip(counts) {
                self.columns[chosen] = col as u16;
                chosen += usize::from(count);
            }
        }
        chosen
    }
}

impl Arc {
    /// The last whole x at which it is no higher than the parabola of a column further right.
    #[inline]
    fn met_by(&self, column: i32, offset: i32) -> i32 {
        let (gap, rise) = (column - self.column, offset - self.offset);
        // Most are neighbours, and a shift is faster than a division.
        if gap == 1 {
            rise >> 1
        } else {
            rise.div_euclid(2 * gap)
        }
    }
}
