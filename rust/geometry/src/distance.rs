//! Exact Euclidean distance transform in two passes (Meijster, Roerdink and Hesselink 2000), in integers.

/// Squared distance, in cells, where no cell is blocked: further than anything in a grid of up to 10,000 cells a side.
pub const NOTHING_NEAR: u32 = 1 << 29;

/// No blocked cell in the column.
const FAR: i16 = 1 << 14;
/// Squares of up to twice this fit into 16 bits.
const FURTHEST_REACH: usize = 90;
/// So many columns to each side tell which ones can be left out.
const BESIDE: usize = 3;

/// Squared distances, in cells, from every cell's centre to the centre of the nearest blocked cell. Reused.
#[derive(Debug, Clone, Default)]
pub struct CellDistances {
    /// All squared distances, row by row, in cells.
    pub squared: Vec<u32>,
    /// Distance to the nearest blocked cell of the same column.
    along_column: Vec<i16>,
    envelope: Envelope,
}

impl CellDistances {
    /// Fills the field for a grid of `cols` columns, row by row. Allocates only when the grid grows.
    pub fn compute(&mut self, blocked: &[bool], cols: usize) {
        self.squared.resize(blocked.len(), 0);
        self.along_column.resize(blocked.len(), 0);
        if blocked.is_empty() {
            return;
        }
        self.columns(blocked, cols);
        self.envelope.resize(cols);
        let rows = self.along_column.chunks_exact(cols);
        for (heights, squared) in rows.zip(self.squared.chunks_exact_mut(cols)) {
            self.envelope.transform(heights, squared);
        }
    }

    /// Fills the field as [`Self::compute`] does where something is blocked within so many cells; elsewhere nothing counts as near.
    pub fn compute_within(&mut self, blocked: &[bool], cols: usize, reach: usize) {
        if reach > FURTHEST_REACH || blocked.is_empty() {
            self.compute(blocked, cols);
            return;
        }
        self.squared.resize(blocked.len(), 0);
        self.along_column.resize(blocked.len(), 0);
        self.columns(blocked, cols);
        self.envelope.resize(cols + 2 * reach);
        let rows = self.along_column.chunks_exact(cols);
        for (heights, squared) in rows.zip(self.squared.chunks_exact_mut(cols)) {
            self.envelope
                .transform_within(heights, squared, reach as i16);
        }
    }

    /// Squared distance of a cell by its index, in cells.
    pub fn squared(&self, index: usize) -> u32 {
        self.squared[index]
    }

    /// First pass, all columns at once: downwards, then upwards.
    fn columns(&mut self, blocked: &[bool], cols: usize) {
        for (here, &blocked) in self.along_column.iter_mut().zip(blocked) {
            *here = if blocked { 0 } else { FAR };
        }
        for first in (cols..blocked.len()).step_by(cols) {
            let (above, here) = self.along_column.split_at_mut(first);
            step(&above[first - cols..], &mut here[..cols]);
        }
        for first in (0..blocked.len() - cols).step_by(cols).rev() {
            let (here, below) = self.along_column.split_at_mut(first + cols);
            step(&below[..cols], &mut here[first..]);
        }
    }
}

/// From a row of cells to the one beside it.
fn step(from: &[i16], to: &mut [i16]) {
    for (here, &beside) in to.iter_mut().zip(from) {
        *here = (*here).min(beside + 1);
    }
}

/// Second pass: the lower envelope of one parabola a column, of a row at a time.
#[derive(Debug, Clone, Default)]
struct Envelope {
    /// A row with far columns before and behind it.
    padded: Vec<i16>,
    /// Whether a column may have a part in the envelope, 0 or 1, and those that may.
    counts: Vec<u16>,
    columns: Vec<u16>,
    arcs: Vec<Arc>,
    /// The least squares of a row.
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

impl Envelope {
    fn resize(&mut self, cols: usize) {
        self.padded.clear();
        self.padded.resize(cols + 2 * BESIDE, FAR);
        self.counts.resize(cols, 0);
        self.columns.resize(cols, 0);
    }

