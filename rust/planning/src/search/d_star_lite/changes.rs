//! What changes of the grid: weights, ends, the start, and where its cells lie.

use super::{Asked, Cost, DStarLite, NEVER, NOT_QUEUED, Reverse, UNKNOWN, around, fixed, octile};

impl DStarLite {
    /// Sets what a length costs in a cell: 1 or more, infinite where it may not be entered.
    pub fn set_weight(&mut self, cell: usize, weight: f32) {
        let weight = if cell == self.start && weight.is_infinite() {
            1.0
        } else {
            weight
        };
        if self.weights[cell] != weight {
            self.weights[cell] = weight;
            self.touch_around(cell);
        }
    }

    /// Moves the start. What a start weighs that may not be entered has to be set anew after it was left.
    pub fn set_start(&mut self, start: usize) {
        if start != self.start {
            self.moved += self.away(start);
            self.start = start;
            self.free_start();
        }
    }

    /// Sets where ways may end and what that costs, in cells.
    pub fn set_ends(&mut self, ends: &[(u32, f64)]) {
        if self.end_cells == ends {
            return;
        }
        let mut before = std::mem::replace(&mut self.end_cells, ends.to_vec());
        for &(cell, cost) in ends {
            self.set_end(cell as usize, fixed(cost));
        }
        let mut stay: Vec<u32> = ends.iter().map(|end| end.0).collect();
        stay.sort_unstable();
        before.retain(|end| stay.binary_search(&end.0).is_err());
        for (cell, _) in before {
            self.set_end(cell as usize, NEVER);
        }
    }

    fn set_end(&mut self, cell: usize, cost: Cost) {
        if self.ends[cell] != cost {
            self.ends[cell] = cost;
            self.touched.push(cell as u32);
        }
    }

    /// Takes over what differs of a grid of the same size, unless more than so many cells do; says whether it was taken over.
    pub(super) fn take_changes(&mut self, asked: Asked<'_>, most: usize) -> bool {
        let weight = |cell: usize| {
            let weight = asked.weights[cell];
            if cell == asked.start && weight.is_infinite() {
                1.0
            } else {
                weight
            }
        };
        let differing = |&cell: &usize| self.weights[cell] != weight(cell);
        let changed: Vec<usize> = (0..self.weights.len())
            .filter(differing)
            .take(most + 1)
            .collect();
        if changed.len() > most {
            return false;
        }
        self.set_start(asked.start);
        for cell in changed {
            self.set_weight(cell, weight(cell));
        }
        self.set_ends(asked.ends);
        true
    }

    /// Moves the grid over the ground by so many columns and rows: cells that stay in it keep what is known of them, those that come into
    /// it are blocked until their weights are set, and the start and the ends move with the ground. A start that leaves the grid counts as
    /// the nearest cell in it.
    pub fn shift(&mut self, cols: isize, rows: isize) {
        let (width, height) = (self.cols, self.weights.len() / self.cols.max(1));
        let moved = |cell: usize, by: (isize, isize)| {
            let col = (cell % width).checked_add_signed(by.0);
            let row = (cell / width).checked_add_signed(by.1);
            let at = col
                .zip(row)
                .filter(|&(col, row)| col < width && row < height);
            at.map(|(col, row)| row * width + col)
        };
        let before = |cell: usize| moved(cell, (cols, rows));
        let all = 0..self.weights.len();
        let (weights, ends, field) = (&self.weights, &self.ends, &self.field);
        let of = |cell: usize| before(cell).map_or(f32::INFINITY, |was| weights[was]);
        let new_weights = all.clone().map(of).collect();
        let of = |cell: usize| before(cell).map_or(NEVER, |was| ends[was]);
        let new_ends = all.clone().map(of).collect();
        let of = |cell: usize| before(cell).map_or(UNKNOWN, |was| field[was]);
        let new_field = all.clone().map(of).collect();
        (self.weights, self.ends, self.field) = (new_weights, new_ends, new_field);
        let after = |cell: usize| moved(cell, (-cols, -rows));
        let stay = |&(cell, cost): &(u32, f64)| Some((after(cell as usize)? as u32, cost));
        self.end_cells = self.end_cells.iter().filter_map(stay).collect();
        let clamped = |at: usize, by: isize, count: usize| {
            at.saturating_add_signed(-by).min(count.saturating_sub(1))
        };
        let start = self.start;
        self.start = after(start).unwrap_or_else(|| {
            // It moves over the ground by no more than the grid does.
            self.moved += octile(cols.unsigned_abs(), rows.unsigned_abs());
            let col = clamped(start % width, cols, width);
            clamped(start / width, rows, height) * width + col
        });
        self.queue.clear();
        for cell in all {
            if self.field[cell].key != NOT_QUEUED {
                self.queue
                    .push(Reverse((self.field[cell].key, cell as u32)));
            }
            // Beside what has left the grid, something may have led through it.
            let (col, row) = (cell % width, cell / width);
            if col == 0 || row == 0 || col + 1 == width || row + 1 == height {
                self.touched.push(cell as u32);
            }
        }
    }

    /// Beside a cell all may change: what enters it, leaves it, and passes its corner.
    fn touch_around(&mut self, cell: usize) {
        let cells = around(cell, self.cols, self.weights.len());
        self.touched.extend(cells.map(|cell| cell as u32));
    }

    /// Lets the way leave where it begins.
    pub(super) fn free_start(&mut self) {
        if self.weights[self.start].is_infinite() {
            self.weights[self.start] = 1.0;
            self.touch_around(self.start);
        }
    }
}
