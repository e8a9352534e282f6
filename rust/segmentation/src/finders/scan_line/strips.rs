//! Scan lines: strips of a few columns, cut into the pieces on which `q = d / g` is constant (Jiang and Bunke 1994, with
//! one parameter a line instead of two, and the best partition instead of a recursive split).

use super::config::{ScanLineConfig, ScanLineTuning};
use super::partition::Partition;
use super::steep::LineSums;
use super::strip_rows::StripRows;
use crate::picture::Picture;

/// Mark of segments that are horizontal.
const LEVEL: usize = usize::MAX;
/// Mark of segments that are part of something steep.
const DROPPED: usize = usize::MAX - 1;

/// Columns of the picture that are one strip.
pub(super) const fn columns_of(picture: Picture<'_>, config: &ScanLineConfig) -> usize {
    config.strip * picture.finer
}

/// A piece of a strip that lies on one horizontal surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LevelSegment {
    /// Which strip.
    pub(super) strip: usize,
    /// First row.
    pub(super) first: usize,
    /// One behind the last row.
    pub(super) end: usize,
    /// Disparity over `g`, 1/m.
    pub(super) q: f32,
    /// Sum of the weights `(g / sigma)^2` of its rows.
    pub(super) weight: f32,
}

/// Cuts strips into segments. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct Strips {
    strip_rows: StripRows,
    // Of the run of rows that is being collected: which they are, and their partition.
    rows: Vec<usize>,
    partition: Partition,
    // Sums over the run's rows so far for lines in row and disparity.
    lines: Vec<LineSums>,
    // By position among the cuts: the lowest cost so far, and where a steep run began, `LEVEL` or `DROPPED`.
    best: Vec<f64>,
    from: Vec<usize>,
}

impl Strips {
    /// Appends the segments of all strips to `segments`, strip by strip, each from the top down.
    pub(super) fn cut(
        &mut self,
        picture: Picture<'_>,
        config: &ScanLineConfig,
        scale: f32,
        segments: &mut Vec<LevelSegment>,
    ) {
        let (finer, columns) = (picture.finer, columns_of(picture, config));
        let strips = picture.width.div_ceil(columns);
        for strip in 0..strips {
            let first = strip * columns;
            let cols = first..(first + columns).min(picture.width);
            self.strip_rows.read(picture, cols, config, scale);
            self.start_run();
            for row in 0..self.strip_rows.weight.len() {
                let weight = f64::from(self.strip_rows.weight[row]);
                if weight == 0.0 {
                    continue;
                }
                if let Some(&last) = self.rows.last()
                    && row - last > config.tuning.max_gap + 1
                {
                    self.cut_run(strip, config, segments);
                }
                let q = f64::from(self.strip_rows.q[row]);
                self.rows.push(row);
                self.partition.push(q, weight);
                let line = self.lines[self.lines.len() - 1];
                let at = row * finer * picture.width + first;
                let sigma = f64::from(picture.sigma_px[at]);
                let g = weight.sqrt() * sigma;
                self.lines
                    .push(line.with(row as f64, q * g, g, 1.0 / (sigma * sigma)));
            }
            self.cut_run(strip, config, segments);
        }
        // Up to here a row is one of those that were looked at.
        let height = picture.disparity_px.len() / picture.width;
        for segment in segments {
            segment.first *= finer;
            segment.end = (segment.end * finer).min(height);
        }
    }

    /// Cuts the rows collected; empties the collection.
    fn cut_run(&mut self, strip: usize, config: &ScanLineConfig, segments: &mut Vec<LevelSegment>) {
        if self.rows.len() >= config.min_segment {
            let price = f64::from(config.segment_price as f32);
            self.partition.solve(price, config.min_segment);
            self.drop_walls(price, &config.tuning);
            self.append(strip, segments);
        }
        self.start_run();
    }

