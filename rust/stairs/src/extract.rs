//! Stairs in one frame (003, section IV.B).

use geometry::{Outline, Point, Robot};
use nalgebra::{Point2, Vector2};
use segmentation::{PlaneRegion, Planes};
use sensing::Intrinsics;

use crate::boundary::side;
use crate::tread::across;
use crate::view::{Shows, View};
use crate::{Edge, Sides, Stair, StairsConfig};

/// Least fringe of a boundary that does not split a side, m.
const FRINGE_M: f64 = 0.008;
/// Share of a side's places that must show that the surface ends there.
const ENDS: f64 = 0.5;
/// Share of a stair's places that must show the surface, of those that show anything.
const SOLID: f64 = 0.6;
/// Front and back may differ by this much in heading before one of them is doubted, cosine.
const OPPOSITE: f64 = 0.82;
/// How far an edge may lie from the front of the lower surface behind it, m; occlusion comes on top.
const GAP_M: f64 = 0.04;

/// One stair as one frame shows it.
#[derive(Debug, Clone)]
pub(crate) struct Sighting {
    /// The stair; its margins are zero.
    pub(crate) stair: Stair<Robot>,
    /// Its whole boundary, robot frame, m.
    pub(crate) hull: Outline,
    /// Whether it is at the robot's own height, with no other surface between.
    pub(crate) own_level: bool,
    /// Whether it is large enough to be a stair by itself.
    pub(crate) large_enough: bool,
}

/// Finds the level surfaces of a frame that may be stairs, and those that the robot may stand on.
pub(crate) fn extract(
    planes: &Planes,
    camera: Intrinsics,
    config: &StairsConfig,
    found: &mut Vec<Sighting>,
) {
    found.clear();
    let view = View::new(planes, camera);
    let sightings = planes
        .regions
        .iter()
        .filter_map(|region| sighting(region, &view));
    found.extend(sightings);
    for i in 0..found.len() {
        found[i].own_level = is_own_level(found, i, config);
    }
    for i in 0..found.len() {
        if let Some(front) = edge_before(found, i, &view, config) {
            let stair = &mut found[i].stair;
            let ends = [&stair.front.right, &stair.front.left].map(|end| front.nearest(end));
            stair.front = level_edge(ends, stair.reference.inner.z);
            stair.seen_ends.front = if front.seen { stair.support } else { 0 };
        }
    }
    for sighting in found {
        let stair = &sighting.stair;
        let shortest_m = stair.front.length_m().min(stair.back.length_m());
        sighting.large_enough =
            shortest_m >= config.min_edge && stair.depth_m() >= config.min_depth;
    }
}

/// Right and left end at a height.
fn level_edge([right, left]: [Point2<f64>; 2], z_m: f64) -> Edge<Robot> {
    let at = |p: Point2<f64>| Point::new(p.x, p.y, z_m);
    Edge {
        left: at(left),
        right: at(right),
    }
}

fn sighting(region: &PlaneRegion, view: &View<'_>) -> Option<Sighting> {
    let (height_m, hull) = (region.floor_height_m?, region.boundary.as_ref()?);
    let reference = region.mean.inner.xy();
    let (away_m, below_m) = (reference.coords.norm(), view.height_m() - height_m);
    if away_m < 1e-3 || below_m < 0.05 {
        return None;
    }
    let fringe_m = FRINGE_M.max(view.row_depth_m(below_m, away_m));
    let [enters, leaves] = hull.cuts(&reference, &reference.coords)?;
    // Counter-clockwise a side that the line enters goes from left to right.
    let [left, right] = side(hull, enters.edge, fringe_m);
    let front = level_edge([right, left], height_m);
    let [right, left] = side(hull, leaves.edge, fringe_m);
    let back = level_edge([right, left], height_m);
    let (front, back) = square(front, back, hull);
    let mut stair = Stair {
        front,
        back,
        reference: Point::new(reference.x, reference.y, height_m),
        left_margin_m: 0.0,
        right_margin_m: 0.0,
        support: region.support,
        seen_ends: Sides::default(),
        front_fit: None,
        back_fit: None,
        steps_ago: 0,
    };
    if !is_solid(&stair, view) {
        return None;
    }
    stair.seen_ends = seen_ends(&stair, view);
    Some(Sighting {
        stair,
        hull: hull.clone(),
        own_level: false,
        large_enough: false,
    })
}

/// Where front and back point different ways, the shorter is drawn anew: along the longer, around the hull.
fn square(front: Edge<Robot>, back: Edge<Robot>, hull: &Outline) -> (Edge<Robot>, Edge<Robot>) {
    if across(&front).dot(&across(&back)) > OPPOSITE {
        return (front, back);
    }
    let parallel = |edge: &Edge<Robot>, outward: f64| {
        let ahead = across(edge);
        let ahead_of = |p: &Point2<f64>| ahead.dot(&(p - edge.middle().inner.xy()));
        let reach_m = hull
            .corners()
            .iter()
            .map(|p| outward * ahead_of(p))
            .fold(0.0, f64::max);
        let shift = (ahead * outward * reach_m).push(0.0);
        let moved = |p: &Point<Robot>| Point::wrap(p.inner + shift);
        Edge {
            left: moved(&edge.left),
            right: moved(&edge.right),
        }
    };
    if front.length_m() >= back.length_m() {
        let back = parallel(&front, 1.0);
        (front, back)
    } else {
        (parallel(&back, -1.0), back)
    }
}

