//! Scan lines, some columns wide, cut into pieces of one plane each, at the best places that there are.

use std::ops::Range;

use super::patch::{PlanePatch, Rules};
use crate::picture::Picture;

/// A piece of a scan line.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    /// Which scan line.
    pub(super) strip: usize,
    /// Rows of the piece.
    pub(super) rows: Range<usize>,
    /// Pixels of the piece.
    pub(super) patch: PlanePatch,
}

/// Cuts scan lines. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct Cutter {
    /// Sums over all rows before each one.
    before: Vec<PlanePatch>,
    /// Cost of the best cut of all rows before each one, and where its last piece starts.
    best: Vec<(f64, usize)>,
}

impl Cutter {
    /// Fills `pieces`, scan line by scan line, each from the top down.
    pub(super) fn cut(&mut self, picture: Picture<'_>, rules: Rules<'_>, pieces: &mut Vec<Piece>) {
        pieces.clear();
        for strip in 0..picture.width.div_ceil(rules.config.strip) {
            self.sum_up(picture, rules, strip);
            self.find_cuts(rules);
            let start = pieces.len();
            let mut end = self.best.len() - 1;
            while end > 0 {
                let first = self.best[end].1;
                let patch = self.before[end].without(&self.before[first]);
                let seen = patch.count()
                    >= rules.config.tuning.seen * ((end - first) * rules.config.strip) as f64;
                if end - first >= rules.config.min_segment && seen {
                    pieces.push(Piece {
                        strip,
                        rows: first..end,
                        patch,
                    });
                }
                end = first;
            }
            pieces[start..].reverse();
        }
    }

    fn sum_up(&mut self, picture: Picture<'_>, rules: Rules<'_>, strip: usize) {
        let cols =
            strip * rules.config.strip..((strip + 1) * rules.config.strip).min(picture.width);
        let mut sums = PlanePatch::default();
        self.before.clear();
        self.before.push(sums);
        for (row, line) in picture.disparity_px.chunks_exact(picture.width).enumerate() {
            for col in cols.clone().filter(|&col| !line[col].is_nan()) {
                sums.add(col, row, line[col]);
            }
            self.before.push(sums);
        }
    }

    /// The optimal partition (Jackson et al. 2005): the best cut before a row ends with the best last piece.
    fn find_cuts(&mut self, rules: Rules<'_>) {
        self.best.clear();
        self.best.push((0.0, 0));
        for end in 1..self.before.len() {
            let cost = |start: usize| {
                let patch = self.before[end].without(&self.before[start]);
                self.best[start].0
                    + patch.cost(rules.noise) / rules.config.alike
                    + rules.config.price
            };
            let best = (end.saturating_sub(rules.config.tuning.longest)..end)
                .map(|start| (cost(start), start))
                .min_by(|a, b| a.0.total_cmp(&b.0));
            self.best.extend(best);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::config::ScanLineAdaptiveConfig;
    use super::super::patch::NoiseRange;
    use super::*;
    use testkit::synthetic::Noise;

    /// Rows of the first scan line's pieces.
    fn cut(sigma_px: impl Fn(usize) -> f64, d: impl Fn(usize, usize) -> f64) -> Vec<Range<usize>> {
        let mut noise = Noise::new(3);
        let disparity_px: Vec<f32> = (0..8 * 60)
            .map(|at| {
                let error = noise.within(sigma_px(at / 8) * 3.0_f64.sqrt());
                (d(at % 8, at / 8) + error) as f32
            })
            .collect();
        let picture = Picture {
            width: 8,
            disparity_px: &disparity_px,
            g: &disparity_px,
            sigma_px: &disparity_px,
            finer: 1,
        };
        let config = ScanLineAdaptiveConfig {
            strip: 4,
            price: 20.0,
            alike: 1.0,
            ..ScanLineAdaptiveConfig::default()
        };
        let rules = Rules {
            config: &config,
            noise: NoiseRange {
                least_px: 0.02,
                most_px: 0.5,
            },
            min_region: 80.0,
        };
        let mut pieces = Vec::new();
        Cutter::default().cut(picture, rules, &mut pieces);
        let first = pieces.iter().filter(|piece| piece.strip == 0);
        first.map(|piece| piece.rows.clone()).collect()
    }

    #[test]
    fn a_plane_is_one_piece_whatever_its_slope_and_its_noise() {
        for (slope, sigma) in [(0.0, 0.02), (0.5, 0.02), (-0.3, 0.3)] {
            let whole = cut(|_| sigma, |col, row| 9.0 + slope * (row + col) as f64);
            assert_eq!((whole.len(), &whole[0]), (1, &(0..60)), "{slope} {sigma}");
        }
    }

    #[test]
    fn a_bend_that_is_small_is_found_beside_a_surface_that_is_noisy() {
        let sigma = |row| if row < 20 { 0.3 } else { 0.02 };
        let bent =
            |_, row: usize| 4.0 + 0.02 * row.max(40) as f64 + if row < 20 { 2.0 } else { 0.0 };
        let pieces = cut(sigma, bent);
        assert_eq!(pieces.len(), 3, "{pieces:?}");
        assert_eq!(pieces[0], 0..20);
        assert!(pieces[1].end.abs_diff(40) <= 2, "{pieces:?}");
    }

    #[test]
    fn what_was_not_seen_is_no_piece() {
        assert!(cut(|_| 0.0, |_, _| f64::NAN).is_empty());
    }
}
