//! Pieces joined to planes, those first that agree best.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use super::patch::{PlanePatch, Rules};
use super::pieces::Piece;

/// What is asked of two patches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Question {
    /// Whether they are one plane with one noise.
    OneSurface,
    /// Whether they are one plane, each with its own noise: asked of patches that are large enough to tell their noise.
    OnePlane,
}

/// Two patches side by side and what it costs to call them one.
#[derive(Debug, Clone, Copy)]
struct PatchPair {
    cost: f64,
    patches: [usize; 2],
    /// How often each had been joined when the cost was found.
    ages: [u32; 2],
}

impl PartialEq for PatchPair {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for PatchPair {}

impl PartialOrd for PatchPair {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for PatchPair {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_cost = self.cost.total_cmp(&other.cost);
        by_cost.then(self.patches.cmp(&other.patches))
    }
}

/// Joins patches. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct Merging {
    patches: Vec<PlanePatch>,
    costs: Vec<f64>,
    ages: Vec<u32>,
    /// Which patch each was joined to; itself when to none.
    joined_to: Vec<usize>,
    beside: Vec<Vec<usize>>,
    queue: BinaryHeap<Reverse<PatchPair>>,
}

impl Merging {
    /// Joins the pieces; afterwards `root` says which belong together.
    pub(super) fn merge(&mut self, pieces: &[Piece], rules: Rules<'_>) {
        self.start(pieces, rules);
        self.join_all(Question::OneSurface, rules);
        for a in 0..pieces.len() {
            for i in 0..self.beside[a].len() {
                let b = self.beside[a][i];
                if self.joined_to[a] == a && self.joined_to[b] == b && a < b {
                    self.offer(a, b, Question::OnePlane, rules);
                }
            }
        }
        self.join_all(Question::OnePlane, rules);
    }

    fn join_all(&mut self, question: Question, rules: Rules<'_>) {
        while let Some(Reverse(pair)) = self.queue.pop() {
            let [a, b] = pair.patches;
            if pair.ages == [self.ages[a], self.ages[b]] {
                self.join(a, b, question, rules);
            }
        }
    }

    /// The patch that a piece belongs to now.
    pub(super) fn root(&self, mut piece: usize) -> usize {
        while self.joined_to[piece] != piece {
            piece = self.joined_to[piece];
        }
        piece
    }

    /// All pixels of a patch that is joined to no other.
    pub(super) fn patch(&self, root: usize) -> &PlanePatch {
        &self.patches[root]
    }

    fn start(&mut self, pieces: &[Piece], rules: Rules<'_>) {
        self.patches.clear();
        self.patches.extend(pieces.iter().map(|piece| piece.patch));
        self.costs.clear();
        let costs = self.patches.iter().map(|patch| patch.cost(rules.noise));
        self.costs.extend(costs);
        self.ages.clear();
        self.ages.resize(pieces.len(), 0);
        self.joined_to.clear();
        self.joined_to.extend(0..pieces.len());
        self.beside.resize(pieces.len(), Vec::new());
        self.beside.iter_mut().for_each(Vec::clear);
        self.queue.clear();
        let mut first_beside = 0;
        for (at, piece) in pieces.iter().enumerate() {
            if at > 0 && pieces[at - 1].strip == piece.strip {
                self.put_beside(at - 1, at, rules);
            }
            while pieces[first_beside].strip + 1 < piece.strip {
                first_beside += 1;
            }
            for (other, left) in pieces.iter().enumerate().skip(first_beside) {
                if left.strip >= piece.strip {
                    break;
                }
                if left.rows.start < piece.rows.end && piece.rows.start < left.rows.end {
                    self.put_beside(other, at, rules);
                }
            }
        }
    }

    fn put_beside(&mut self, a: usize, b: usize, rules: Rules<'_>) {
        self.beside[a].push(b);
        self.beside[b].push(a);
        self.offer(a, b, Question::OneSurface, rules);
    }

