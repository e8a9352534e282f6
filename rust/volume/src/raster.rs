//! Bits side by side in columns: which small parts of a field of view a ray goes through.

use std::ops::Range;

/// Rows are looked at so many at a time: four words.
const BLOCK: usize = 4;
const BLOCKS: usize = 4;
/// Most rows.
pub(super) const ROWS: usize = 64 * BLOCK * BLOCKS;

/// A bit for each column and row. Reused from frame to frame.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Raster {
    /// The lowest rows of all columns, then the next ones.
    blocks: Vec<[u64; BLOCK]>,
    cols: usize,
    /// Words that hold all rows.
    used: usize,
}

/// Rows of a raster, one bit each.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rows {
    /// One more than is needed.
    words: [u64; BLOCK * BLOCKS + 1],
    /// Those that may have one.
    used: usize,
}

/// Rows from one to before another: what a layer covers.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Band {
    first: usize,
    end: usize,
    /// As many bits as it has rows, where one word holds them.
    ones: u64,
}

impl Raster {
    /// Makes it empty, of so many columns and rows.
    pub(super) fn resize(&mut self, [cols, rows]: [usize; 2]) {
        self.cols = cols;
        self.used = rows.div_ceil(64);
        self.blocks.clear();
        self.blocks
            .resize(cols * rows.div_ceil(64 * BLOCK), [0; BLOCK]);
    }

    /// Forgets everything.
    pub(super) fn clear(&mut self) {
        self.resize([0, 0]);
    }

    #[inline]
    pub(super) fn set(&mut self, col: usize, row: usize) {
        let word = row / 64;
        self.blocks[word / BLOCK * self.cols + col][word % BLOCK] |= 1 << (row % 64);
    }

    /// The rows that are set in one of some columns.
    #[inline]
    pub(super) fn rows(&self, cols: Range<usize>) -> Rows {
        let mut words = [0; BLOCK * BLOCKS + 1];
        let of_all = self.blocks.chunks_exact(self.cols.max(1));
        for (all, blocks) in words.as_chunks_mut::<BLOCK>().0.iter_mut().zip(of_all) {
            let [mut a, mut b, mut c, mut d] = [0; BLOCK];
            for block in &blocks[cols.start..cols.end] {
                a |= block[0];
                b |= block[1];
                c |= block[2];
                d |= block[3];
            }
            *all = [a, b, c, d];
        }
        Rows {
            words,
            used: self.used,
        }
    }
}

impl Rows {
    /// The lowest and the highest.
    #[inline]
    pub(super) fn ends(&self) -> Option<[usize; 2]> {
        let words = self.words.get(..self.used)?;
        let low = words.iter().position(|&word| word != 0)?;
        let high = words.iter().rposition(|&word| word != 0)?;
        let highest = 63 - self.words[high].leading_zeros() as usize;
        Some([
            64 * low + self.words[low].trailing_zeros() as usize,
            64 * high + highest,
        ])
    }

    /// Whether one of a band is set.
    #[inline]
    pub(super) fn meet(&self, band: &Band) -> bool {
        let (word, shift) = (band.first / 64, band.first % 64);
        let here = self.words[word] >> shift | (self.words[word + 1] << 1) << (63 - shift);
        here & band.ones != 0 || band.end > band.first + 64 && self.meet_long(band)
    }

    #[cold]
    fn meet_long(&self, band: &Band) -> bool {
        let (first, last) = (band.first / 64 + 1, (band.end - 1) / 64);
        let tail = u64::MAX >> (63 - (band.end - 1) % 64);
        let whole = self.words.get(first..last).unwrap_or_default();
        whole.iter().any(|&word| word != 0) || self.words[last] & tail != 0
    }
}

impl Band {
    /// None of them where the end does not lie behind the first.
    #[inline]
    pub(super) fn new(rows: Range<usize>) -> Self {
        let count = rows.len();
        let ones = if count == 0 {
            0
        } else {
            u64::MAX >> (64 - count.min(64))
        };
        Self {
            first: rows.start.min(ROWS - 1),
            end: rows.end,
            ones,
        }
    }

    pub(super) const fn range(&self) -> Range<usize> {
        self.first..self.end
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_band_is_met_where_one_of_its_rows_is_set(
            set in proptest::collection::vec((0..9_usize, 0..ROWS), 0..12),
            cols in (0..9_usize, 0..9_usize),
            rows in (0..ROWS, 0..=ROWS),
        ) {
            let mut raster = Raster::default();
            raster.resize([9, ROWS]);
            for &(col, row) in &set {
                raster.set(col, row);
            }
            let cols = cols.0.min(cols.1)..cols.1;
            let of_cols: Vec<_> = set.iter().filter(|(col, _)| cols.contains(col)).map(|&(_, row)| row).collect();
            let found = raster.rows(cols);
            prop_assert_eq!(found.meet(&Band::new(rows.0..rows.1)), of_cols.iter().any(|row| (rows.0..rows.1).contains(row)));
            let ends = of_cols.iter().min().zip(of_cols.iter().max());
            prop_assert_eq!(found.ends(), ends.map(|(&low, &high)| [low, high]));
        }
    }
}