    /// Squared distances of a row from the distances along its columns.
    fn transform(&mut self, heights: &[i16], squared: &mut [u32]) {
        let count = self.choose(heights);
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
            for (x, squared) in (arc.begin..).zip(&mut squared[arc.begin as usize..end]) {
                let off = x - arc.column;
                *squared = (off * off + height) as u32;
            }
            end = arc.begin as usize;
        }
    }

    /// Squared distances of a row up to a reach, which is so short that to compare with every column within it is the fastest.
    fn transform_within(&mut self, heights: &[i16], squared: &mut [u32], reach: i16) {
        let (cols, beyond) = (heights.len(), reach + 1);
        let nearest = heights.iter().fold(FAR, |least, &height| least.min(height));
        if nearest > reach {
            squared.fill(NOTHING_NEAR);
            return;
        }
        let width = reach as usize;
        self.padded[..width].fill(beyond * beyond);
        self.padded[width + cols..][..width].fill(beyond * beyond);
        let middle = &mut self.padded[width..][..cols];
        for (square, &height) in middle.iter_mut().zip(heights) {
            let height = height.min(beyond);
            *square = height * height;
        }
        self.least.clear();
        self.least.resize(cols, i16::MAX);
        for (from, off) in (-reach..=reach).enumerate() {
            let columns = &self.padded[from..][..cols];
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
    /// Leaves out columns that others are nowhere higher than: one to the left and one to the right that are no higher at this
    /// column's own place. Returns how many are left.
    fn choose(&mut self, heights: &[i16]) -> usize {
        let cols = heights.len();
        self.padded[BESIDE..BESIDE + cols].copy_from_slice(heights);
        let beside = |on: usize| &self.padded[on..on + cols];
        let [left, right] = [
            [beside(2), beside(1), beside(0)],
            [beside(4), beside(5), beside(6)],
        ];
        for (col, count) in self.counts.iter_mut().enumerate() {
            let here = heights[col];
            // Lower ones k columns away are no higher here where h^2 - k^2 >= (h - 1)^2.
            let lower = |[by_1, by_2, by_3]: [&[i16]; BESIDE]| {
                (by_1[col] < here)
                    | ((by_2[col] < here) & (here >= 3))
                    | ((by_3[col] < here) & (here >= 5))
            };
            *count = u16::from(!(lower(left) & lower(right)) & (here < FAR));
        }
        let mut chosen = 0;
        for (col, &count) in self.counts.iter().enumerate() {
            self.columns[chosen] = col as u16;
            chosen += usize::from(count);
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn it_equals_brute_force(
            cols in 1..24_usize, rows in 1..24_usize, seeds in prop::collection::vec((0..24_usize, 0..24_usize), 0..60),
        ) {
            let mut blocked = vec![false; cols * rows];
            for (col, row) in seeds {
                if col < cols && row < rows { blocked[row * cols + col] = true; }
            }
            let mut field = CellDistances::default();
            field.compute(&blocked, cols);
            let within = |reach: usize| {
                let near = |&squared: &u32| squared <= (reach * reach) as u32;
                let squared = field.squared.iter();
                squared.map(|squared| Some(*squared).filter(near).unwrap_or(NOTHING_NEAR)).collect::<Vec<_>>()
            };
            let mut bounded = CellDistances::default();
            for reach in [0, 1, 5, 90] {
                bounded.compute_within(&blocked, cols, reach);
                prop_assert_eq!(&bounded.squared, &within(reach));
            }
            for i in 0..cols * rows {
                let nearest = (0..cols * rows)
                    .filter(|&j| blocked[j])
                    .map(|j| (i % cols).abs_diff(j % cols).pow(2) + (i / cols).abs_diff(j / cols).pow(2))
                    .min()
                    .map_or(NOTHING_NEAR, |d| d as u32);
                prop_assert_eq!(field.squared(i), nearest);
            }
        }
    }

    #[test]
    fn a_field_can_be_used_again_for_another_size() {
        let mut field = CellDistances::default();
        field.compute(&[true; 12], 4);
        field.compute(&[true, false, false], 3);
        assert_eq!(field.squared, [0, 1, 4]);
    }
}
