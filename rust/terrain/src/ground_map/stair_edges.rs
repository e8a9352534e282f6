//! The edges that are known: where ground of one height ends.

use geometry::{Map, Point};
use stairs::{Staircase, SureEdge};

/// The known edges.
#[derive(Debug, Clone, Default)]
pub(super) struct StairEdges(Vec<KnownEdge>);

/// A straight piece of an edge, m, and how high the ground is before and behind it, m.
#[derive(Debug, Clone, Copy)]
pub(super) struct KnownEdge {
    /// From its left end to its right one, as seen from before it.
    ends_m: [[f64; 2]; 2],
    pub(super) levels_m: [f32; 2],
}

impl KnownEdge {
    /// One that was fitted, and so much longer at both ends, m.
    fn new(edge: &SureEdge, longer_m: f64) -> Option<Self> {
        let levels_m = edge.heights_m.map(|height_m| height_m as f32);
        let [from, to]: [&Point<Map>; 2] = [&edge.edge.left, &edge.edge.right];
        let [from_m, to_m] = [from, to].map(|end| [end.inner.x, end.inner.y]);
        let length_m = geometry::distance_m(from_m, to_m);
        (length_m > 0.0).then(|| {
            let share = longer_m / length_m;
            let beyond = |from: f64, to: f64| to + share * (to - from);
            Self {
                ends_m: [
                    [beyond(to_m[0], from_m[0]), beyond(to_m[1], from_m[1])],
                    [beyond(from_m[0], to_m[0]), beyond(from_m[1], to_m[1])],
                ],
                levels_m,
            }
        })
    }

    /// Whether it lies between two places.
    pub(super) fn separates(&self, a_m: [f64; 2], b_m: [f64; 2]) -> bool {
        let [from_m, to_m] = self.ends_m;
        is_left_of(self.ends_m, a_m) != is_left_of(self.ends_m, b_m)
            && is_left_of([a_m, b_m], from_m) != is_left_of([a_m, b_m], to_m)
    }

    /// The height on the side of this edge on which a place, m, so near to it, m, lies, where it was seen as high as the other side: the edge knows
    /// better than a cell of the map where levels meet.
    pub(super) fn corrected_m(
        &self,
        (middle_m, near_m): ([f64; 2], f64),
        height_m: f32,
        within_m: f32,
    ) -> Option<f32> {
        let [from_m, to_m] = self.ends_m;
        let [this_m, other_m] = if is_left_of([from_m, to_m], middle_m) {
            [self.levels_m[1], self.levels_m[0]]
        } else {
            self.levels_m
        };
        let wrong = (height_m - other_m).abs() <= within_m && self.away_m(middle_m) <= near_m;
        wrong.then_some(this_m)
    }

    /// Whether what is seen around a place, m, so near to this edge, m, has another height than what lies on one side of it because of the edge: it
    /// may have that of either side, and what lies between.
    pub(super) fn explains(
        &self,
        (middle_m, near_m): ([f64; 2], f64),
        [there_m, here_m]: [f32; 2],
        within_m: f32,
    ) -> bool {
        let [low_m, high_m] = [f32::min, f32::max].map(|of| of(self.levels_m[0], self.levels_m[1]));
        let is_side = (self.levels_m.iter()).any(|level_m| (level_m - here_m).abs() <= within_m);
        is_side
            && (low_m - within_m..=high_m + within_m).contains(&there_m)
            && self.away_m(middle_m) <= near_m
    }

    /// How far it is from a place, m.
    fn away_m(&self, [x_m, y_m]: [f64; 2]) -> f64 {
        let [from_m, to_m] = self.ends_m;
        let [along_x, along_y] = [to_m[0] - from_m[0], to_m[1] - from_m[1]];
        let squared = along_x * along_x + along_y * along_y;
        let (off_x, off_y) = (x_m - from_m[0], y_m - from_m[1]);
        let share = ((off_x * along_x + off_y * along_y) / squared).clamp(0.0, 1.0);
        geometry::hypot(off_x - share * along_x, off_y - share * along_y)
    }
}

/// Whether a place lies to the left of who goes from one to another.
fn is_left_of([from, to]: [[f64; 2]; 2], at: [f64; 2]) -> bool {
    (to[0] - from[0]) * (at[1] - from[1]) - (to[1] - from[1]) * (at[0] - from[0]) > 0.0
}

impl StairEdges {
    /// Takes in the edges that were fitted well, of a map with cells of this size, m, each a cell longer: an edge's ends are the least sure of it.
    pub(super) fn read(&mut self, stairs: &Staircase, cell_m: f64) {
        self.0.clear();
        let edges = stairs.edges.iter();
        self.0
            .extend(edges.filter_map(|edge| KnownEdge::new(edge, cell_m)));
    }

    /// The edges that are no farther from a place than this, m.
    pub(super) fn near(&self, place_m: [f64; 2], within_m: f64) -> Vec<KnownEdge> {
        let near = |edge: &&KnownEdge| edge.away_m(place_m) <= within_m;
        self.0.iter().filter(near).copied().collect()
    }
}
