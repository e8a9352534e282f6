//! The edges of stairs that are known: where ground of one height ends.

use geometry::{Map, Point};
use stairs::{Stair, Staircase};

use crate::StairOutline;

/// The known edges of all stairs, and how high those are.
#[derive(Debug, Clone, Default)]
pub(super) struct StairEdges {
    edges: Vec<KnownEdge>,
    levels: Vec<(StairOutline, f32)>,
}

/// A straight piece of an edge, m.
#[derive(Debug, Clone, Copy)]
pub(super) struct KnownEdge {
    from_m: [f64; 2],
    to_m: [f64; 2],
    /// Whether it was fitted to the disparities; else it is the hull's.
    fitted: bool,
}

impl KnownEdge {
    /// Between two places, and so much longer at both ends, m.
    fn new([from, to]: [&Point<Map>; 2], longer_m: f64, fitted: bool) -> Option<Self> {
        let [from_m, to_m] = [from, to].map(|end| [end.inner.x, end.inner.y]);
        let length_m = geometry::distance_m(from_m, to_m);
        (length_m > 0.0).then(|| {
            let share = longer_m / length_m;
            let beyond = |from: f64, to: f64| to + share * (to - from);
            Self {
                from_m: [beyond(to_m[0], from_m[0]), beyond(to_m[1], from_m[1])],
                to_m: [beyond(from_m[0], to_m[0]), beyond(from_m[1], to_m[1])],
                fitted,
            }
        })
    }

    /// Whether it lies between two places.
    pub(super) fn separates(&self, a_m: [f64; 2], b_m: [f64; 2]) -> bool {
        let side = |from: [f64; 2], to: [f64; 2], at: [f64; 2]| {
            (to[0] - from[0]) * (at[1] - from[1]) - (to[1] - from[1]) * (at[0] - from[0]) > 0.0
        };
        let Self { from_m, to_m, .. } = *self;
        side(from_m, to_m, a_m) != side(from_m, to_m, b_m)
            && side(a_m, b_m, from_m) != side(a_m, b_m, to_m)
    }

    /// Whether all of it is no farther from another edge than this, m.
    fn runs_along(&self, other: &Self, within_m: f64) -> bool {
        let middle_m = [0, 1].map(|axis: usize| f64::midpoint(self.from_m[axis], self.to_m[axis]));
        let places_m = [self.from_m, middle_m, self.to_m];
        places_m
            .iter()
            .all(|&place_m| other.away_m(place_m) <= within_m)
    }

    /// How far it is from a place, m.
    fn away_m(&self, [x_m, y_m]: [f64; 2]) -> f64 {
        let [along_x, along_y] = [self.to_m[0] - self.from_m[0], self.to_m[1] - self.from_m[1]];
        let squared = along_x * along_x + along_y * along_y;
        let (off_x, off_y) = (x_m - self.from_m[0], y_m - self.from_m[1]);
        let share = ((off_x * along_x + off_y * along_y) / squared).clamp(0.0, 1.0);
        geometry::hypot(off_x - share * along_x, off_y - share * along_y)
    }
}

impl StairEdges {
    /// Takes in the edges that were fitted, and the sides that were seen to be ends, of a map with cells of this size, m.
    pub(super) fn read(&mut self, stairs: &Staircase, cell_m: f64) {
        self.edges.clear();
        self.levels.clear();
        for stair in &stairs.stairs {
            let known = known(stair, cell_m);
            self.edges.extend(known.into_iter().flatten());
            self.levels
                .push((StairOutline::of(stair), stair.height_m() as f32));
        }
    }

    /// Heights of the stairs that are no farther from a place than this, m.
    pub(super) fn levels_near(&self, place_m: [f64; 2], within_m: f64) -> Vec<f32> {
        let near = |(outline, _): &&(StairOutline, f32)| outline.outside_m(place_m) <= within_m;
        let near = self.levels.iter().filter(near);
        near.map(|&(_, height_m)| height_m).collect()
    }

    /// The edges that are no farther from a place than this, m. A hull's that runs along one that was fitted is that again, a little off.
    pub(super) fn near(&self, place_m: [f64; 2], within_m: f64) -> Vec<KnownEdge> {
        let near = |edge: &&KnownEdge| edge.away_m(place_m) <= within_m;
        let mut near: Vec<KnownEdge> = self.edges.iter().filter(near).copied().collect();
        let fitted: Vec<KnownEdge> = near.iter().filter(|edge| edge.fitted).copied().collect();
        let same = |edge: &KnownEdge| {
            fitted
                .iter()
                .any(|fitted| edge.runs_along(fitted, 0.5 * within_m))
        };
        near.retain(|edge| edge.fitted || !same(edge));
        near
    }
}

/// The known edges of a stair, each a cell longer: an edge's ends are the least sure of it.
fn known(stair: &Stair<Map>, cell_m: f64) -> [Option<KnownEdge>; 4] {
    let Stair { front, back, .. } = stair;
    let ends = &stair.seen_ends;
    let edge = |fitted: bool, seen: usize, places: [&Point<Map>; 2]| {
        (fitted || seen > 0).then(|| KnownEdge::new(places, cell_m, fitted))?
    };
    let [front_fitted, back_fitted] = [stair.front_fit, stair.back_fit].map(|fit| fit.is_some());
    [
        edge(front_fitted, ends.front, [&front.left, &front.right]),
        edge(back_fitted, ends.back, [&back.left, &back.right]),
        edge(false, ends.left, [&front.left, &back.left]),
        edge(false, ends.right, [&front.right, &back.right]),
    ]
}
