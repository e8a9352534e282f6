//! The outline of a stair, seen from above.

use geometry::Map;
use stairs::Stair;

/// A side shorter than this has no direction, m: a rounding guard.
const NO_SIDE_M: f64 = 1e-6;

/// A stair seen from above.
#[derive(Debug, Clone, Copy)]
pub struct StairOutline {
    /// Counter-clockwise.
    corners_m: [[f64; 2]; 4],
    /// From each corner to the next, and how far that is, m.
    sides: [([f64; 2], f64); 4],
}

impl StairOutline {
    /// The outline of a stair.
    pub fn of(stair: &Stair<Map>) -> Self {
        let corners = [
            stair.front.right,
            stair.back.right,
            stair.back.left,
            stair.front.left,
        ];
        let corners_m = corners.map(|corner| [corner.inner.x, corner.inner.y]);
        let sides = std::array::from_fn(|i| {
            let [from, to] = [corners_m[i], corners_m[(i + 1) % 4]];
            let side: [f64; 2] = [to[0] - from[0], to[1] - from[1]];
            (side, geometry::hypot(side[0], side[1]))
        });
        Self { corners_m, sides }
    }

    /// Least and greatest coordinates, m.
    pub(crate) fn bounds_m(&self) -> ([f64; 2], [f64; 2]) {
        let fold = |axis: usize, pick: fn(f64, f64) -> f64| {
            let values = self.corners_m.iter().map(|corner| corner[axis]);
            values.reduce(pick).unwrap_or(0.0)
        };
        (
            [fold(0, f64::min), fold(1, f64::min)],
            [fold(0, f64::max), fold(1, f64::max)],
        )
    }

    /// How far a place lies beyond the side that it is furthest beyond, m; negative inside.
    pub fn outside_m(&self, [x, y]: [f64; 2]) -> f64 {
        let mut furthest = f64::NEG_INFINITY;
        for (from, (side, length)) in self.corners_m.iter().zip(self.sides) {
            if length > NO_SIDE_M {
                let beyond = ((x - from[0]) * side[1] - (y - from[1]) * side[0]) / length;
                furthest = furthest.max(beyond);
            }
        }
        furthest
    }

    /// Whether a corner of another outline lies in this one, or no further from it than this, m.
    pub(crate) fn has_corner_near(&self, other: &Self, near_m: f64) -> bool {
        other
            .corners_m
            .iter()
            .any(|&corner| self.outside_m(corner) <= near_m)
    }
}
