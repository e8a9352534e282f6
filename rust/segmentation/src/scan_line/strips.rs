//! Scan lines: strips of a few columns, cut into the pieces on which `q = d / g` is constant (Jiang and Bunke 1994, with
//! one parameter a line instead of two, and the best partition instead of a recursive split).

use super::steep::LineSums;
use crate::grounded::Picture;

/// Rays that fall less than this (as a share of `f B`) see nothing horizontal worth having.
const MIN_FALL: f32 = 0.05;
/// Rows without a measurement that a line may bridge.
const MAX_GAP: usize = 3;
/// Widest strip, pixels.
pub(super) const MAX_STRIP: usize = 32;

/// Price of a steep line on a strip, in squared noise.
const STEEP_PRICE: f64 = 40.0;
/// Marks of segments that are horizontal, and of those that are part of something steep.
const LEVEL: usize = usize::MAX;
const DROPPED: usize = usize::MAX - 1;

/// A piece of a strip that lies on one horizontal surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Segment {
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

/// What the cutting needs to know.
#[derive(Debug, Clone, Copy)]
pub(super) struct StripRules {
    /// Columns of a strip.
    pub(super) strip: usize,
    /// Price of one more segment, in squared noise.
    pub(super) price: f32,
    /// Shortest segment, rows.
    pub(super) min_segment: usize,
    /// `f B`, m px.
    pub(super) scale: f32,
}

/// Cuts strips into segments. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct Strips {
    rows: Vec<usize>,
    // Sums over the strip's rows so far: weight, weight q, weight q^2.
    sums: Vec<[f64; 3]>,
    best: Vec<f64>,
    from: Vec<usize>,
    // Sums over the strip's rows so far for lines in row and disparity.
    lines: Vec<LineSums>,
    // Where the segments of the partition start, as positions among the strip's rows.
    cuts: Vec<usize>,
}

impl Strips {
    /// Appends the segments of all strips to `segments`, strip by strip, each from the top down.
    pub(super) fn cut(
        &mut self,
        picture: Picture<'_>,
        rules: StripRules,
        segments: &mut Vec<Segment>,
    ) {
        let strips = picture.width.div_ceil(rules.strip);
        let height = picture.disparity_px.len() / picture.width;
        for strip in 0..strips {
            self.rows.clear();
            self.start_run();
            for row in 0..height {
                let Some((q, weight)) = strip_row(picture, rules, strip, row) else {
                    continue;
                };
                if let Some(&last) = self.rows.last()
                    && row - last > MAX_GAP + 1
                {
                    self.cut_run(strip, rules, segments);
                }
                self.rows.push(row);
                let [w, wq, wqq] = self.sums[self.sums.len() - 1];
                let (q, weight) = (f64::from(q), f64::from(weight));
                self.sums
                    .push([w + weight, wq + weight * q, wqq + weight * q * q]);
                let line = self.lines[self.lines.len() - 1];
                let at = row * picture.width + strip * rules.strip;
                let sigma = f64::from(picture.sigma_px[at]);
                let g = weight.sqrt() * sigma;
                self.lines
                    .push(line.with(row as f64, q * g, g, 1.0 / (sigma * sigma)));
            }
            self.cut_run(strip, rules, segments);
        }
    }

    /// The cheapest partition of the rows collected (dynamic programming); empties the collection.
    fn cut_run(&mut self, strip: usize, rules: StripRules, segments: &mut Vec<Segment>) {
        let count = self.rows.len();
        if count >= rules.min_segment {
            self.best.clear();
            self.from.clear();
            self.best.resize(count + 1, f64::INFINITY);
            self.from.resize(count + 1, 0);
            self.best[0] = 0.0;
            for end in rules.min_segment..=count {
                let [w, wq, wqq] = self.sums[end];
                let mut least = f64::INFINITY;
                let mut start_of_least = 0;
                for (start, (sum, best)) in self.sums[..=end - rules.min_segment]
                    .iter()
                    .zip(&self.best)
                    .enumerate()
                {
                    let (dw, dwq) = (w - sum[0], wq - sum[1]);
                    let cost = best + (wqq - sum[2]) - dwq * dwq / dw;
                    if cost < least {
                        least = cost;
                        start_of_least = start;
                    }
                }
                self.best[end] = least + f64::from(rules.price);
                self.from[end] = start_of_least;
            }
            self.cuts.clear();
            let mut end = count;
            while end > 0 {
                self.cuts.push(end);
                end = self.from[end];
            }
            self.cuts.push(0);
            self.cuts.reverse();
            self.drop_walls(f64::from(rules.price));
            self.append(strip, segments);
        }
        self.start_run();
    }

