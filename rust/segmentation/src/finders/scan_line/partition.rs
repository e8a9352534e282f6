//! The cheapest cut of a run of rows into pieces of constant `q`, each piece at a price (dynamic programming).

/// Starts whose lowest cost is kept together, to be passed over together.
const BLOCK: usize = 4;
/// Costs that differ by less may differ by rounding alone, in squared noise.
const ROUNDING: f64 = 1e-6;

/// Cuts runs of rows. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct Partition {
    // Sums over the rows so far: weight, weight q, weight q^2.
    sums: Vec<[f64; 3]>,
    // Cost of the cheapest partition of so many rows, where its last piece starts, and the lowest cost in each block.
    best: Vec<f64>,
    from: Vec<usize>,
    lowest: Vec<f64>,
    /// Where the pieces of the cheapest partition start, and the end.
    pub(super) cuts: Vec<usize>,
}

impl Partition {
    /// Forgets the rows.
    pub(super) fn clear(&mut self) {
        self.sums.clear();
        self.sums.push([0.0; 3]);
    }

    /// Adds a row.
    pub(super) fn push(&mut self, q: f64, weight: f64) {
        let [w, wq, wqq] = self.sums[self.sums.len() - 1];
        self.sums
            .push([w + weight, wq + weight * q, wqq + weight * q * q]);
    }

    /// Squared residuals, in noise, of the rows from `start` to `end` (exclusive) against their mean.
    pub(super) fn cost(&self, start: usize, end: usize) -> f64 {
        self.piece(0.0, start, end)
    }

    /// Mean `q` and weight of the rows from `start` to `end` (exclusive).
    pub(super) fn mean(&self, start: usize, end: usize) -> (f64, f64) {
        let (a, b) = (self.sums[start], self.sums[end]);
        ((b[1] - a[1]) / (b[0] - a[0]), b[0] - a[0])
    }

    /// Fills `cuts` with the cheapest partition of the rows, of which there must be `min_segment` or more.
    pub(super) fn solve(&mut self, price: f64, min_segment: usize) {
        let count = self.sums.len() - 1;
        self.best.clear();
        self.best.resize(count + 1, f64::INFINITY);
        self.from.clear();
        self.from.resize(count + 1, 0);
        self.lowest.clear();
        self.lowest.resize(count / BLOCK + 1, f64::INFINITY);
        self.best[0] = 0.0;
        self.lowest[0] = 0.0;
        let mut first = 0;
        for end in min_segment..=count {
            first = self.first_of_use(first, end - min_segment, min_segment);
            let (least, start) = self.cheapest(first..=end - min_segment, end);
            self.best[end] = least + price;
            self.from[end] = start;
            let lowest = &mut self.lowest[end / BLOCK];
            *lowest = lowest.min(self.best[end]);
        }
        self.cuts.clear();
        let mut end = count;
        while end > 0 {
            self.cuts.push(end);
            end = self.from[end];
        }
        self.cuts.push(0);
        self.cuts.reverse();
    }

    /// The first start from `first` on that a piece which ends behind `split` may have: one that costs more up to `split`
    /// than the cheapest partition does is none, for every further row costs it no less (Killick et al. 2012).
    fn first_of_use(&self, mut first: usize, split: usize, min_segment: usize) -> usize {
        while first + min_segment <= split
            && self.piece(self.best[first], first, split) > self.best[split] + ROUNDING
        {
            first += 1;
        }
        first
    }

    /// Cost up to `end` with the best start of the last piece among these, and that start.
    fn cheapest(&self, starts: std::ops::RangeInclusive<usize>, end: usize) -> (f64, usize) {
        let (mut start, last) = starts.into_inner();
        let guess = self.from[end - 1].clamp(start, last);
        // No start can be the best that costs more than this by itself.
        let mut limit = self.piece(self.best[guess], guess, end) + ROUNDING;
        let mut cheapest = (f64::INFINITY, 0);
        while start <= last {
            let next = (start / BLOCK + 1) * BLOCK;
            if self.lowest[start / BLOCK] <= limit {
                for start in start..next.min(last + 1) {
                    let cost = self.piece(self.best[start], start, end);
                    if cost < cheapest.0 {
                        cheapest = (cost, start);
                    }
                }
                limit = limit.min(cheapest.0 + ROUNDING);
            }
            start = next;
        }
        cheapest
    }

    /// `before` and the squared residuals from `start` to `end`.
    fn piece(&self, before: f64, start: usize, end: usize) -> f64 {
        let (a, b) = (self.sums[start], self.sums[end]);
        let weighted = b[1] - a[1];
        before + (b[2] - a[2]) - weighted * weighted / (b[0] - a[0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The lowest cost of all partitions, each start tried.
    fn exhaustive(partition: &Partition, price: f64, min_segment: usize) -> f64 {
        let count = partition.sums.len() - 1;
        let mut best = vec![f64::INFINITY; count + 1];
        best[0] = 0.0;
        for end in min_segment..=count {
            best[end] = (0..=end - min_segment)
                .map(|start| best[start] + partition.cost(start, end) + price)
                .fold(f64::INFINITY, f64::min);
        }
        best[count]
    }

    proptest! {
        #[test]
        fn no_partition_is_cheaper(
            steps in prop::collection::vec((-0.2..0.2f64, 1..20usize), 1..6),
            noise in prop::collection::vec(-0.02..0.02f64, 120),
            price in 1.0..50.0f64,
            min_segment in 1..6usize,
        ) {
            let mut partition = Partition::default();
            partition.clear();
            let levels = steps.iter().flat_map(|&(level, rows)| std::iter::repeat_n(2.0 + level, rows));
            for (level, noise) in levels.zip(&noise) {
                partition.push(level + noise, 800.0);
            }
            prop_assume!(partition.sums.len() > min_segment);
            partition.solve(price, min_segment);
            let found: f64 = partition
                .cuts
                .windows(2)
                .map(|pair| partition.cost(pair[0], pair[1]) + price)
                .sum();
            prop_assert!((found - exhaustive(&partition, price, min_segment)).abs() < 1e-6);
        }
    }
}
