//! Points that move in groups: what hangs together as seen from above.

use std::collections::{BTreeMap, BTreeSet};

use geometry::{Cell, Lattice, distance_m};
use settings::{ANY, NOT_NEGATIVE, POSITIVE, at_least, settings};

settings! {
    /// Which points that move are one thing.
    pub struct ClustersConfig("navigation.moving.clusters") {
        /// Points in neighbouring cells of this side, seen from above, hang together.
        cell: f64 = 0.1, "m", POSITIVE;
        /// How many points that were seen through a thing has at least.
        points: usize = 6, "1", at_least(1.0);
        /// What is no higher above the ground stays where it is.
        ground: f64 = 0.02, "m", ANY;
        /// Points this far beside those that were seen through, over the ground, belong to the thing, unless they stay.
        grown: f64 = 0.1, "m", at_least(0.0);
        /// Points in cells of this side with those that were seen through, over the ground, belong to the thing, though others were seen there: its feet, on the floor.
        foot: f64 = 0.04, "m", POSITIVE;
        /// As `foot`, before and behind those points by this times the square of their distance: the error of their ranges.
        foot_error: f64 = 0.02, "1/m" of camera, NOT_NEGATIVE;
        /// A thing's middle lies so many times half of its width, as it is seen, behind the mean of its points: of a round one 0.79, of a flat front 1.
        behind: f64 = 0.8, "1", at_least(0.0);
    }
}

/// A point of a frame, and what the looks of other times say of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointOfView {
    /// Where it is in the map frame, m.
    pub at_m: [f64; 3],
    /// Height above the ground, m.
    pub height_m: f64,
    /// Whether it was seen through: see [`crate::PointLooks::moves`].
    pub moves: bool,
    /// Whether it was seen at its place more often than not.
    pub stays: bool,
    /// Whether it is at the side of what the sensor sees: what it is of may go on there.
    pub at_side: bool,
}

/// A thing that moves, as one frame sees it.
#[derive(Debug, Clone, PartialEq)]
pub struct MovingCluster {
    /// Its middle over the ground, m in the map frame: behind its points, of which only its front is seen.
    pub at_m: [f64; 2],
    /// Half of its width as it is seen, m.
    pub radius_m: f64,
    /// Whether the side of what the sensor sees cuts it, so that its middle is elsewhere.
    pub is_cut: bool,
    /// Indices of its points, rising.
    pub points: Vec<usize>,
}

/// The things that move among the points of a frame, seen from a place over the ground, m in the map frame; no point is in two of them. They are in the order
/// of their first cell.
pub fn moving_clusters(
    points: &[PointOfView],
    eye_m: [f64; 2],
    config: &ClustersConfig,
) -> Vec<MovingCluster> {
    let lattice = Lattice {
        origin_m: [0.0; 2],
        cell_m: config.cell,
    };
    let cell_of = |point: &PointOfView| lattice.cell_at(point.at_m[0], point.at_m[1]);
    let fine = Lattice {
        cell_m: config.foot,
        ..lattice
    };
    let mut feet: BTreeSet<Cell> = BTreeSet::new();
    let stands = |point: &PointOfView| point.height_m > config.ground;
    let mut seeds: BTreeMap<Cell, usize> = BTreeMap::new();
    for point in points.iter().filter(|point| point.moves && stands(point)) {
        *seeds.entry(cell_of(point)).or_default() += 1;
        let off = [0, 1].map(|axis| point.at_m[axis] - eye_m[axis]);
        let away_m = geometry::hypot(off[0], off[1]);
        // As far along the line of sight as the range may be wrong.
        let steps = (config.foot_error * away_m * away_m / config.foot).round() as i32;
        for step in -steps..=steps {
            let by = f64::from(step) * config.foot / away_m.max(f64::MIN_POSITIVE);
            let [x_m, y_m] = [0, 1].map(|axis| point.at_m[axis] + by * off[axis]);
            let _ = feet.insert(fine.cell_at(x_m, y_m));
        }
    }
    let parts = joined(&seeds);
    let mut part_of: BTreeMap<Cell, usize> = BTreeMap::new();
    let reach = (config.grown / config.cell).ceil() as i32;
    for (number, (part, _)) in parts
        .iter()
        .enumerate()
        .filter(|(_, (_, count))| *count >= config.points)
    {
        for (cell, (east, north)) in part
            .iter()
            .flat_map(|cell| around(reach).map(move |by| (cell, by)))
        {
            let beside = Cell::new(cell.col + east, cell.row + north);
            let owner = part_of.entry(beside).or_insert(number);
            if part.contains(&beside) {
                *owner = number;
            }
        }
    }
    let mut found: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (index, point) in points.iter().enumerate() {
        let belongs = stands(point) && (point.moves || !point.stays)
            || feet.contains(&fine.cell_at(point.at_m[0], point.at_m[1]));
        if let Some(number) = part_of.get(&cell_of(point)).filter(|_| belongs) {
            found.entry(*number).or_default().push(index);
        }
    }
    let clusters = found.into_values();
    clusters
        .map(|chosen| cluster(points, chosen, eye_m, config.behind))
        .collect()
}

/// Cells that hang together by sides or corners, and how many points each group holds.
fn joined(seeds: &BTreeMap<Cell, usize>) -> Vec<(BTreeSet<Cell>, usize)> {
    let mut left: BTreeSet<Cell> = seeds.keys().copied().collect();
    let mut parts = Vec::new();
    while let Some(first) = left.pop_first() {
        let (mut open, mut part, mut count) = (vec![first], BTreeSet::new(), 0);
        while let Some(cell) = open.pop() {
            count += seeds.get(&cell).copied().unwrap_or(0);
            let _ = part.insert(cell);
            for (east, north) in around(1) {
                open.extend(left.take(&Cell::new(cell.col + east, cell.row + north)));
            }
        }
        parts.push((part, count));
    }
    parts
}

fn around(reach: i32) -> impl Iterator<Item = (i32, i32)> {
    (-reach..=reach).flat_map(move |east| (-reach..=reach).map(move |north| (east, north)))
}

fn cluster(
    points: &[PointOfView],
    chosen: Vec<usize>,
    eye_m: [f64; 2],
    behind: f64,
) -> MovingCluster {
    let places = || {
        let indices = chosen.iter();
        indices.map(|&index| [points[index].at_m[0], points[index].at_m[1]])
    };
    let count = chosen.len() as f64;
    let mean_m = [0, 1].map(|axis| places().map(|at_m| at_m[axis]).sum::<f64>() / count);
    let away_m = distance_m(mean_m, eye_m).max(f64::MIN_POSITIVE);
    let ahead = [0, 1].map(|axis| (mean_m[axis] - eye_m[axis]) / away_m);
    let aside_m =
        |at_m: [f64; 2]| (at_m[1] - mean_m[1]) * ahead[0] - (at_m[0] - mean_m[0]) * ahead[1];
    let ends_m = places()
        .map(aside_m)
        .fold([0.0, 0.0], |[low, high]: [f64; 2], at_m| {
            [low.min(at_m), high.max(at_m)]
        });
    let radius_m = (ends_m[1] - ends_m[0]) / 2.0;
    MovingCluster {
        at_m: [0, 1].map(|axis| mean_m[axis] + behind * radius_m * ahead[axis]),
        radius_m,
        is_cut: chosen.iter().any(|&index| points[index].at_side),
        points: chosen,
    }
}
