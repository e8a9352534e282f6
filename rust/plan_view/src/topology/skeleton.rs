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
        let mut cells = by_nearness(free, &found.nearest.squared);
        let ends = DiagramEnds {
            most_cosine: libm::cos(least_angle_rad),
            least_squared: (least_cells * least_cells).max(1.0),
        };
        // A cell that stayed stays as long as none around it goes.
        let mut asked = vec![false; free.len()];
        loop {
            let before = cells.len();
            cells.retain(|&at| {
                let at = at as usize;
                if asked[at] {
                    return true;
                }
                asked[at] = true;
                let gone = found.take_away(at, &ends);
                if gone {
                    for around in AROUND {
                        asked[found.beside(at, around)] = false;
                    }
                }
                !gone
            });
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

    /// Whether the diagram may end at a cell: whether that is wide enough, and what is nearest to it and to one beside it lies in directions
    /// that are far apart.
    fn is_end(&self, at: usize, ends: &DiagramEnds) -> bool {
        let NearestBlocked { blocked, squared } = &self.nearest;
        if f64::from(squared[at]) < ends.least_squared {
            return false;
        }
        let towards = |from: usize| self.offset(from, blocked[from]);
        let own = towards(at);
        let others = AROUND.map(|around| self.beside(at, around));
        let mut others = (others.into_iter())
            .filter(|&beside| squared[beside] > 0 && blocked[beside] != blocked[at]);
        others.any(|beside| {
            let other = towards(beside);
            let lengths = (f64::from(squared[at]) * f64::from(squared[beside])).sqrt();
            own[0] * other[0] + own[1] * other[1] <= ends.most_cosine * lengths
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
    fn take_away(&mut self, at: usize, ends: &DiagramEnds) -> bool {
        let kept = self.kept_around(at);
        if kept & SIDES == SIDES || (kept.count_ones() <= 1 && self.is_end(at, ends)) {
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

/// Where branches of the diagram may end.
#[derive(Debug, Clone, Copy)]
struct DiagramEnds {
    /// Cosine of the least angle between the two nearest obstacles, seen from there.
    most_cosine: f64,
    /// Least squared distance to an obstacle, cells².
    least_squared: f64,
}

/// The free cells, the nearest to an obstacle first, those equally near in the order of their indices.
fn by_nearness(free: &[bool], squared: &[u32]) -> Vec<u32> {
    let all = || (0..free.len() as u32).filter(|&at| free[at as usize]);
    let most = all().map(|at| squared[at as usize]).max().unwrap_or(0) as usize;
    let mut first = vec![0_u32; most + 2];
    for at in all() {
        first[squared[at as usize] as usize + 1] += 1;
    }
    for nearness in 1..first.len() {
        first[nearness] += first[nearness - 1];
    }
    let mut cells = vec![0; first[most + 1] as usize];
    for at in all() {
        let place = &mut first[squared[at as usize] as usize];
        cells[*place as usize] = at;
        *place += 1;
    }
    cells
}
