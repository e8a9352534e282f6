//! Straight sides of a convex boundary (003, section IV.B).

use geometry::Outline;
use nalgebra::{Point2, Vector2};

use crate::lines::line::LineSum;

/// Pieces longer than this must point along their side, m.
const LONG_PIECE_M: f64 = 0.025;
/// Cosine of the largest angle between a long piece and its side.
const PARALLEL: f64 = 0.9;

/// The side of a hull to which the piece from corner `edge` to the next belongs: neighbours are taken in while all stay
/// within `fringe_m` of one line, so that fringes do not split it. Its ends, counter-clockwise.
pub(crate) fn side(hull: &Outline, edge: usize, fringe_m: f64) -> [Point2<f64>; 2] {
    let corners = hull.corners();
    let n = corners.len();
    let (mut first, mut pieces) = (edge, 1);
    let (mut forward, mut backward) = (true, true);
    while (forward || backward) && pieces + 1 < n {
        if forward {
            forward = is_straight(corners, first, pieces + 1, fringe_m);
            pieces += usize::from(forward);
        }
        if backward && pieces + 1 < n {
            let before = (first + n - 1) % n;
            backward = is_straight(corners, before, pieces + 1, fringe_m);
            if backward {
                (first, pieces) = (before, pieces + 1);
            }
        }
    }
    let line = sum(corners, first, pieces);
    let ends = [corners[first], corners[(first + pieces) % n]];
    line.line()
        .map_or(ends, |line| ends.map(|end| line.nearest(&end)))
}

/// Sum over the pieces from corner `first` on, each by its length.
fn sum(corners: &[Point2<f64>], first: usize, pieces: usize) -> LineSum {
    let n = corners.len();
    let mut line = LineSum::default();
    for i in first..first + pieces {
        let (a, b) = (corners[i % n], corners[(i + 1) % n]);
        line.add([&a, &b], (b - a).norm());
    }
    line
}

fn is_straight(corners: &[Point2<f64>], first: usize, pieces: usize, fringe_m: f64) -> bool {
    let n = corners.len();
    let Some(line) = sum(corners, first, pieces).line() else {
        return false;
    };
    (first..first + pieces).all(|i| {
        let (a, b) = (corners[i % n], corners[(i + 1) % n]);
        let piece: Vector2<f64> = b - a;
        let near = [a, b].iter().all(|p| line.offset_m(p).abs() <= fringe_m);
        near && (piece.norm() < LONG_PIECE_M || piece.dot(&line.along) > PARALLEL * piece.norm())
    })
}
