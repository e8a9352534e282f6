//! Exact Euclidean distance transform in two passes (Meijster, Roerdink and Hesselink 2000), in integers.

mod row;

use row::{FAR, Row};

/// Squared distance, in cells, where no cell is blocked: further than anything in a grid of up to 10,000 cells a side.
pub const NOTHING_NEAR: u32 = 1 << 29;

/// Squares of up to twice this fit into 16 bits.
const FURTHEST_REACH: usize = 90;

/// Squared distances, in cells, from every cell's centre to the centre of the nearest blocked cell. Reused.
#[derive(Debug, Clone, Default)]
pub struct CellDistances {
    /// All squared distances, row by row, in cells.
    pub squared: Vec<u32>,
    /// Distance to the nearest blocked cell of the same column that is not below.
    from_above: Vec<i16>,
    row: Row,
    /// The squares of one row whose roots are taken.
    of_row: Vec<u32>,
}

impl CellDistances {
    /// Fills the field for a grid of `cols` columns, row by row. Allocates only when the grid grows.
    pub fn compute(&mut self, blocked: &[bool], cols: usize) {
        self.squared.resize(blocked.len(), 0);
        let squared = &mut self.squared;
        let into = |row: &mut Row, first: usize| row.transform(&mut squared[first..][..cols]);
        each_row(&mut self.from_above, &mut self.row, blocked, cols, into);
    }

    /// Distances themselves, in cells, rounded to `f32`; the squared ones are left as they were. Allocates as [`Self::compute`] does.
    pub fn compute_roots(&mut self, blocked: &[bool], cols: usize, roots: &mut Vec<f32>) {
        roots.resize(blocked.len(), 0.0);
        self.of_row.resize(cols, 0);
        let squared = &mut self.of_row;
        let into = |row: &mut Row, first: usize| {
            row.transform(squared);
            for (root, &squared) in roots[first..][..cols].iter_mut().zip(&*squared) {
                *root = (squared as i32 as f32).sqrt();
            }
        };
        each_row(&mut self.from_above, &mut self.row, blocked, cols, into);
    }

    /// Fills the field as [`Self::compute`] does where something is blocked within so many cells; elsewhere nothing counts as near.
    pub fn compute_within(&mut self, blocked: &[bool], cols: usize, reach: usize) {
        if reach > FURTHEST_REACH {
            self.compute(blocked, cols);
            return;
        }
        self.squared.resize(blocked.len(), 0);
        let squared = &mut self.squared;
        let into = |row: &mut Row, first: usize| {
            row.transform_within(&mut squared[first..][..cols], reach as i16);
        };
        each_row(&mut self.from_above, &mut self.row, blocked, cols, into);
    }

    /// Squared distance of a cell by its index, in cells.
    pub fn squared(&self, index: usize) -> u32 {
        self.squared[index]
    }
}

/// First pass, all columns at once: downwards into `from_above`, then upwards, where each row goes through the second pass while it is
/// in the cache.
fn each_row(
    from_above: &mut Vec<i16>,
    row: &mut Row,
    blocked: &[bool],
    cols: usize,
    mut into: impl FnMut(&mut Row, usize),
) {
    if blocked.is_empty() {
        return;
    }
    from_above.resize(blocked.len(), 0);
    row.begin(cols);
    let mut above = row.heights();
    for (here, blocked) in from_above
        .chunks_exact_mut(cols)
        .zip(blocked.chunks_exact(cols))
    {
        for ((here, &above), &blocked) in here.iter_mut().zip(above).zip(blocked) {
            *here = FAR.min(above + 1) & (i16::from(blocked) - 1);
        }
        above = here;
    }

    for (index, from_above) in from_above.chunks_exact(cols).enumerate().rev() {
        row.rise(from_above);
        into(row, index * cols);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn by_brute_force(blocked: &[bool], cols: usize) -> Vec<u32> {
        let cells = 0..blocked.len();
        let filled: Vec<_> = cells.clone().filter(|&j| blocked[j]).collect();
        let squared = |i: usize, j: usize| {
            (i % cols).abs_diff(j % cols).pow(2) + (i / cols).abs_diff(j / cols).pow(2)
        };
        let nearest = |i| filled.iter().map(|&j| squared(i, j)).min();
        cells
            .map(|i| nearest(i).map_or(NOTHING_NEAR, |d| d as u32))
            .collect()
    }

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
            let mut roots = Vec::new();
            CellDistances::default().compute_roots(&blocked, cols, &mut roots);
            prop_assert!(field.squared.iter().zip(&roots).all(|(&squared, &root)| root == (squared as f32).sqrt()));
            let mut bounded = CellDistances::default();
            for reach in [0, 1, 5, 90] {
                bounded.compute_within(&blocked, cols, reach);
                prop_assert_eq!(&bounded.squared, &within(reach));
            }
            prop_assert_eq!(field.squared, by_brute_force(&blocked, cols));
        }
    }

    #[test]
    fn a_field_can_be_used_again_for_another_size() {
        let mut field = CellDistances::default();
        field.compute(&[true; 12], 4);
        field.compute(&[true, false, false], 3);
        assert_eq!(field.squared, [0, 1, 4]);
    }

    /// Rows of all kinds: crowded, with wide gaps, with runs of columns as far away as each other.
    #[test]
    fn it_equals_brute_force_along_long_rows() {
        let mut random = crate::random::SplitMix64::new(5);
        let (cols, rows) = (211, 9);
        for share in [0.0005, 0.005, 0.02, 0.1, 0.5] {
            for wide in [1, 7, 30] {
                let mut blocked = vec![false; cols * rows];
                for index in 0..blocked.len() {
                    if random.uniform() < share {
                        let end = (index + wide).min((index / cols + 1) * cols);
                        blocked[index..end].fill(true);
                    }
                }
                let mut field = CellDistances::default();
                field.compute(&blocked, cols);
                assert_eq!(field.squared, by_brute_force(&blocked, cols));
            }
        }
    }
}
