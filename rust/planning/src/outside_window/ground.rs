//! Where something stood when it was seen last, in a square that moves along with the window.

use std::ops::Range;

use geometry::{Cell, Lattice, in_step};
use terrain::Terrain;

/// Cells of the ground around the window, as large as its own, on a side: what lies further off than half of them is forgotten. A size of
/// arrays, known when it is compiled, so that columns and rows of a cell need no division.
pub(super) const SIDE: usize = 512;

/// The ground around as it was when it was seen last.
#[derive(Debug, Clone, Default)]
pub(super) struct GroundOutside {
    /// Where the cells lie.
    pub(super) lattice: Option<Lattice>,
    /// Row by row, `SIDE` in each.
    pub(super) blocked: Vec<bool>,
    /// How far aside of the robot each column of the window is, m.
    aside_m: Vec<f64>,
    /// Columns of the window that lie side by side here, too, and where their first one lies.
    columns: Vec<(Range<usize>, usize)>,
}

impl GroundOutside {
    #[expect(
        clippy::needless_bitwise_bool,
        reason = "without a branch, several cells at a time"
    )]
    /// Takes in what the window shows to a robot that stands at a place, m, who believes nearer than `near_m` that something has gone; says
    /// whether the cells have moved.
    pub(super) fn take_in(&mut self, terrain: &Terrain, robot_m: [f64; 2], near_m: f64) -> bool {
        let (lattice, has_moved) = self.follow(terrain);
        let window = &terrain.lattice;
        let place_m = |axis: usize, at: usize| {
            window.center_of(Cell::new(at as i32, at as i32))[axis] - robot_m[axis]
        };
        self.aside_m.clear();
        self.aside_m
            .extend((0..terrain.cols).map(|col| place_m(0, col)));
        let there = |axis, at| {
            let at_m = window.center_of(Cell::new(at as i32, at as i32))[axis];
            place_along(&lattice, axis, at_m)
        };
        self.columns.clear();
        (self.columns).extend(in_step(0..terrain.cols, |col| there(0, col)));
        // Columns further aside than that are not near in any row.
        let is_aside = |aside_m: &f64| aside_m.abs() < near_m;
        let first_near = self.aside_m.iter().position(is_aside).unwrap_or(0);
        let end_near = (self.aside_m.iter().rposition(is_aside)).map_or(0, |last| last + 1);
        for row in 0..terrain.rows {
            let Some(row_there) = there(1, row) else {
                continue;
            };
            let ahead_m = place_m(1, row);
            let ground = &mut self.blocked[row_there * SIDE..][..SIDE];
            let first = row * terrain.cols;
            for (all, first_there) in &self.columns {
                let ground = &mut ground[*first_there..][..all.len()];
                let end = end_near.clamp(all.start, all.end);
                let begin = first_near.clamp(all.start, end);
                let is_row_near = ahead_m.abs() < near_m;
                let near = if is_row_near { begin..end } else { end..end };
                let far = [all.start..near.start, near.end..all.end];
                for (cols, is_far) in far
                    .into_iter()
                    .map(|far| (far, true))
                    .chain([(near, false)])
                {
                    let ground = &mut ground[cols.start - all.start..][..cols.len()];
                    let cells = first + cols.start..first + cols.end;
                    let seen = (terrain.unknown[cells.clone()].iter()).zip(&terrain.blocked[cells]);
                    if is_far {
                        for (known, (&unknown, &blocked)) in ground.iter_mut().zip(seen) {
                            *known |= blocked & !unknown;
                        }
                        continue;
                    }
                    let aside_m = &self.aside_m[cols];
                    for ((known, (&unknown, &blocked)), aside_m) in
                        ground.iter_mut().zip(seen).zip(aside_m)
                    {
                        let near = geometry::hypot(*aside_m, ahead_m) < near_m;
                        *known = (*known & (unknown | !near)) | (blocked & !unknown);
                    }
                }
            }
        }
        has_moved
    }

    /// The cells, and whether they moved along as the window left them: what lies farther from it than they reach is forgotten.
    fn follow(&mut self, terrain: &Terrain) -> (Lattice, bool) {
        let window = &terrain.lattice;
        let sides = [terrain.cols, terrain.unknown.len() / terrain.cols.max(1)];
        // A window that is larger has its middle in them.
        let before = sides.map(|cells| (SIDE as f64 - cells as f64) / 2.0);
        let around = Lattice {
            origin_m: [0, 1].map(|axis| window.origin_m[axis] - before[axis] * window.cell_m),
            cell_m: window.cell_m,
        };
        let Some(lattice) = &mut self.lattice else {
            self.blocked = vec![false; SIDE * SIDE];
            self.lattice = Some(around);
            return (around, false);
        };
        let moved = [0, 1].map(|axis| {
            let moved = (around.origin_m[axis] - lattice.origin_m[axis]) / lattice.cell_m;
            let is_inside = moved.abs() <= before[axis].max(0.0);
            if is_inside { 0 } else { moved.round() as isize }
        });
        if moved != [0, 0] {
            for (origin_m, cells) in lattice.origin_m.iter_mut().zip(moved) {
                *origin_m += cells as f64 * lattice.cell_m;
            }
            self.blocked = moved_by(&self.blocked, moved);
        }
        (*lattice, moved != [0, 0])
    }

    /// Whether something is known to stand outside of the window.
    pub(super) fn is_blocked_outside(&self, terrain: &Terrain) -> bool {
        let Some(lattice) = self.lattice else {
            return false;
        };
        let outside = |cell: usize| {
            let middle_m = |at: usize| (at as f64 + 0.5) * lattice.cell_m;
            let [x, y] = lattice.origin_m;
            let at_m = [x + middle_m(cell % SIDE), y + middle_m(cell / SIDE)];
            terrain.index_at(at_m).is_none()
        };
        let mut blocked = self
            .blocked
            .iter()
            .enumerate()
            .filter(|(_, blocked)| **blocked);
        blocked.any(|(cell, _)| outside(cell))
    }
}

/// That ground on cells that begin so many columns and rows later.
fn moved_by(blocked: &[bool], [cols, rows]: [isize; 2]) -> Vec<bool> {
    let before = |cell: usize| {
        let col = (cell % SIDE).checked_add_signed(cols)?;
        let row = (cell / SIDE).checked_add_signed(rows)?;
        (col < SIDE && row < SIDE).then(|| blocked[row * SIDE + col])
    };
    let cells = 0..SIDE * SIDE;
    cells.map(|cell| before(cell).unwrap_or(false)).collect()
}

/// Column and row of a place among the cells.
pub(super) fn cell_at(lattice: &Lattice, at_m: [f64; 2]) -> Option<[usize; 2]> {
    let at = |axis: usize| place_along(lattice, axis, at_m[axis]);
    Some([at(0)?, at(1)?])
}

/// Column or row, by the axis, of a place that lies so far along it, m.
fn place_along(lattice: &Lattice, axis: usize, at_m: f64) -> Option<usize> {
    let at = ((at_m - lattice.origin_m[axis]) / lattice.cell_m).floor();
    (0.0..SIDE as f64).contains(&at).then_some(at as usize)
}
