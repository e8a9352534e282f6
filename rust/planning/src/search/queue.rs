//! What a search has to expand: in buckets, by the estimated cost.

use super::steps::Trail;

/// Width of a bucket, in cells: how the queue is stored. The cost that is found is the least whatever it is; of ways that cost the same it
/// may decide which one is found.
const WIDTH: f64 = 0.5;

/// The last bucket: what is estimated higher is in it too, in no order, so that no price takes gigabytes.
const LAST: usize = 1 << 20;

/// A cell to expand if it was not reached more cheaply since.
#[derive(Debug, Clone, Copy)]
pub(crate) struct QueueEntry {
    pub(crate) cost: f64,
    pub(crate) cell: u32,
    /// How it was come upon.
    pub(crate) trail: Trail,
}

/// Entries by estimate; within a bucket the last one first. Reused.
#[derive(Debug, Clone, Default)]
pub(crate) struct Queue {
    /// Bucket `now`, from which entries are taken: kept apart, as most of what is taken came in just before.
    current: Vec<QueueEntry>,
    /// The others; `now` and all before are empty.
    buckets: Vec<Vec<QueueEntry>>,
    now: usize,
    /// The first bucket that holds nothing of use.
    end: usize,
}

impl Queue {
    /// Forgets all but a first entry, of which no estimate is lower.
    pub(crate) fn begin(&mut self, estimate: f64, entry: QueueEntry) {
        for left in self.buckets.iter_mut().skip(self.now) {
            left.clear();
        }
        self.now = bucket_of(estimate);
        self.end = usize::MAX;
        self.current.clear();
        self.current.push(entry);
    }

    /// Nothing estimated at this and more is taken from now on.
    pub(crate) fn end_at(&mut self, enough: f64) {
        self.end = (enough / WIDTH).ceil() as usize;
    }

    #[inline]
    pub(crate) fn push(&mut self, estimate: f64, entry: QueueEntry) {
        let bucket = bucket_of(estimate);
        // Rounding must not put it where the search has passed.
        if bucket <= self.now {
            self.current.push(entry);
            return;
        }
        if bucket >= self.buckets.len() {
            self.more_buckets(bucket + 1);
        }
        self.buckets[bucket].push(entry);
    }

    /// Takes the next entry, unless what is left is estimated too high.
    #[inline]
    pub(crate) fn pop(&mut self) -> Option<QueueEntry> {
        while self.now < self.end {
            if let Some(entry) = self.current.pop() {
                return Some(entry);
            }
            self.now += 1;
            std::mem::swap(&mut self.current, self.buckets.get_mut(self.now)?);
        }
        None
    }

    #[cold]
    fn more_buckets(&mut self, count: usize) {
        self.buckets.resize_with(count, Vec::new);
    }
}

#[inline]
fn bucket_of(estimate: f64) -> usize {
    ((estimate / WIDTH) as u32 as usize).min(LAST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_costs_more_than_there_are_buckets_for_is_taken_too() {
        let mut queue = Queue::default();
        let entry = |cell| QueueEntry {
            cost: 0.0,
            cell,
            trail: Trail::default(),
        };
        queue.begin(1.0, entry(0));
        queue.push(1e12, entry(1));
        queue.push(f64::MAX, entry(2));
        let mut taken: Vec<_> = std::iter::from_fn(|| queue.pop()).map(|e| e.cell).collect();
        taken.sort_unstable();
        assert_eq!(taken, [0, 1, 2]);
        assert!(queue.buckets.len() <= LAST + 1);
        // Nothing is left for the next search.
        queue.begin(1.0, entry(3));
        assert_eq!(queue.pop().map(|e| e.cell), Some(3));
        assert!(queue.pop().is_none());
    }
}
