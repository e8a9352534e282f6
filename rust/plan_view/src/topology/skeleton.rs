//! The generalized Voronoi diagram of a grid, one cell wide, and from every free cell a way to it that comes no nearer to anything.

use super::nearest::{NONE, NearestBlocked};
use super::ring::{AROUND, PIECES, SIDES};

/// Cells of the diagram among all of a grid with a blocked rim, row by row.
///
/// A cell is taken away, the nearest to an obstacle first, where nothing is lost by it: neither a hole, nor, among the cells around that
/// are at least as far from everything, any connection, whatever that least distance. So the free space with any clearance has the same
/// connections in the diagram as in the grid.
#[derive(Debug, Clone)]
pub(super) struct Skeleton {
    pub cols: usize,
    pub nearest: NearestBlocked,
    pub kept: Vec<bool>,
    /// For a free cell that was taken away, the one beside it where the way to the diagram goes on; [`NONE`] for others.
    pub towards: Vec<u32>,
}

impl Skeleton {
    /// Of the free cells of a grid whose rim is blocked. Ends of the diagram stay where two of the nearest obstacles lie at least this
    /// angle apart, and so many cells away.
    pub(super) fn of(free: &[bool], cols: usize, least_angle_rad: f64, least_cells: f64) -> Self {
        let blocked: Vec<bool> = free.iter().map(|&free| !free).collect();
        let mut found = Self {
            cols,
            nearest: NearestBlocked::of(&blocked, cols),
            kept: free.to_vec(),
            towards: vec![NONE; free.len()],
        };
        let mut cells: Vec<u32> = (0..free.len() as u32)
            .filter(|&at| free[at as usize])
            .collect();
        cells.sort_unstable_by_key(|&at| (found.nearest.squared[at as usize], at));
        let most_cosine = libm::cos(least_angle_rad);
        let ridge: Vec<bool> = (0..free.len())
            .map(|at| f64::from(found.nearest.squared[at]) >= (least_cells * least_cells).max(1.0))
            .enumerate()
            .map(|(at, wide)| wide && found.is_between(at, most_cosine))
            .collect();
        loop {
            let before = cells.len();
            cells.retain(|&at| !found.take_away(at as usize, &ridge));
            if cells.len() == before {
                return found;
            }
        }
    }

    /// The part of the diagram that is so many cells away from everything.
    pub(super) fn at_least(&self, least_cells: f64) -> Self {
        let mut part = self.clone();
        for (kept, &squared) in part.kept.iter_mut().zip(&self.nearest.squared) {
            *kept &= f64::from(squared) >= least_cells * least_cells;
        }
        part
    }

    /// Index of a cell around another one. The rim is blocked, so there is one.
    pub(super) const fn beside(&self, at: usize, around: [i32; 2]) -> usize {
        at.wrapping_add_signed(around[1] as isize * self.cols as isize + around[0] as isize)
    }

    /// Those of the diagram around a cell, as bits.
    pub(super) fn kept_around(&self, at: usize) -> u8 {
        (0..8).fold(0, |set, k| {
            set | (u8::from(self.kept[self.beside(at, AROUND[k])]) << k)
        })
    }

    /// Indices of those of the diagram around a cell.
    pub(super) fn neighbours(&self, at: usize) -> impl Iterator<Item = usize> {
        let beside = AROUND.map(|around| self.beside(at, around));
        beside.into_iter().filter(|&at| self.kept[at])
    }

    /// Whether what is nearest to a cell and to one beside it lies in directions that are far apart.
    fn is_between(&self, at: usize, most_cosine: f64) -> bool {
        let towards = |from: usize| {
            let offset = self.offset(from, self.nearest.blocked[from]);
            let length = libm::hypot(offset[0], offset[1]).max(f64::MIN_POSITIVE);
            [offset[0] / length, offset[1] / length]
        };
        let own = towards(at);
        AROUND.iter().any(|&around| {
            let beside = self.beside(at, around);
            let other = towards(beside);
            self.nearest.squared[beside] > 0 && own[0] * other[0] + own[1] * other[1] <= most_cosine
        })
    }

    /// Columns and rows from a cell to another.
    fn offset(&self, from: usize, to: u32) -> [f64; 2] {
        let to = to as usize;
        [
            (to % self.cols) as f64 - (from % self.cols) as f64,
            (to / self.cols) as f64 - (from / self.cols) as f64,
        ]
    }

    /// Takes a cell away where it may be.
    fn take_away(&mut self, at: usize, ridge: &[bool]) -> bool {
        let kept = self.kept_around(at);
        if (ridge[at] && kept.count_ones() <= 1) || kept & SIDES == SIDES {
            return false;
        }
        let own = self.nearest.squared[at];
        let heights = AROUND.map(|around| self.nearest.squared[self.beside(at, around)]);
        let above =
            |least: u32| (0..8).fold(kept, |set, k| set & !(u8::from(heights[k] < least) << k));
        if PIECES[kept as usize] != 1 || PIECES[above(own) as usize] != 1 {
            return false;
        }
        if heights
            .iter()
            .any(|&height| height < own && PIECES[above(height) as usize] > 1)
        {
            return false;
        }
        let upward = (0..8).filter(|k| above(own) & (1 << k) != 0);
        let Some(best) = upward.max_by_key(|&k| (heights[k], 7 - k)) else {
            return false;
        };
        self.towards[at] = self.beside(at, AROUND[best]) as u32;
        self.kept[at] = false;
        true
    }
}