    fn start_run(&mut self) {
        self.rows.clear();
        self.partition.clear();
        self.lines.clear();
        self.lines.push(LineSums::default());
    }

    /// A wall is cut into slices, too. Drops the runs of segments that one steep line explains at a lower price, by dynamic
    /// programming over the segments.
    fn drop_walls(&mut self, price: f64, tuning: &ScanLineTuning) {
        let cuts = &self.partition.cuts;
        self.best.clear();
        self.best.push(0.0);
        self.from.clear();
        self.from.push(LEVEL);
        for j in 1..cuts.len() {
            let (start, end) = (cuts[j - 1], cuts[j]);
            let mut least = self.best[j - 1] + self.partition.cost(start, end) + price;
            let mut choice = LEVEL;
            for (i, (&cut, best)) in cuts[..j].iter().zip(&self.best).enumerate() {
                let cost = self.lines[end].steep_cost(&self.lines[cut], tuning.steep);
                if let Some(cost) = cost.map(|cost| best + cost + tuning.steep_price)
                    && cost < least
                {
                    least = cost;
                    choice = i;
                }
            }
            self.best.push(least);
            self.from.push(choice);
        }
        let mut j = self.from.len() - 1;
        while j > 0 {
            let run = self.from[j];
            if run == LEVEL {
                j -= 1;
            } else {
                self.from[run + 1..=j].fill(DROPPED);
                j = run;
            }
        }
    }

    fn append(&self, strip: usize, segments: &mut Vec<LevelSegment>) {
        for (pair, choice) in self.partition.cuts.windows(2).zip(&self.from[1..]) {
            let (start, end) = (pair[0], pair[1]);
            if *choice == DROPPED {
                continue;
            }
            let (q, weight) = self.partition.mean(start, end);
            segments.push(LevelSegment {
                strip,
                first: self.rows[start],
                end: self.rows[end - 1] + 1,
                q: q as f32,
                weight: weight as f32,
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(disparity_px: &[f32], g: &[f32], width: usize) -> Vec<LevelSegment> {
        let sigma_px = vec![0.125; disparity_px.len()];
        let picture = Picture {
            width,
            disparity_px,
            g,
            sigma_px: &sigma_px,
            finer: 1,
        };
        let mut segments = Vec::new();
        Strips::default().cut(picture, &ScanLineConfig::default(), 6.0, &mut segments);
        segments
    }

    #[test]
    fn two_heights_give_two_segments_cut_where_they_meet() {
        let g: Vec<f32> = (0..16 * 60).map(|i| 2.0 + (i / 16) as f32 * 0.05).collect();
        let d: Vec<f32> = (0..16 * 60)
            .map(|i| g[i] * if i / 16 < 25 { 2.3 } else { 2.0 })
            .collect();
        let segments = cut(&d, &g, 16);
        assert_eq!(segments.len(), 4);
        for pair in segments.chunks(2) {
            assert_eq!((pair[0].first, pair[0].end), (0, 25));
            assert_eq!((pair[1].first, pair[1].end), (25, 60));
            assert!((pair[0].q - 2.3).abs() < 1e-3 && (pair[1].q - 2.0).abs() < 1e-3);
        }
    }

    #[test]
    fn a_hole_of_many_rows_ends_a_segment() {
        let g = vec![3.0_f32; 8 * 40];
        let mut d = vec![6.0_f32; 8 * 40];
        d[8 * 15..8 * 24].fill(f32::NAN);
        let segments = cut(&d, &g, 8);
        let ends: Vec<_> = segments.iter().map(|s| (s.first, s.end)).collect();
        assert_eq!(ends, [(0, 15), (24, 40)]);
    }

    #[test]
    fn nothing_seen_gives_no_segment() {
        assert!(cut(&[f32::NAN; 160], &[3.0; 160], 8).is_empty());
        assert!(cut(&[6.0; 160], &[-1.0; 160], 8).is_empty());
    }
}
