//! Which surface of each cell is the robot's way: the one that is reached from where it stands, from cell to cell.

use std::collections::VecDeque;

use geometry::{Cell, Grid};

/// The heights that the robot comes by on its way to each cell. Reused from frame to frame.
#[derive(Debug, Clone)]
pub(crate) struct Reached {
    heights_m: Grid<f32>,
    queue: VecDeque<Cell>,
}

/// To the sides first, so that what is as far is reached straight.
const BESIDE: [[i32; 2]; 8] = [
    [1, 0],
    [-1, 0],
    [0, 1],
    [0, -1],
    [1, 1],
    [1, -1],
    [-1, 1],
    [-1, -1],
];

impl Reached {
    pub(crate) fn new(cells: usize) -> Self {
        Self {
            heights_m: Grid::filled(cells, cells, f32::NAN),
            queue: VecDeque::new(),
        }
    }

    /// Goes from `start`, where the robot stands at a height, m, to all cells, the nearest first. `surface` is the height of the surface of
    /// a cell that is nearest to a height by which one comes; where there is none, or none that is within `joined_m`, the way goes on at
    /// the height that it had.
    pub(crate) fn spread(
        &mut self,
        (start, height_m): (Cell, f32),
        joined_m: f32,
        surface: impl Fn(usize, f32) -> Option<f32>,
    ) {
        self.heights_m.fill(&f32::NAN);
        self.queue.clear();
        if let Some(at) = self.heights_m.get_mut(start) {
            *at = height_m;
            self.queue.push_back(start);
        }
        while let Some(cell) = self.queue.pop_front() {
            let Some(&from_m) = self.heights_m.get(cell) else {
                continue;
            };
            for [cols, rows] in BESIDE {
                let next = Cell::new(cell.col + cols, cell.row + rows);
                let Some(index) = self.heights_m.index(next) else {
                    continue;
                };
                let there = &mut self.heights_m.values_mut()[index];
                if there.is_nan() {
                    let found =
                        surface(index, from_m).filter(|at_m| (at_m - from_m).abs() <= joined_m);
                    *there = found.unwrap_or(from_m);
                    self.queue.push_back(next);
                }
            }
        }
    }

    /// The height by which one comes to the cell that is stored at an index, m; NaN where the start lies outside.
    #[inline]
    pub(crate) fn height_m(&self, index: usize) -> f32 {
        self.heights_m.values()[index]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_leads_onto_the_deck_and_the_road_below_it() {
        // A road along row 2; a ramp from column 0 to a deck over columns 4 to 6 of row 2, in row 0.
        let surface = |index: usize, from_m: f32| {
            let (col, row) = (index % 9, index / 9);
            let levels: &[f32] = match (col, row) {
                (0..4, 0) => &[0.25],
                (4..7, 0..3) => &[0.0, 1.0],
                _ => &[0.0],
            };
            let ramp = [0.25 * (col as f32 + 1.0)];
            let levels = if (0..4).contains(&col) && row == 0 {
                &ramp[..]
            } else {
                levels
            };
            levels
                .iter()
                .copied()
                .min_by(|a, b| (a - from_m).abs().total_cmp(&(b - from_m).abs()))
        };
        let mut reached = Reached::new(9);
        reached.spread((Cell::new(0, 0), 0.25), 0.3, surface);
        assert_eq!(reached.height_m(5), 1.0);
        reached.spread((Cell::new(8, 2), 0.0), 0.3, surface);
        assert_eq!(reached.height_m(2 * 9 + 5), 0.0);
        assert_eq!(reached.height_m(5), 0.0);
    }
}
