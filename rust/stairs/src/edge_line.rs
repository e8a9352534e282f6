//! The line of an edge seen from above, for one who goes over it.

use geometry::angle_between;

/// The line of an edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeLine {
    middle_m: [f64; 2],
    /// Square to the edge, in walking direction.
    ahead: [f64; 2],
    half_m: f64,
    /// Heading square to the edge, from front to back, rad.
    pub heading_rad: f64,
}

impl EdgeLine {
    /// The line of an edge of this length about its middle, for one who goes over it in this direction.
    #[inline]
    pub(crate) fn new(middle_m: [f64; 2], heading_rad: f64, length_m: f64) -> Self {
        Self {
            middle_m,
            ahead: [heading_rad.cos(), heading_rad.sin()],
            half_m: 0.5 * length_m,
            heading_rad,
        }
    }

    /// Half the edge's length, m.
    #[inline]
    pub const fn half_m(&self) -> f64 {
        self.half_m
    }

    /// How far a place lies beyond the line, m; negative in front of it.
    #[inline]
    pub fn beyond_m(&self, at_m: [f64; 2]) -> f64 {
        let d = [at_m[0] - self.middle_m[0], at_m[1] - self.middle_m[1]];
        d[0] * self.ahead[0] + d[1] * self.ahead[1]
    }

    /// How far a place lies to the left of the edge's middle, m.
    #[inline]
    pub fn offset_m(&self, at_m: [f64; 2]) -> f64 {
        let d = [at_m[0] - self.middle_m[0], at_m[1] - self.middle_m[1]];
        d[1] * self.ahead[0] - d[0] * self.ahead[1]
    }

    /// The place so far to the left of the middle and so far beyond.
    pub fn at(&self, offset_m: f64, beyond_m: f64) -> [f64; 2] {
        [
            self.middle_m[0] - offset_m * self.ahead[1] + beyond_m * self.ahead[0],
            self.middle_m[1] + offset_m * self.ahead[0] + beyond_m * self.ahead[1],
        ]
    }

    /// Difference of heading to another, rad.
    pub fn askew_rad(&self, other: &Self) -> f64 {
        angle_between(self.heading_rad, other.heading_rad).abs()
    }
}