    fn start_run(&mut self) {
        self.rows.clear();
        self.sums.clear();
        self.sums.push([0.0; 3]);
        self.lines.clear();
        self.lines.push(LineSums::default());
    }

    /// A wall is cut into slices, too. Drops the runs of segments that one steep line explains at a lower price, by dynamic
    /// programming over the segments: `from` then holds, by position among the cuts, where a run began or `LEVEL`.
    fn drop_walls(&mut self, price: f64) {
        self.best[0] = 0.0;
        for j in 1..self.cuts.len() {
            let (start, end) = (self.cuts[j - 1], self.cuts[j]);
            let mut least = self.best[j - 1] + self.level_cost(start, end) + price;
            let mut choice = LEVEL;
            for i in 0..j {
                let cost = self.lines[end].steep_cost(&self.lines[self.cuts[i]]);
                if let Some(cost) = cost.map(|cost| self.best[i] + cost + STEEP_PRICE)
                    && cost < least
                {
                    least = cost;
                    choice = i;
                }
            }
            self.best[j] = least;
            self.from[j] = choice;
        }
        let mut j = self.cuts.len() - 1;
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

    fn level_cost(&self, start: usize, end: usize) -> f64 {
        let (a, b) = (self.sums[start], self.sums[end]);
        let weighted = b[1] - a[1];
        b[2] - a[2] - weighted * weighted / (b[0] - a[0])
    }

    fn append(&self, strip: usize, segments: &mut Vec<Segment>) {
        for (pair, choice) in self.cuts.windows(2).zip(&self.from[1..]) {
            let (start, end) = (pair[0], pair[1]);
            if *choice == DROPPED {
                continue;
            }
            let (a, b) = (self.sums[start], self.sums[end]);
            segments.push(Segment {
                strip,
                first: self.rows[start],
                end: self.rows[end - 1] + 1,
                q: ((b[1] - a[1]) / (b[0] - a[0])) as f32,
                weight: (b[0] - a[0]) as f32,
            });
        }
    }
}

/// `q` of one row of a strip and its weight: the mean over the pixels that agree with the middle one, where at least
/// half of them do.
fn strip_row(
    picture: Picture<'_>,
    rules: StripRules,
    strip: usize,
    row: usize,
) -> Option<(f32, f32)> {
    let first = strip * rules.strip;
    let end = (first + rules.strip).min(picture.width);
    let line = row * picture.width;
    let (disparity, g) = (
        &picture.disparity_px[line + first..line + end],
        &picture.g[line + first..line + end],
    );
    let sigma = picture.sigma_px[line + usize::midpoint(first, end)];
    let least_fall = MIN_FALL * rules.scale;
    let mut sorted = [0.0_f32; MAX_STRIP];
    let mut count = 0;
    for (&d, &g) in disparity.iter().zip(g) {
        if d.is_nan() || g < least_fall {
            continue;
        }
        let q = d / g;
        let mut at = count;
        while at > 0 && sorted[at - 1] > q {
            sorted[at] = sorted[at - 1];
            at -= 1;
        }
        sorted[at] = q;
        count += 1;
    }
    let half = (end - first).div_ceil(2);
    if count < half {
        return None;
    }
    let middle = sorted[count / 2];
    let (mut dg, mut gg, mut agree) = (0.0, 0.0, 0);
    for (&d, &g) in disparity.iter().zip(g) {
        if (d - middle * g).abs() < 3.0 * sigma && g >= least_fall {
            dg += d * g;
            gg += g * g;
            agree += 1;
        }
    }
    (agree >= half).then(|| (dg / gg, gg / agree as f32 / (sigma * sigma)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(disparity_px: &[f32], g: &[f32], width: usize) -> Vec<Segment> {
        let sigma_px = vec![0.125; disparity_px.len()];
        let picture = Picture {
            width,
            disparity_px,
            g,
            sigma_px: &sigma_px,
        };
        let rules = StripRules {
            strip: 8,
            price: 25.0,
            min_segment: 4,
            scale: 6.0,
        };
        let mut segments = Vec::new();
        Strips::default().cut(picture, rules, &mut segments);
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
