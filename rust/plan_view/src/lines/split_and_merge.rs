//! Lines of one scan, its points in order: split where they are too far off, merged where two are one (004, Fig. 36.4; Douglas and Peucker 1973).

use settings::{ConfigError, POSITIVE, Table, at_least, settings};

use super::line::PlanarLine;

settings! {
    /// How the points of a scan are split into lines.
    pub struct SplitAndMergeConfig("plan_view.split_and_merge") {
        /// No point lies further than this from the line of its piece.
        threshold: f64 = 0.05, "m", POSITIVE, "004, section 36.2.2";
        /// Pieces with fewer points are left out.
        least_points: usize = 2, "1", at_least(2.0);
    }
}

/// Points in a row that are one line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScanPiece {
    /// Index of the first of them.
    pub first: usize,
    /// Index of the last of them. Where two pieces meet in a corner, it is in both.
    pub last: usize,
    /// Their line.
    pub line: PlanarLine,
}

/// The lines of points that were seen in this order, m: each point lies within the threshold of the line of its piece.
///
/// A split is where a point is furthest from the line through the first and last one. Then pieces side by side are merged, the best fit first, as
/// long as all of their points stay within the threshold: a split for a point that lies a little off is taken back.
pub fn split_and_merge(
    points_m: &[[f64; 2]],
    config: &SplitAndMergeConfig,
) -> Result<Vec<ScanPiece>, ConfigError> {
    config.check()?;
    let mut pieces = Vec::new();
    if points_m.len() > 1 {
        split(
            points_m,
            (0, points_m.len() - 1),
            config.threshold,
            &mut pieces,
        );
        merge(points_m, config.threshold, &mut pieces);
    }
    pieces.retain(|piece| piece.last - piece.first + 1 >= config.least_points);
    Ok(pieces)
}

/// Splits the pieces until each has a line that fits; the stack is our own, for points of which each is a corner.
fn split(
    points_m: &[[f64; 2]],
    whole: (usize, usize),
    threshold_m: f64,
    pieces: &mut Vec<ScanPiece>,
) {
    let mut open = vec![whole];
    while let Some((first, last)) = open.pop() {
        let line = fitted(points_m, first, last);
        match line {
            Some(line)
                if last - first < 2 || worst_m(points_m, first, last, &line) <= threshold_m =>
            {
                pieces.push(ScanPiece { first, last, line });
            }
            Some(_) if last - first >= 2 => {
                let at = splitting_point(points_m, first, last);
                open.push((at, last));
                open.push((first, at));
            }
            _ => {}
        }
    }
}

/// Merges two pieces side by side, or gives one to those on both sides of it, as long as all points stay near enough.
fn merge(points_m: &[[f64; 2]], threshold_m: f64, pieces: &mut Vec<ScanPiece>) {
    while merged_two(points_m, threshold_m, pieces) || dissolved_one(points_m, threshold_m, pieces)
    {
    }
}

/// Merges the two pieces side by side that are one best; whether there were any.
fn merged_two(points_m: &[[f64; 2]], threshold_m: f64, pieces: &mut Vec<ScanPiece>) -> bool {
    let pairs = 0..pieces.len().saturating_sub(1);
    let one = |index: usize| {
        let (left, right) = (&pieces[index], &pieces[index + 1]);
        let (piece, worst_m) = piece_of(points_m, left.first, right.last)?;
        (left.last == right.first && worst_m <= threshold_m).then_some((index, worst_m, piece))
    };
    let best = pairs
        .filter_map(one)
        .min_by(|(_, one, _), (_, other, _)| one.total_cmp(other));
    let Some((index, _, piece)) = best else {
        return false;
    };
    let _two = pieces.splice(index..index + 2, [piece]);
    true
}

/// Gives a piece to its neighbours that is there only since the first split was beside the corner; whether there was one.
fn dissolved_one(points_m: &[[f64; 2]], threshold_m: f64, pieces: &mut Vec<ScanPiece>) -> bool {
    for index in 1..pieces.len().saturating_sub(1) {
        let (left, middle, right) = (pieces[index - 1], pieces[index], pieces[index + 1]);
        if left.last != middle.first || middle.last != right.first {
            continue;
        }
        let two = |at: usize| {
            let (one, one_m) = piece_of(points_m, left.first, at)?;
            let (other, other_m) = piece_of(points_m, at, right.last)?;
            let worst_m = one_m.max(other_m);
            (worst_m <= threshold_m).then_some((worst_m, [one, other]))
        };
        let best = (middle.first..=middle.last).filter_map(two);
        if let Some((_, both)) = best.min_by(|(one, _), (other, _)| one.total_cmp(other)) {
            let _three = pieces.splice(index - 1..index + 2, both);
            return true;
        }
    }
    false
}

/// Points in a row as a piece, and how far the worst is off its line, m.
fn piece_of(points_m: &[[f64; 2]], first: usize, last: usize) -> Option<(ScanPiece, f64)> {
    let line = fitted(points_m, first, last)?;
    Some((
        ScanPiece { first, last, line },
        worst_m(points_m, first, last, &line),
    ))
}

fn fitted(points_m: &[[f64; 2]], first: usize, last: usize) -> Option<PlanarLine> {
    PlanarLine::fit(points_m[first..=last].iter().copied())
}

fn worst_m(points_m: &[[f64; 2]], first: usize, last: usize, line: &PlanarLine) -> f64 {
    let [cos, sin, distance_m] = line.normal_form();
    let off = |at_m: &[f64; 2]| (at_m[0] * cos + at_m[1] * sin - distance_m).abs();
    points_m[first..=last].iter().map(off).fold(0.0, f64::max)
}

/// The point between the ends that is furthest from the line through them; where they are one, from that point.
fn splitting_point(points_m: &[[f64; 2]], first: usize, last: usize) -> usize {
    let (a, b) = (points_m[first], points_m[last]);
    let way = [b[0] - a[0], b[1] - a[1]];
    let off = |index: usize| {
        let to = [points_m[index][0] - a[0], points_m[index][1] - a[1]];
        if way == [0.0; 2] {
            geometry::hypot(to[0], to[1])
        } else {
            (way[0] * to[1] - way[1] * to[0]).abs()
        }
    };
    (first + 1..last)
        .max_by(|&one, &other| off(one).total_cmp(&off(other)))
        .unwrap_or(first + 1)
}
