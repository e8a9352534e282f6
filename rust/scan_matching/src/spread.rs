//! How uncertain one place is from another: covariances along the shortest way through local maps that share a scan.

use core::cmp::Reverse;
use std::collections::BinaryHeap;

use geometry::PlanarPose;
use nalgebra::Matrix3;

/// Covariance of a pose, x and y along the axes of the map and heading: m², m rad, rad².
pub(crate) type Spread = Matrix3<f64>;

/// What a turn of one place does to another that is fixed to it.
fn lever(from: &PlanarPose, to: &PlanarPose) -> Matrix3<f64> {
    let (right_m, up_m) = (to.x_m - from.x_m, to.y_m - from.y_m);
    Matrix3::new(1.0, 0.0, -up_m, 0.0, 1.0, right_m, 0.0, 0.0, 1.0)
}

/// The covariance of a pose that is fixed to another one of a known covariance.
pub(crate) fn carried(spread: &Spread, from: &PlanarPose, to: &PlanarPose) -> Spread {
    let by = lever(from, to);
    by * spread * by.transpose()
}

/// A covariance in axes that are turned by so much, rad.
pub(crate) fn turned(spread: &Spread, by_rad: f64) -> Spread {
    let (sin, cos) = libm::sincos(by_rad);
    let turn = Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0);
    turn * spread * turn.transpose()
}

/// Two local maps that a scan was matched to: where that was taken, and how well the two lie to each other there, in the axes of the map of all.
#[derive(Debug, Clone)]
pub(crate) struct Tie {
    pub(crate) maps: [usize; 2],
    pub(crate) node: usize,
    pub(crate) spread: Spread,
}

/// Key by which covariances are ordered: bits of the trace, which is not negative.
fn key(spread: &Spread) -> u64 {
    spread.trace().max(0.0).to_bits()
}

/// The covariance of each local map's frame, as seen from a scan, along the way with least trace; none of those that no tie leads to.
pub(crate) fn spreads_from(
    start: (usize, &PlanarPose, &Spread),
    maps: &[PlanarPose],
    nodes: &[PlanarPose],
    ties: &[Tie],
    ties_of: &[Vec<usize>],
) -> Vec<Option<Spread>> {
    let (map, pose, spread) = start;
    let mut found: Vec<Option<Spread>> = vec![None; maps.len()];
    let mut reached: Vec<Option<Spread>> = vec![None; maps.len()];
    let first = carried(spread, pose, &maps[map]);
    let mut open = BinaryHeap::from([Reverse((key(&first), map))]);
    reached[map] = Some(first);
    while let Some(Reverse((_, map))) = open.pop() {
        if found[map].is_some() {
            continue;
        }
        let Some(spread) = reached[map] else { continue };
        found[map] = Some(spread);
        for &tie in &ties_of[map] {
            let tie = &ties[tie];
            let other = tie.maps[usize::from(tie.maps[0] == map)];
            if found[other].is_some() {
                continue;
            }
            let at = &nodes[tie.node];
            let there = carried(&spread, &maps[map], at) + tie.spread;
            let next = carried(&there, at, &maps[other]);
            if reached[other].is_none_or(|had| key(&next) < key(&had)) {
                open.push(Reverse((key(&next), other)));
                reached[other] = Some(next);
            }
        }
    }
    found
}
