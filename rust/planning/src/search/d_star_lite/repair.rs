//! What is looked at again, until the way from the start is the cheapest.

use super::{
    ANYWHERE, CellCosts, Cells, Cost, DStarLite, NEVER, NOT_QUEUED, QueueKey, Reverse, STRAIGHT,
    around, step,
};

/// The queue may hold so many entries a cell, those that are out of date included, before these are thrown out.
const ENTRIES_A_CELL: usize = 4;

impl DStarLite {
    /// Takes over what the neighbours of changed cells say.
    pub(super) fn look_at_touched(&mut self) {
        let mut touched = std::mem::take(&mut self.touched);
        touched.sort_unstable();
        touched.dedup();
        for cell in touched.drain(..) {
            self.look_ahead(cell as usize);
        }
        self.touched = touched;
    }

    /// Asks a cell's neighbours again.
    fn look_ahead(&mut self, cell: usize) {
        self.field[cell].ahead = self.next(cell).0.min(NEVER);
        self.enqueue(cell);
    }

    /// Puts a cell into the queue where it belongs, or takes it out.
    fn enqueue(&mut self, cell: usize) {
        let field = &self.field[cell];
        let waits = field.found < field.ahead && !self.raising;
        let key = if field.found == field.ahead || waits {
            NOT_QUEUED
        } else {
            self.key(cell)
        };
        self.put(cell, key);
    }

    fn put(&mut self, cell: usize, key: QueueKey) {
        if self.field[cell].key == key {
            return;
        }
        self.field[cell].key = key;
        if key != NOT_QUEUED {
            self.queue.push(Reverse((key, cell as u32)));
            if self.queue.len() > ENTRIES_A_CELL * self.field.len() {
                let field = &self.field;
                self.queue
                    .retain(|&Reverse((key, cell))| field[cell as usize].key == key);
            }
        }
    }

    /// The cell that is to be looked at next.
    fn first(&mut self) -> Option<(QueueKey, usize)> {
        while let Some(&Reverse((key, cell))) = self.queue.peek() {
            if self.field[cell as usize].key == key {
                return Some((key, cell as usize));
            }
            let _ = self.queue.pop();
        }
        None
    }

    /// Looks at cells again until the way from the start is known.
    pub(super) fn repair(&mut self) {
        while let Some((key, cell)) = self.first() {
            let start = &self.field[self.start];
            // A start that became dearer and waits is looked at on the way.
            let settled = start.ahead <= start.found || !self.raising;
            let (estimate, left) = self.key(self.start);
            let known = settled && key >= (estimate + self.beyond(), left);
            if known || key.0 >= NEVER {
                return;
            }
            let _ = self.queue.pop();
            let now = self.key(cell);
            if key < now {
                // The start has moved since it was put there.
                self.put(cell, now);
                continue;
            }
            self.field[cell].key = NOT_QUEUED;
            self.expanded += 1;
            if self.field[cell].found > self.field[cell].ahead {
                self.lower(cell);
            } else {
                self.raise(cell);
            }
        }
    }

    /// How much dearer than the way what lies beside it is looked at: ways between cells depend on both.
    fn beyond(&self) -> Cost {
        self.interpolation.as_ref().map_or(0, |_| STRAIGHT)
    }

    /// A cell's way became cheaper: its neighbours' may.
    fn lower(&mut self, cell: usize) {
        let found = self.field[cell].ahead;
        self.field[cell].found = found;
        if self.interpolation.is_some() {
            return self.look_ahead_around(cell);
        }
        self.for_each_beside(cell, |search, beside, step| {
            if found + step < search.field[beside].ahead {
                search.field[beside].ahead = found + step;
                search.enqueue(beside);
            }
        });
    }

    /// A cell's way became dearer: it is taken back, with what was found by it.
    fn raise(&mut self, cell: usize) {
        let before = std::mem::replace(&mut self.field[cell].found, NEVER);
        self.enqueue(cell);
        if self.interpolation.is_some() {
            return self.look_ahead_around(cell);
        }
        self.for_each_beside(cell, |search, beside, step| {
            if search.field[beside].ahead == before + step {
                search.look_ahead(beside);
            }
        });
    }

    /// Asks the neighbours of a cell's neighbours again: their ways may lead between it and another one.
    fn look_ahead_around(&mut self, cell: usize) {
        for beside in around(cell, self.cols, self.weights.len()) {
            if beside != cell && self.weights[beside].is_finite() {
                self.look_ahead(beside);
            }
        }
    }

    fn for_each_beside(&mut self, cell: usize, mut visit: impl FnMut(&mut Self, usize, Cost)) {
        let weight = self.weights[cell];
        if weight.is_infinite() {
            return;
        }
        let (mut beside, mut count) = ([(0, 0); 8], 0);
        let cells = Cells::new(&self.weights, self.cols);
        cells.for_each_neighbour((cell, ANYWHERE), |next, half_length, _| {
            beside[count] = (next, step(half_length, weight + self.weights[next]));
            count += 1;
        });
        for &(next, step) in &beside[..count] {
            visit(self, next, step);
        }
    }

    /// Follows the way and puts into the queue what became dearer on it; says whether there was any.
    pub(super) fn raise_on_way(&mut self) -> bool {
        let (mut here, mut any) = (self.start, false);
        loop {
            let CellCosts { found, ahead, key } = self.field[here];
            if found < ahead {
                // Costs that hold fall along the way: one that goes in a circle comes to one that does not a second time.
                if any && key != NOT_QUEUED {
                    return true;
                }
                self.put(here, self.key(here));
                any = true;
            }
            match self.next(here).1 {
                Some(next) => here = next,
                None => return any,
            }
        }
    }
}