    /// Puts a pair into the queue if it may be one plane.
    fn offer(&mut self, a: usize, b: usize, question: Question, rules: Rules<'_>) {
        let (one, other) = (&self.patches[a], &self.patches[b]);
        let smaller = one.count().min(other.count());
        let cost = match question {
            Question::OneSurface => {
                one.and(other).cost(rules.noise) - self.costs[a] - self.costs[b]
            }
            Question::OnePlane if smaller >= rules.min_region => {
                one.disagreement(other, rules.noise)
            }
            Question::OnePlane => return,
        };
        if cost < rules.config.price * rules.config.alike + rules.config.uneven * smaller {
            self.queue.push(Reverse(PatchPair {
                cost,
                patches: [a, b],
                ages: [self.ages[a], self.ages[b]],
            }));
        }
    }

    /// Joins `b` to `a`.
    fn join(&mut self, a: usize, b: usize, question: Question, rules: Rules<'_>) {
        self.joined_to[b] = a;
        self.patches[a] = self.patches[a].and(&self.patches[b]);
        self.costs[a] = self.patches[a].cost(rules.noise);
        self.ages[a] += 1;
        self.ages[b] += 1;
        let mut beside = std::mem::take(&mut self.beside[a]);
        beside.append(&mut self.beside[b]);
        for other in &mut beside {
            *other = self.root(*other);
        }
        beside.sort_unstable();
        beside.dedup();
        beside.retain(|&other| other != a);
        for &other in &beside {
            self.offer(a.min(other), a.max(other), question, rules);
        }
        self.beside[a] = beside;
    }
}

#[cfg(test)]
mod tests {
    use super::super::config::ScanLineAdaptiveConfig;
    use super::super::patch::NoiseRange;
    use super::super::pieces::Cutter;
    use super::*;
    use crate::picture::pixels::Picture;
    use testkit::synthetic::Noise;

    const NOISE: NoiseRange = NoiseRange {
        least_px: 0.02,
        most_px: 0.5,
    };

    /// Pixels of each plane that is found in a picture of 64 x 64, the largest first.
    fn planes(d: impl Fn(usize, usize) -> f64, sigma_px: impl Fn(usize) -> f64) -> Vec<usize> {
        let (width, mut noise) = (64, Noise::new(5));
        let disparity_px: Vec<f32> = (0..width * 64)
            .map(|at| {
                let error = noise.within(sigma_px(at % width) * 3.0_f64.sqrt());
                (d(at % width, at / width) + error) as f32
            })
            .collect();
        let picture = Picture {
            width,
            disparity_px: &disparity_px,
            g: &disparity_px,
            sigma_px: &disparity_px,
            finer: 1,
        };
        let config = ScanLineAdaptiveConfig {
            strip: 4,
            price: 12.0,
            alike: 4.0,
            uneven: 0.1,
            ..ScanLineAdaptiveConfig::default()
        };
        let rules = Rules {
            config: &config,
            noise: NOISE,
            min_region: 80.0,
        };
        let (mut pieces, mut merging) = (Vec::new(), Merging::default());
        Cutter::default().cut(picture, rules, &mut pieces);
        merging.merge(&pieces, rules);
        let roots = (0..pieces.len()).filter(|&at| merging.root(at) == at);
        let mut sizes: Vec<_> = roots
            .map(|root| merging.patch(root).count() as usize)
            .collect();
        sizes.sort_unstable_by_key(|&size| Reverse(size));
        sizes
    }

    #[test]
    fn a_plane_whose_noise_changes_is_one() {
        let plane = |col: usize, row: usize| 9.0 + 0.1 * col as f64 - 0.05 * row as f64;
        assert_eq!(
            planes(plane, |col| if col < 32 { 0.02 } else { 0.3 }),
            [64 * 64]
        );
    }

    #[test]
    fn planes_that_meet_are_two_whichever_way_their_crease_runs() {
        let roof = |across: usize| 4.0 + 0.05 * across.min(64 - across) as f64;
        for sigma_px in [0.02, 0.1] {
            let along = planes(|col, _| roof(col), |_| sigma_px);
            let across = planes(|_, row| roof(row), |_| sigma_px);
            for sizes in [along, across] {
                let two = sizes[0] < 2400 && sizes[1] > 1600;
                assert!(two, "{sigma_px}: {sizes:?}");
            }
        }
    }

    #[test]
    fn a_step_of_five_noises_parts_two_planes() {
        let step = |col: usize, _| if col < 32 { 5.0 } else { 5.1 };
        let sizes = planes(step, |_| 0.02);
        assert_eq!(sizes[..2], [32 * 64, 32 * 64]);
    }
}
