//! Where one stair ends and the next begins: one edge, the back of the one and the front of the other.

use geometry::{Map, Point};
use nalgebra::Point2;

use crate::line::Line;
use crate::{Edge, Stair};

/// Farthest that the two may lie apart, m.
const APART_M: f64 = 0.04;
/// Cosine of the largest angle between them.
const PARALLEL: f64 = 0.966;

/// Index of the stair that ends where another begins.
pub(crate) fn before(stairs: &[Stair<Map>], index: usize, own_height_m: f64) -> Option<usize> {
    let stair = &stairs[index];
    let apart = |other: &Stair<Map>| {
        let differ = (other.height_m() - stair.height_m()).abs() > own_height_m;
        apart_m(&other.back, &stair.front).filter(|_| differ)
    };
    let others = stairs.iter().enumerate().filter(|(at, _)| *at != index);
    let near = others.filter_map(|(at, other)| Some((apart(other)?, at)));
    near.min_by(|(a_m, _), (b_m, _)| a_m.total_cmp(b_m))
        .map(|(_, at)| at)
}

/// How far two edges lie apart, m, if they may be one.
pub(crate) fn apart_m(a: &Edge<Map>, b: &Edge<Map>) -> Option<f64> {
    let place = middle_of_both(a, b)?;
    let apart_m = (a.beyond_m(place.into()) - b.beyond_m(place.into())).abs();
    (a.across().dot(&b.across()) > PARALLEL && apart_m < APART_M).then_some(apart_m)
}

/// The middle of the stretch that two nearly parallel edges have beside each other.
fn middle_of_both(a: &Edge<Map>, b: &Edge<Map>) -> Option<Point2<f64>> {
    let (line, [right, left]) = beside(a, b)?;
    Some(line.at + line.along * f64::midpoint(right, left))
}

/// The stretch of an edge that it has beside a nearly parallel one.
pub(crate) fn part_beside(edge: &Edge<Map>, other: &Edge<Map>) -> Option<Edge<Map>> {
    let (line, ends) = beside(edge, other)?;
    let z_m = edge.middle().inner.z;
    let [right, left] = ends.map(|end_m| {
        let at = line.at + line.along * end_m;
        Point::new(at.x, at.y, z_m)
    });
    Some(Edge { left, right })
}

/// The first edge's line, and from where to where on it both edges lie, m.
fn beside(a: &Edge<Map>, b: &Edge<Map>) -> Option<(Line, [f64; 2])> {
    let line = Line::along(a)?;
    let span = |edge: &Edge<Map>| {
        [&edge.right, &edge.left].map(|end| line.along.dot(&(end.inner.xy() - line.at)))
    };
    let ([a_right, a_left], [b_right, b_left]) = (span(a), span(b));
    let (right, left) = (a_right.max(b_right), a_left.min(b_left));
    (right < left).then_some((line, [right, left]))
}

/// Makes one edge of the back of each stair and the front of the next, each by how much of its support saw it.
pub(crate) fn join(stairs: &mut [Stair<Map>], own_height_m: f64) {
    for index in 0..stairs.len() {
        let Some(before) = before(stairs, index, own_height_m) else {
            continue;
        };
        let (back, front) = (stairs[before].back, stairs[index].front);
        let (nearer, farther) = (stairs[before].seen_ends.back, stairs[index].seen_ends.front);
        let share = (farther as f64 + 1.0) / (nearer as f64 + farther as f64 + 2.0);
        if let Some(line) = between(&back, &front, share) {
            stairs[before].back = back.onto(&line);
            stairs[index].front = front.onto(&line);
        }
    }
}

/// The line between two edges: `share` of the way from the first to the second.
fn between(a: &Edge<Map>, b: &Edge<Map>, share: f64) -> Option<Line> {
    let at = middle_of_both(a, b)?;
    let [from, to] = [a, b].map(|edge| at - edge.across() * edge.beyond_m(at.into()));
    let [from_along, to_along] = [Line::along(a)?.along, Line::along(b)?.along];
    Some(Line {
        at: from + (to - from) * share,
        along: (from_along.lerp(&to_along, share)).try_normalize(1e-9)?,
    })
}
