//! Scan lines, split into pieces that are straight in disparity.

use super::config::ScanLine1994Config;
use crate::{picture::Picture, regions::PlaneSums};

/// A straight piece of a scan line.
#[derive(Debug, Clone, Copy)]
pub(super) struct StraightSegment {
    /// Which scan line.
    pub(super) strip: usize,
    /// First row.
    pub(super) first: usize,
    /// One behind the last row.
    pub(super) end: usize,
    /// Middle column of the scan line.
    pub(super) col: f64,
    /// Disparities of the straight line at its two ends, px.
    pub(super) ends_px: [f64; 2],
    /// For the planes that it is part of.
    pub(super) sums: PlaneSums,
}

impl StraightSegment {
    /// Rows.
    pub(super) const fn length(&self) -> usize {
        self.end - self.first
    }

    /// Whether at least this share of the shorter one lies beside the longer one.
    pub(super) fn overlaps(&self, other: &Self, share: f64) -> bool {
        let (first, end) = (self.first.max(other.first), self.end.min(other.end));
        let shorter = self.length().min(other.length()) as f64;
        first < end && (end - first) as f64 >= share * shorter
    }
}

/// Cuts scan lines. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct Lines {
    /// Rows and disparities of the run that is collected.
    run: Vec<(usize, f32)>,
    /// Pieces that are still to be looked at: positions in the run.
    pieces: Vec<(usize, usize)>,
}

impl Lines {
    /// Fills `segments`, scan line by scan line, each from the top down.
    pub(super) fn cut(
        &mut self,
        picture: Picture<'_>,
        config: &ScanLine1994Config,
        segments: &mut Vec<StraightSegment>,
    ) {
        segments.clear();
        let height = picture.disparity_px.len() / picture.width;
        for strip in 0..picture.width.div_ceil(config.strip) {
            self.run.clear();
            for row in 0..height {
                let Some(d) = mean(picture, config, strip, row) else {
                    continue;
                };
                if let Some(&(last, _)) = self.run.last()
                    && row - last > config.tuning.max_gap + 1
                {
                    self.split_run(picture.width, config, strip, segments);
                }
                self.run.push((row, d));
            }
            self.split_run(picture.width, config, strip, segments);
        }
    }

    /// The classical recursive split (Duda and Hart): at the row that is furthest from the line between the ends, until
    /// none is too far. Empties the run.
    fn split_run(
        &mut self,
        width: usize,
        config: &ScanLine1994Config,
        strip: usize,
        segments: &mut Vec<StraightSegment>,
    ) {
        self.pieces.clear();
        self.pieces.push((0, self.run.len()));
        while let Some((start, end)) = self.pieces.pop() {
            if end - start < config.min_segment {
                continue;
            }
            let piece = &self.run[start..end];
            match furthest(piece).filter(|&(_, far)| far > config.split as f32) {
                // The upper part is looked at first.
                Some((at, _)) => self.pieces.extend([(start + at, end), (start, start + at)]),
                None => segments.extend(segment(piece, width, config, strip)),
            }
        }
        self.run.clear();
    }
}

/// The mean disparity of a row of a scan line, where enough of it was seen.
fn mean(
    picture: Picture<'_>,
    config: &ScanLine1994Config,
    strip: usize,
    row: usize,
) -> Option<f32> {
    let first = strip * config.strip;
    let end = (first + config.strip).min(picture.width);
    let pixels = &picture.disparity_px[row * picture.width + first..row * picture.width + end];
    let (mut count, mut sum) = (0_u32, 0.0);
    for d in pixels.iter().filter(|d| !d.is_nan()) {
        count += 1;
        sum += d;
    }
    let enough = f64::from(count) >= config.tuning.seen * (end - first) as f64;
    enough.then(|| sum / count as f32)
}

/// The place in a piece that is furthest from the line between its ends, and how far it is, px.
fn furthest(piece: &[(usize, f32)]) -> Option<(usize, f32)> {
    let (&(first, from), &(last, to)) = (piece.first()?, piece.last()?);
    let slope = (to - from) / (last - first).max(1) as f32;
    let far = |&(row, d): &(usize, f32)| (d - from - slope * (row - first) as f32).abs();
    (1..piece.len().saturating_sub(1))
        .map(|at| (at, far(&piece[at])))
        .max_by(|a, b| a.1.total_cmp(&b.1))
}

/// A piece as a segment, with the straight line of least squares.
fn segment(
    piece: &[(usize, f32)],
    width: usize,
    config: &ScanLine1994Config,
    strip: usize,
) -> Option<StraightSegment> {
    let left = strip * config.strip;
    let right = (left + config.strip).min(width) - 1;
    let col = f64::midpoint(left as f64, right as f64);
    let (first, end) = (piece.first()?.0, piece.last()?.0 + 1);
    let mut sums = PlaneSums::default();
    let [mut n, mut x, mut xx, mut y, mut xy] = [0.0_f64; 5];
    for &(row, d) in piece {
        let (row, d) = (row as f64, f64::from(d));
        sums.add([col, row, 1.0], d);
        n += 1.0;
        x += row;
        xx += row * row;
        y += d;
        xy += row * d;
    }
    let slope = (n * xy - x * y) / (n * xx - x * x);
    let at = |row: usize| y / n + slope * (row as f64 - x / n);
    slope.is_finite().then(|| StraightSegment {
        strip,
        first,
        end,
        col,
        ends_px: [at(first), at(end - 1)],
        sums,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(disparity_px: &[f32]) -> Vec<(usize, usize, usize)> {
        let picture = Picture {
            width: 8,
            disparity_px,
            g: disparity_px,
            sigma_px: disparity_px,
            finer: 1,
        };
        let config = ScanLine1994Config {
            strip: 4,
            split: 0.3,
            ..ScanLine1994Config::default()
        };
        let mut segments = Vec::new();
        Lines::default().cut(picture, &config, &mut segments);
        segments.iter().map(|s| (s.strip, s.first, s.end)).collect()
    }

    fn rows(d: impl Fn(usize) -> f32) -> Vec<f32> {
        (0..8 * 40).map(|at| d(at / 8)).collect()
    }

    #[test]
    fn a_straight_line_is_one_segment_whatever_its_slope() {
        for slope in [-0.1, 0.0, 0.2] {
            let line = rows(|row| 8.0 + slope * row as f32);
            assert_eq!(cut(&line), [(0, 0, 40), (1, 0, 40)]);
        }
    }

    #[test]
    fn a_bend_and_a_jump_cut_it() {
        let bent = rows(|row| 3.0 + 0.2 * row.min(20) as f32);
        assert_eq!(cut(&bent)[..2], [(0, 0, 20), (0, 20, 40)]);
        let jump = rows(|row| if row < 12 { 3.0 } else { 9.0 });
        let (first, second) = (cut(&jump)[0], cut(&jump)[1]);
        assert!(first.2 <= 13 && first.2 >= 11 && second.1 == first.2);
    }

    #[test]
    fn a_hole_of_many_rows_ends_a_segment_a_small_one_does_not() {
        let hole = |rows_of: std::ops::Range<usize>| {
            rows(|row| {
                if rows_of.contains(&row) {
                    f32::NAN
                } else {
                    5.0
                }
            })
        };
        assert_eq!(cut(&hole(10..18))[..2], [(0, 0, 10), (0, 18, 40)]);
        assert_eq!(cut(&hole(10..13))[..1], [(0, 0, 40)]);
        assert!(cut(&rows(|_| f32::NAN)).is_empty());
    }
}
