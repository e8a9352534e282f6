//! Exact Euclidean distance transform in two passes (Meijster, Roerdink and Hesselink 2000), in integers.

/// Squared distance, in cells, where no cell is blocked: further than anything in a grid of up to 10,000 cells a side.
pub const NOTHING_NEAR: u32 = 1 << 29;

/// No blocked cell in the column.
const FAR: u32 = 1 << 14;

/// Squared distances, in cells, from every cell's centre to the centre of the nearest blocked cell. Reused.
#[derive(Debug, Clone, Default)]
pub struct DistanceField {
    squared: Vec<u32>,
    /// Distance to the nearest blocked cell of the same column.
    along_column: Vec<u32>,
    /// Columns of the lower envelope of parabolas, and where each begins to be the lowest.
    centers: Vec<usize>,
    begins: Vec<usize>,
}

impl DistanceField {
    /// Fills the field for a grid of `cols` columns, row by row. Allocates only when the grid grows.
    pub fn compute(&mut self, blocked: &[bool], cols: usize) {
        self.squared.resize(blocked.len(), 0);
        self.along_column.resize(blocked.len(), 0);
        if blocked.is_empty() {
            return;
        }
        self.columns(blocked, cols);
        for row in 0..blocked.len() / cols {
            self.row(row * cols, cols);
        }
    }

    /// Squared distance of a cell by its index, in cells.
    pub fn squared(&self, index: usize) -> u32 {
        self.squared[index]
    }

    /// All squared distances, row by row, in cells.
    pub fn all_squared(&self) -> &[u32] {
        &self.squared
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

    /// Second pass: the lower envelope of one parabola a column.
    fn row(&mut self, start: usize, cols: usize) {
        let heights = &self.along_column[start..start + cols];
        let at = |x: usize, column: usize| {
            let height = u64::from(heights[column]);
            (x.abs_diff(column) as u64).pow(2) + height * height
        };
        // `offset`: where a parabola would be if its column were 0.
        let offset = |column: usize| at(0, column) as i64;
        self.centers.clear();
        self.begins.clear();
        for column in (0..cols).filter(|&column| heights[column] < FAR) {
            let mut begin = 0;
            while let (Some(&last), Some(&last_begin)) = (self.centers.last(), self.begins.last()) {
                if at(last_begin, last) > at(last_begin, column) {
                    let _ = self.centers.pop();
                    let _ = self.begins.pop();
                } else {
                    // The first x at which `column` is nearer than `last`; not negative, as `last` wins where it begins.
                    let difference = (offset(column) - offset(last)) as u64;
                    begin = (difference / (2 * (column - last)) as u64) as usize + 1;
                    break;
                }
            }
            if begin < cols {
                self.centers.push(column);
                self.begins.push(begin);
            }
        }
        let row = &mut self.squared[start..start + cols];
        if self.centers.is_empty() {
            row.fill(NOTHING_NEAR);
        }
        let mut end = cols;
        for (&center, &begin) in self.centers.iter().zip(&self.begins).rev() {
            for (x, squared) in (begin..end).zip(&mut row[begin..end.max(begin)]) {
                *squared = at(x, center) as u32;
            }
            end = end.min(begin);
        }
    }
}

/// From a row of cells to the one beside it.
fn step(from: &[u32], to: &mut [u32]) {
    for (here, &beside) in to.iter_mut().zip(from) {
        *here = (*here).min(beside + 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn it_equals_brute_force(
            cols in 1..24_usize, rows in 1..24_usize, seeds in prop::collection::vec((0..24_usize, 0..24_usize), 0..20),
        ) {
            let mut blocked = vec![false; cols * rows];
            for (col, row) in seeds {
                if col < cols && row < rows { blocked[row * cols + col] = true; }
            }
            let mut field = DistanceField::default();
            field.compute(&blocked, cols);
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
        let mut field = DistanceField::default();
        field.compute(&[true; 12], 4);
        field.compute(&[true, false, false], 3);
        assert_eq!(field.all_squared(), [0, 1, 4]);
    }
}
