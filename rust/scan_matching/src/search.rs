//! The pose at which a scan fits a field best, of all in a window: branch and bound over cells and headings (Hess, Kohler, Rapp and Andor 2016).

use geometry::{Cell, PlanarPose, wrap_angle};

use crate::field::LikelihoodField;
use crate::maxima::{BRANCH, FieldMaxima};

/// Where the best pose is looked for, and what is known of it before.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SearchWindow {
    pub(crate) middle: PlanarPose,
    /// How far to each side: x and y, m, and heading, rad.
    pub(crate) half: [f64; 3],
    /// Information that is known of x, y and heading before, in units of a point: what is taken from the mean likelihood is half the square.
    pub(crate) known: [f64; 3],
}

/// The best pose on the lattice of the search, and the mean likelihood of the points there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Found {
    pub(crate) pose: PlanarPose,
    pub(crate) score: f64,
}

struct Candidate {
    turn: usize,
    /// Cells from the middle, of the lowest of the block.
    col: i32,
    row: i32,
    bound: f64,
}

struct WindowSearch<'a> {
    field: &'a LikelihoodField,
    maxima: Option<&'a FieldMaxima>,
    window: &'a SearchWindow,
    half: [i32; 2],
    turns: Vec<(f64, Vec<Cell>)>,
    count: f64,
}

/// The pose of the window at which a scan's points, m in the sensor's frame, fit best, where their mean likelihood, less what speaks against
/// the pose beforehand, is above `least`. Poses lie a cell apart, and turned as far as moves the furthest point by a cell.
pub(crate) fn search(
    field: &LikelihoodField,
    maxima: Option<&FieldMaxima>,
    points: &[[f64; 2]],
    window: &SearchWindow,
    least: f64,
) -> Option<Found> {
    if points.is_empty() {
        return None;
    }
    let cell_m = field.lattice().cell_m;
    let far_m = points
        .iter()
        .map(|point| geometry::hypot(point[0], point[1]))
        .fold(cell_m, f64::max);
    let turn_rad = cell_m / far_m;
    let to_a_side = libm::ceil(window.half[2] / turn_rad) as i32;
    let turned = |step: i32| {
        let off_rad = f64::from(step) * turn_rad;
        let middle = &window.middle;
        let pose = PlanarPose::new(middle.x_m, middle.y_m, middle.yaw_rad + off_rad);
        let cells = points.iter().map(|point| {
            let (x_m, y_m) = pose.apply(point[0], point[1]);
            field.lattice().cell_at(x_m, y_m)
        });
        (off_rad, cells.collect())
    };
    let search = WindowSearch {
        field,
        maxima,
        window,
        half: [0, 1].map(|axis: usize| libm::ceil(window.half[axis] / cell_m) as i32),
        turns: (-to_a_side..=to_a_side).map(turned).collect(),
        count: points.len() as f64,
    };
    let top = maxima.map_or(0, |maxima| search.level_for(maxima.height()));
    let block = BRANCH.pow(top as u32);
    let mut all = Vec::new();
    for turn in 0..search.turns.len() {
        let mut row = -search.half[1];
        while row <= search.half[1] {
            let mut col = -search.half[0];
            while col <= search.half[0] {
                all.push(search.candidate(top, turn, col, row));
                col += block;
            }
            row += block;
        }
    }
    let mut best = None;
    let mut above = least;
    search.go(top, all, &mut above, &mut best);
    let best = best?;
    let off_rad = search.turns[best.turn].0;
    let pose = PlanarPose::new(
        window.middle.x_m + f64::from(best.col) * cell_m,
        window.middle.y_m + f64::from(best.row) * cell_m,
        wrap_angle(window.middle.yaw_rad + off_rad),
    );
    let score = best.bound + search.against(0, best.turn, best.col, best.row);
    Some(Found { pose, score })
}

impl WindowSearch<'_> {
    /// The level whose blocks are about as large as the window.
    fn level_for(&self, height: usize) -> usize {
        let side = 2 * self.half[0].max(self.half[1]) + 1;
        (0..=height)
            .find(|&level| BRANCH.pow(level as u32) >= side)
            .unwrap_or(height)
    }

    fn candidate(&self, level: usize, turn: usize, col: i32, row: i32) -> Candidate {
        let cells = self.turns[turn].1.iter();
        let moved = cells.map(|cell| Cell::new(cell.col + col, cell.row + row));
        let fits = if let (1.., Some(maxima)) = (level, self.maxima) {
            let sum: u32 = moved.map(|cell| u32::from(maxima.bound(level, cell))).sum();
            f64::from(sum) / (f64::from(u8::MAX) * self.count)
        } else {
            let sum: u64 = moved.map(|cell| u64::from(self.field.share(cell))).sum();
            sum as f64 / (f64::from(u16::MAX) * self.count)
        };
        let bound = fits - self.against(level, turn, col, row);
        Candidate {
            turn,
            col,
            row,
            bound,
        }
    }

    /// The least that speaks beforehand against a pose of a block.
    fn against(&self, level: usize, turn: usize, col: i32, row: i32) -> f64 {
        let more = BRANCH.pow(level as u32) - 1;
        let cell_m = self.field.lattice().cell_m;
        let off = |low: i32| f64::from(low.max((low + more).min(0))) * cell_m;
        let off = [off(col), off(row), self.turns[turn].0];
        let squares = (0..3).map(|axis| self.window.known[axis] * off[axis] * off[axis]);
        0.5 * squares.sum::<f64>() / self.count
    }

    /// Goes through blocks, best bound first, and keeps the best pose.
    fn go(
        &self,
        level: usize,
        mut blocks: Vec<Candidate>,
        above: &mut f64,
        best: &mut Option<Candidate>,
    ) {
        // A stable order: of equals the first stays first.
        blocks.sort_by(|one, other| other.bound.total_cmp(&one.bound));
        for block in blocks {
            if block.bound <= *above {
                return;
            }
            if level == 0 {
                *above = block.bound;
                *best = Some(block);
                return;
            }
            let step = BRANCH.pow(level as u32 - 1);
            let mut inside = Vec::with_capacity((BRANCH * BRANCH) as usize);
            for up in 0..BRANCH {
                for right in 0..BRANCH {
                    let (col, row) = (block.col + right * step, block.row + up * step);
                    if col <= self.half[0] && row <= self.half[1] {
                        inside.push(self.candidate(level - 1, block.turn, col, row));
                    }
                }
            }
            self.go(level - 1, inside, above, best);
        }
    }
}
