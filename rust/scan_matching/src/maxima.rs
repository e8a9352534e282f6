//! Bounds of a field over blocks of cells, for branch and bound.

use geometry::{Cell, Grid};

use crate::field::LikelihoodField;

/// Cells on each side of a bound's levels: each takes the maximum over a block of so many times the one below.
pub(crate) const BRANCH: i32 = 4;

/// Bounds of a field over blocks of cells: level `k` tells at a cell the largest likelihood in the block of 4^k by 4^k cells that begins there.
#[derive(Debug, Clone)]
pub struct FieldMaxima {
    levels: Vec<BoundLevel>,
}

#[derive(Debug, Clone)]
struct BoundLevel {
    block: i32,
    /// Of 255, rounded up; its cell (0, 0) is the field's at (1 - block, 1 - block).
    bound: Grid<u8>,
}

/// What a bound's cell has at most.
const FULL_BOUND: u16 = 255;
/// Shares of a field's cell in one of a bound's.
const PER_BOUND: u16 = 257;

impl FieldMaxima {
    /// The bounds of a field, so many levels above its cells.
    pub fn new(field: &LikelihoodField, levels: usize) -> Self {
        let whole = &field.likely;
        let mut below = BoundLevel {
            block: 1,
            bound: Grid::filled(whole.cols(), whole.rows(), 0),
        };
        for (bound, &share) in below.bound.values_mut().iter_mut().zip(whole.values()) {
            *bound = share.div_ceil(PER_BOUND).min(FULL_BOUND) as u8;
        }
        let mut made = Vec::with_capacity(levels);
        for _ in 0..levels {
            below = below.above();
            made.push(below.clone());
        }
        Self { levels: made }
    }

    /// How many levels there are above the cells.
    pub(crate) const fn height(&self) -> usize {
        self.levels.len()
    }

    /// The largest likelihood, of 255, in the block of a level, from 1 up, that begins at a cell of the field.
    pub(crate) fn bound(&self, level: usize, cell: Cell) -> u8 {
        let Some(level) = self.levels.get(level - 1) else {
            return u8::MAX;
        };
        let shift = level.block - 1;
        level
            .bound
            .get(Cell::new(cell.col + shift, cell.row + shift))
            .copied()
            .unwrap_or(0)
    }
}

impl BoundLevel {
    fn above(&self) -> Self {
        let block = self.block * BRANCH;
        let more = (block - self.block) as usize;
        let (cols, rows) = (self.bound.cols() + more, self.bound.rows() + more);
        let steps = || (0..BRANCH).map(|step| (step * self.block) as usize);
        // A cell of the higher level begins `more` cells before the one of the same number below: its block has those at `steps` from there.
        let mut wide = Grid::filled(cols, self.bound.rows(), 0_u8);
        let from = self.bound.cols();
        for row in 0..self.bound.rows() {
            let line = &self.bound.values()[row * from..][..from];
            let into = &mut wide.values_mut()[row * cols..][..cols];
            for step in steps() {
                let first = more - step;
                for (slot, &value) in into[first..].iter_mut().zip(line) {
                    *slot = value.max(*slot);
                }
            }
        }
        let mut bound = Grid::filled(cols, rows, 0_u8);
        for step in steps() {
            let first = (more - step) * cols;
            let into = &mut bound.values_mut()[first..];
            for (slot, &value) in into.iter_mut().zip(wide.values()) {
                *slot = value.max(*slot);
            }
        }
        Self { block, bound }
    }
}
