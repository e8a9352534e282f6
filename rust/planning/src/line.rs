//! A straight edge seen from above, for one who goes over it.

use geometry::{Map, Point, angle_between};
use stairs::{Edge, Sides, Stair};

/// The line of an edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Line {
    middle_m: [f64; 2],
    /// Square to the edge, in walking direction.
    ahead: [f64; 2],
    half_m: f64,
    heading_rad: f64,
}

impl Line {
    pub(crate) fn of(edge: &Edge<Map>) -> Self {
        let middle = edge.middle().inner;
        let heading_rad = edge.heading_rad();
        Self {
            middle_m: [middle.x, middle.y],
            ahead: [heading_rad.cos(), heading_rad.sin()],
            half_m: 0.5 * edge.length_m(),
            heading_rad,
        }
    }

    /// How far a place lies beyond the line, m.
    pub(crate) fn beyond_m(&self, at_m: [f64; 2]) -> f64 {
        let d = [at_m[0] - self.middle_m[0], at_m[1] - self.middle_m[1]];
        d[0] * self.ahead[0] + d[1] * self.ahead[1]
    }

    /// How far a place lies to the left of the edge's middle, m.
    pub(crate) fn offset_m(&self, at_m: [f64; 2]) -> f64 {
        let d = [at_m[0] - self.middle_m[0], at_m[1] - self.middle_m[1]];
        d[1] * self.ahead[0] - d[0] * self.ahead[1]
    }

    /// The place so far to the left of the middle and so far beyond.
    pub(crate) fn at(&self, offset_m: f64, beyond_m: f64) -> [f64; 2] {
        [
            self.middle_m[0] - offset_m * self.ahead[1] + beyond_m * self.ahead[0],
            self.middle_m[1] + offset_m * self.ahead[0] + beyond_m * self.ahead[1],
        ]
    }

    pub(crate) const fn half_m(&self) -> f64 {
        self.half_m
    }

    pub(crate) const fn heading_rad(&self) -> f64 {
        self.heading_rad
    }

    /// Difference of heading to another, rad.
    pub(crate) fn askew_rad(&self, other: &Self) -> f64 {
        angle_between(self.heading_rad, other.heading_rad).abs()
    }
}

/// The stair for one who comes from its back.
pub(crate) fn flipped(stair: &Stair<Map>) -> Stair<Map> {
    let turned = |edge: Edge<Map>| Edge {
        left: edge.right,
        right: edge.left,
    };
    Stair {
        front: turned(stair.back),
        back: turned(stair.front),
        seen_ends: Sides {
            front: stair.seen_ends.back,
            back: stair.seen_ends.front,
            left: stair.seen_ends.right,
            right: stair.seen_ends.left,
        },
        left_margin_m: stair.right_margin_m,
        right_margin_m: stair.left_margin_m,
        front_fit: stair.back_fit,
        back_fit: stair.front_fit,
        ..*stair
    }
}

/// The floor behind a stair's back edge as a stair of its own, `depth_m` deep.
pub(crate) fn ground_behind(stair: &Stair<Map>, height_m: f64, depth_m: f64) -> Stair<Map> {
    let heading_rad = stair.back.heading_rad();
    let moved = |point: Point<Map>, by_m: f64| {
        Point::new(
            point.inner.x + by_m * heading_rad.cos(),
            point.inner.y + by_m * heading_rad.sin(),
            height_m,
        )
    };
    let edge = |by_m: f64| Edge {
        left: moved(stair.back.left, by_m),
        right: moved(stair.back.right, by_m),
    };
    Stair {
        front: edge(0.0),
        back: edge(depth_m),
        reference: moved(stair.back.middle(), 0.5 * depth_m),
        seen_ends: Sides {
            front: stair.seen_ends.back,
            back: 0,
            ..stair.seen_ends
        },
        front_fit: stair.back_fit,
        back_fit: None,
        ..*stair
    }
}