/// Whether the surface is seen at most of the places of the stair: hulls are optimistic.
fn is_solid(stair: &Stair<Robot>, view: &View<'_>) -> bool {
    let (mut surface, mut other) = (0, 0);
    for place in stair.places() {
        match view.shows_at(&place.inner) {
            Some(Shows::Surface) => surface += 1,
            Some(Shows::Higher | Shows::Lower) => other += 1,
            None => {}
        }
    }
    f64::from(surface) >= SOLID * f64::from(surface + other) && surface > 0
}

/// Which sides end the surface and not only the view. What ends behind something higher on the robot's side is hidden.
fn seen_ends(stair: &Stair<Robot>, view: &View<'_>) -> Sides {
    let [front_left, front_right] = [&stair.front.left.inner, &stair.front.right.inner];
    let [back_left, back_right] = [&stair.back.left.inner, &stair.back.right.inner];
    let to_left = |edge: &Edge<Robot>| (edge.left.inner - edge.right.inner).xy();
    let left = to_left(&stair.front) + to_left(&stair.back);
    let ends = |side: [&_; 2], outward: Vector2<f64>| {
        let beyond = view.beyond(side, &outward);
        usize::from(beyond.lower + beyond.higher >= ENDS) * stair.support
    };
    let front = view.beyond([front_left, front_right], &-across(&stair.front));
    Sides {
        front: usize::from(front.lower >= ENDS) * stair.support,
        back: ends([back_left, back_right], across(&stair.back)),
        left: ends([front_left, back_left], left),
        right: ends([front_right, back_right], -left),
    }
}

/// Whether the surface is at the robot's own height, with nothing of another height on the way to it.
fn is_own_level(found: &[Sighting], index: usize, config: &StairsConfig) -> bool {
    let stair = &found[index].stair;
    let own = |stair: &Stair<Robot>| stair.height_m().abs() < config.own_height;
    let to = stair.reference.inner.xy();
    let reach_m = found[index]
        .hull
        .cuts(&to, &to.coords)
        .map_or(0.0, |[enters, _]| along_m(&enters.at, &to));
    let between = |other: &Sighting| {
        let Some([enters, leaves]) = other.hull.cuts(&to, &to.coords) else {
            return false;
        };
        let (from_m, to_m) = (along_m(&enters.at, &to), along_m(&leaves.at, &to));
        !own(&other.stair)
            && from_m > 0.0
            && to_m - from_m > config.min_depth / 2.0
            && to_m < reach_m + GAP_M
    };
    own(stair) && !found.iter().any(between)
}

/// How far a place is from the robot on the line through `towards`, m.
fn along_m(place: &Point2<f64>, towards: &Point2<f64>) -> f64 {
    place.coords.dot(&towards.coords.normalize())
}

/// The edge over which the robot would go down to a surface.
struct EdgeBefore {
    edge: Edge<Robot>,
    seen: bool,
}

impl EdgeBefore {
    fn nearest(&self, point: &Point<Robot>) -> Point2<f64> {
        let ahead = across(&self.edge);
        let point = point.inner.xy();
        point - ahead * self.edge.beyond_m([point.x, point.y])
    }
}

/// The back of the higher surface in front of a lower one: what is seen of the lower one begins behind it, where the
/// higher one no longer hides it.
fn edge_before(
    found: &[Sighting],
    index: usize,
    view: &View<'_>,
    config: &StairsConfig,
) -> Option<EdgeBefore> {
    let stair = &found[index].stair;
    let to = stair.reference.inner.xy();
    let reach_m = along_m(&found[index].hull.cuts(&to, &to.coords)?[0].at, &to);
    let gap_m = |other: &Sighting| {
        let [_, leaves] = other.hull.cuts(&to, &to.coords)?;
        let ends_m = along_m(&leaves.at, &to);
        let drop_m = other.stair.height_m() - stair.height_m();
        let below_m = view.height_m() - other.stair.height_m();
        let hidden_m = drop_m * ends_m / below_m.max(0.05);
        let gap_m = reach_m - ends_m;
        let near = drop_m > config.own_height && (-GAP_M..hidden_m + GAP_M).contains(&gap_m);
        near.then_some(gap_m.abs())
    };
    let before = found
        .iter()
        .filter_map(|other| Some((gap_m(other)?, other)));
    let (_, before) = before.min_by(|(a, _), (b, _)| a.total_cmp(b))?;
    let parallel = across(&before.stair.back).dot(&across(&stair.back)) > OPPOSITE;
    parallel.then_some(EdgeBefore {
        edge: before.stair.back,
        seen: before.stair.seen_ends.back > 0,
    })
}
