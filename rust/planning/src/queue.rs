//! What a search has to expand: in buckets, by the estimated cost.

use crate::steps::Trail;

/// Width of a bucket, in cells.
const WIDTH: f64 = 0.5;

/// A cell to expand if it was not reached more cheaply since.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Entry {
    pub(crate) cost: f64,
    pub(crate) cell: u32,
    /// How it was come upon.
    pub(crate) trail: Trail,
}

/// Entries by estimate; within a bucket the last one first. Reused.
#[derive(Debug, Clone, Default)]
pub(crate) struct Queue {
    buckets: Vec<Vec<Entry>>,
    /// All before are empty.
    now: usize,
    /// The last one that came into this bucket: what is taken next is mostly what came last, and need not go through memory.
    held: Option<Entry>,
}

impl Queue {
    /// Forgets all but a first entry, of which no estimate is lower.
    pub(crate) fn begin(&mut self, estimate: f64, entry: Entry) {
        for left in self.buckets.iter_mut().skip(self.now) {
            left.clear();
        }
        self.now = bucket_of(estimate);
        self.held = Some(entry);
    }

    #[inline]
    pub(crate) fn push(&mut self, estimate: f64, entry: Entry) {
        // Rounding must not put it where the search has passed.
        let bucket = bucket_of(estimate).max(self.now);
        let entry = if bucket == self.now {
            let Some(before) = self.held.replace(entry) else {
                return;
            };
            before
        } else {
            entry
        };
        if bucket >= self.buckets.len() {
            self.more_buckets(bucket + 1);
        }
        self.buckets[bucket].push(entry);
    }

    /// Takes the next entry, unless all that are left are estimated at `enough` and more.
    #[inline]
    pub(crate) fn pop(&mut self, enough: f64) -> Option<Entry> {
        while (self.now as f64) * WIDTH < enough {
            if let Some(entry) = self.held.take() {
                return Some(entry);
            }
            if let Some(entry) = self.buckets.get_mut(self.now)?.pop() {
                return Some(entry);
            }
            self.now += 1;
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
    (estimate / WIDTH) as u32 as usize
}
