//! Where one stair ends and the next begins: one edge, the back of the one and the front of the other.

use geometry::{Map, Point};
use nalgebra::Point2;

use crate::{Edge, JointsTuning, Stair, StairsConfig, lines::line::StraightLine};

/// Index of the stair that ends where another begins.
pub(crate) fn before(stairs: &[Stair<Map>], index: usize, config: &StairsConfig) -> Option<usize> {
    let stair = &stairs[index];
    let apart = |other: &Stair<Map>| {
        let differ = (other.height_m() - stair.height_m()).abs() > config.own_height;
        apart_m(&other.back, &stair.front, &config.tuning.edges.joints).filter(|_| differ)
    };
    let others = stairs.iter().enumerate().filter(|(at, _)| *at != index);
    let near = others.filter_map(|(at, other)| Some((apart(other)?, at)));
    near.min_by(|(a_m, _), (b_m, _)| a_m.total_cmp(b_m))
        .map(|(_, at)| at)
}

/// How far two edges lie apart, m, if they may be one.
pub(crate) fn apart_m(a: &Edge<Map>, b: &Edge<Map>, tuning: &JointsTuning) -> Option<f64> {
    let place = middle_of_both(a, b)?;
    let apart_m = (a.beyond_m(place.into()) - b.beyond_m(place.into())).abs();
    (a.across().dot(&b.across()) > tuning.parallel && apart_m < tuning.apart).then_some(apart_m)
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
fn beside(a: &Edge<Map>, b: &Edge<Map>) -> Option<(StraightLine, [f64; 2])> {
    let line = a.line()?;
    let span = |edge: &Edge<Map>| {
        [&edge.right, &edge.left].map(|end| line.along.dot(&(end.inner.xy() - line.at)))
    };
    let ([a_right, a_left], [b_right, b_left]) = (span(a), span(b));
    let (right, left) = (a_right.max(b_right), a_left.min(b_left));
    (right < left).then_some((line, [right, left]))
}

/// Ends a stair where another one begins on it, whose front was seen more often than that the stair ends farther back: from afar the
/// next step is taken for a part of this one, for a frame.
pub(crate) fn cut_off(stairs: &mut [Stair<Map>], config: &StairsConfig) {
    let tuning = &config.tuning.edges.joints;
    for index in 0..stairs.len() {
        let stair = &stairs[index];
        let begins = stairs
            .iter()
            .filter(|other| (other.height_m() - stair.height_m()).abs() > config.own_height)
            .filter(|other| other.seen_ends.front > stair.seen_ends.back)
            .filter_map(|other| Some((begins_at_m(stair, &other.front, tuning)?, other.front)))
            .min_by(|(a_m, _), (b_m, _)| a_m.total_cmp(b_m));
        if let Some(line) = begins.and_then(|(_, front)| front.line()) {
            stairs[index].back = stairs[index].back.onto(&line);
        }
    }
}

/// How far behind a stair's front an edge lies that crosses most of the stair, m.
fn begins_at_m(stair: &Stair<Map>, edge: &Edge<Map>, tuning: &JointsTuning) -> Option<f64> {
    let part = part_beside(edge, &stair.back)?;
    let at = part.middle_m();
    let depth_m = stair.front.beyond_m(at);
    let crosses = part.length_m() > tuning.wide * stair.back.length_m()
        && stair.back.across().dot(&edge.across()) > tuning.parallel;
    let within = depth_m > tuning.least_depth && stair.back.beyond_m(at) < -tuning.apart;
    (crosses && within).then_some(depth_m)
}

/// Makes one edge of the back of each stair and the front of the next, each by how much of its support saw it.
pub(crate) fn join(stairs: &mut [Stair<Map>], config: &StairsConfig) {
    let unseen = config.tuning.edges.joints.unseen;
    for index in 0..stairs.len() {
        let Some(before) = before(stairs, index, config) else {
            continue;
        };
        let (back, front) = (stairs[before].back, stairs[index].front);
        let (nearer, farther) = (stairs[before].seen_ends.back, stairs[index].seen_ends.front);
        let share = (farther as f64 + unseen) / (nearer as f64 + farther as f64 + 2.0 * unseen);
        if let Some(line) = between(&back, &front, share) {
            stairs[before].back = back.onto(&line);
            stairs[index].front = front.onto(&line);
        }
    }
}

/// The line between two edges: `share` of the way from the first to the second.
fn between(a: &Edge<Map>, b: &Edge<Map>, share: f64) -> Option<StraightLine> {
    let at = middle_of_both(a, b)?;
    let [from, to] = [a, b].map(|edge| at - edge.across() * edge.beyond_m(at.into()));
    let [from_along, to_along] = [a.line()?.along, b.line()?.along];
    Some(StraightLine {
        at: from + (to - from) * share,
        along: (from_along.lerp(&to_along, share)).try_normalize(1e-9)?,
    })
}

#[cfg(test)]
mod tests {
    use geometry::Robot;
    use proptest::prelude::*;

    use super::*;

    /// A stair across the way, `width_m` wide, seen to end in front and behind by so many points.
    fn stair(
        [from_m, to_m]: [f64; 2],
        height_m: f64,
        width_m: f64,
        seen: [usize; 2],
    ) -> Stair<Map> {
        let edge = |x_m: f64| Edge {
            left: Point::<Robot>::new(x_m, 0.5 * width_m, height_m),
            right: Point::new(x_m, -0.5 * width_m, height_m),
        };
        let (front, back) = (edge(from_m), edge(to_m));
        let mut stair = Stair::seen(front, back, front.middle(), 1000);
        [stair.seen_ends.front, stair.seen_ends.back] = seen;
        stair.transformed(&geometry::Pose::identity())
    }

    /// Where a tread of 12 cm ends that is taken to end at `to_m`, with another at its end; m.
    fn end_m(to_m: f64, back_seen: usize, next_width_m: f64, rise_m: f64) -> f64 {
        let mut stairs = [
            stair([0.84, to_m], 0.09, 0.9, [2600, back_seen]),
            stair([0.96, 1.36], 0.09 + rise_m, next_width_m, [1900, 1400]),
        ];
        cut_off(&mut stairs, &StairsConfig::default());
        stairs[0].back.middle().inner.x
    }

    proptest! {
        #[test]
        fn a_stair_ends_where_another_begins_on_it(to_m in 1.01..1.6f64, rise_m in 0.015..0.05f64, down in any::<bool>()) {
            let rise_m = if down { -rise_m } else { rise_m };
            prop_assert!((end_m(to_m, 400, 0.9, rise_m) - 0.96).abs() < 1e-9);
        }

        #[test]
        fn but_not_where_it_was_seen_to_go_on_or_beside_or_on_its_own_level(to_m in 1.01..1.6f64) {
            prop_assert_eq!(end_m(to_m, 2000, 0.9, 0.03), to_m);
            prop_assert_eq!(end_m(to_m, 400, 0.4, 0.03), to_m);
            prop_assert_eq!(end_m(to_m, 400, 0.9, 0.005), to_m);
        }
    }
}
