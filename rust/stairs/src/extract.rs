//! Stairs in one frame (003, section IV.B).

use geometry::{Outline, Point, Robot};
use nalgebra::{Point2, Vector2};
use segmentation::Planes;
use sensing::Intrinsics;

use crate::boundary::side;
use crate::outer_points::{OuterPoints, Rows};
use crate::shared_edges::share_edges;
use crate::view::{Shows, View};
use crate::{Edge, Sides, Stair, StairsConfig};

/// Least fringe of a boundary that does not split a side, m.
const FRINGE_M: f64 = 0.008;
/// Share of a side's places that must show that the surface ends there.
const ENDS: f64 = 0.5;
/// Share of a stair's places that must show the surface, of those that show anything.
const SOLID: f64 = 0.6;
/// Front and back may differ by this much in heading before one of them is doubted, cosine.
pub(crate) const OPPOSITE: f64 = 0.82;
/// What an edge counts that was seen from one of its sides only: fringes move it by centimetres.
const ONE_SIDED: usize = 8;

/// One stair as one frame shows it.
#[derive(Debug, Clone)]
pub(crate) struct Sighting {
    /// The stair; its margins are zero.
    pub(crate) stair: Stair<Robot>,
    /// Its whole boundary, robot frame, m.
    pub(crate) hull: Outline,
    /// How wide its fringes are, m.
    pub(crate) fringe_m: f64,
    /// Whether it is at the robot's own height, with no other surface between.
    pub(crate) own_level: bool,
    /// Whether it is large enough to be a stair by itself.
    pub(crate) large_enough: bool,
}

/// Finds stairs in planes. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(crate) struct Extraction {
    outer_points: OuterPoints,
    /// What the last frame showed: level surfaces that may be stairs, and those that the robot may stand on.
    pub(crate) found: Vec<Sighting>,
}

impl Extraction {
    /// Finds the level surfaces of a frame.
    pub(crate) fn read(&mut self, planes: &Planes, camera: Intrinsics, config: &StairsConfig) {
        let view = View::new(planes, camera);
        self.outer_points.read(planes, camera.width);
        self.found.clear();
        for region in 0..planes.regions.len() {
            let sighting = self.sighting(region, &view);
            self.found.extend(sighting);
        }
        let found = &mut self.found;
        for i in 0..found.len() {
            found[i].own_level = is_own_level(found, i, config);
        }
        share_edges(found, &view, config);
        for sighting in found {
            let stair = &sighting.stair;
            let shortest_m = stair.front.length_m().min(stair.back.length_m());
            sighting.large_enough =
                shortest_m >= config.min_edge && stair.depth_m() >= config.min_depth;
        }
    }

    fn sighting(&mut self, index: usize, view: &View<'_>) -> Option<Sighting> {
        let region = view.region(index);
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
        let mut smooth = |edge: &mut Edge<Robot>, rows| {
            let ends = [&edge.right, &edge.left].map(|end| end.inner.xy());
            let smooth = self
                .outer_points
                .through(view, (index, rows), (ends, height_m), fringe_m);
            if let Some(ends) = smooth {
                *edge = level_edge(ends, height_m);
            }
        };
        if stair.seen_ends.front > 0 {
            smooth(&mut stair.front, Rows::Lowest);
        }
        if stair.seen_ends.back > 0 {
            smooth(&mut stair.back, Rows::Highest);
        }
        Some(Sighting {
            stair,
            hull: hull.clone(),
            fringe_m,
            own_level: false,
            large_enough: false,
        })
    }
}

/// Right and left end at a height.
pub(crate) fn level_edge([right, left]: [Point2<f64>; 2], z_m: f64) -> Edge<Robot> {
    let at = |p: Point2<f64>| Point::new(p.x, p.y, z_m);
    Edge {
        left: at(left),
        right: at(right),
    }
}

/// Where front and back point different ways, the shorter is drawn anew: along the longer, around the hull.
fn square(front: Edge<Robot>, back: Edge<Robot>, hull: &Outline) -> (Edge<Robot>, Edge<Robot>) {
    if front.across().dot(&back.across()) > OPPOSITE {
        return (front, back);
    }
    let parallel = |edge: &Edge<Robot>, outward: f64| {
        let reach = hull
            .corners()
            .iter()
            .map(|p| outward * edge.beyond_m([p.x, p.y]));
        edge.shifted(outward * reach.fold(0.0, f64::max))
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
        beyond.lower + beyond.higher >= ENDS
    };
    let front = view.beyond([front_left, front_right], &-stair.front.across());
    let back = ends([back_left, back_right], stair.back.across());
    Sides {
        front: usize::from(front.lower >= ENDS) * stair.support.div_ceil(ONE_SIDED),
        back: usize::from(back) * stair.support.div_ceil(ONE_SIDED),
        left: usize::from(ends([front_left, back_left], left)) * stair.support,
        right: usize::from(ends([front_right, back_right], -left)) * stair.support,
    }
}

/// Whether the surface is at the robot's own height, with nothing of another height on the way to it.
fn is_own_level(found: &[Sighting], index: usize, config: &StairsConfig) -> bool {
    let stair = &found[index].stair;
    let own = |stair: &Stair<Robot>| stair.height_m().abs() < config.own_height;
    let to = stair.reference.inner.xy();
    let from_robot_m = |place: &Point2<f64>| place.coords.dot(&to.coords.normalize());
    let cuts_m = |hull: &Outline| {
        let cuts = hull.cuts(&to, &to.coords)?;
        Some(cuts.map(|cut| from_robot_m(&cut.at)))
    };
    let reach_m = cuts_m(&found[index].hull).map_or(0.0, |[enters_m, _]| enters_m);
    let between = |other: &Sighting| {
        cuts_m(&other.hull).is_some_and(|[enters_m, leaves_m]| {
            let deep = leaves_m - enters_m > config.min_depth / 2.0;
            let before = enters_m > 0.0 && leaves_m < reach_m + 2.0 * other.fringe_m;
            deep && before && !own(&other.stair)
        })
    };
    own(stair) && !found.iter().any(between)
}
