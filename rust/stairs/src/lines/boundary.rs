//! Straight sides of a convex boundary (003, section IV.B).

use geometry::Outline;
use nalgebra::{Point2, Vector2};

use crate::{LinesTuning, lines::line::LineSum};

/// The side of a hull to which the piece from corner `edge` to the next belongs: neighbours are taken in while all stay
/// within `fringe_m` of one line, so that fringes do not split it. Its ends, counter-clockwise.
pub(crate) fn side(
    hull: &Outline,
    edge: usize,
    fringe_m: f64,
    tuning: &LinesTuning,
) -> [Point2<f64>; 2] {
    let corners = hull.corners();
    let n = corners.len();
    let is_straight =
        |first: usize, pieces: usize| is_straight(corners, first, pieces, fringe_m, tuning);
    let (mut first, mut pieces) = (edge, 1);
    let (mut forward, mut backward) = (true, true);
    while (forward || backward) && pieces + 1 < n {
        if forward {
            forward = is_straight(first, pieces + 1);
            pieces += usize::from(forward);
        }
        if backward && pieces + 1 < n {
            let before = (first + n - 1) % n;
            backward = is_straight(before, pieces + 1);
            if backward {
                (first, pieces) = (before, pieces + 1);
            }
        }
    }
    let line = sum(corners, first, pieces);
    let ends = [corners[first], corners[(first + pieces) % n]];
    line.line(tuning.agreement)
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

fn is_straight(
    corners: &[Point2<f64>],
    first: usize,
    pieces: usize,
    fringe_m: f64,
    tuning: &LinesTuning,
) -> bool {
    let n = corners.len();
    let Some(line) = sum(corners, first, pieces).line(tuning.agreement) else {
        return false;
    };
    (first..first + pieces).all(|i| {
        let (a, b) = (corners[i % n], corners[(i + 1) % n]);
        let piece: Vector2<f64> = b - a;
        let near = [a, b].iter().all(|p| line.offset_m(p).abs() <= fringe_m);
        near && (piece.norm() < tuning.long_piece
            || piece.dot(&line.along) > tuning.agreement * piece.norm())
    })
}
