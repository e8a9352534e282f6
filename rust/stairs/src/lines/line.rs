//! A straight line through many segments: the sum of their moments, so that the order of summing does not matter.

use nalgebra::{Matrix2, Point2, Vector2};

/// A line in the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct StraightLine {
    /// A point on it, m.
    pub(crate) at: Point2<f64>,
    /// Its direction, length 1.
    pub(crate) along: Vector2<f64>,
}

impl StraightLine {
    /// Square to the line, to the right of its direction: from front to back where the line goes from right to left.
    pub(crate) fn across(&self) -> Vector2<f64> {
        Vector2::new(self.along.y, -self.along.x)
    }

    /// How far a point lies to the right of the line, m.
    pub(crate) fn offset_m(&self, point: &Point2<f64>) -> f64 {
        self.across().dot(&(point - self.at))
    }

    /// The point on the line that is nearest to `point`.
    pub(crate) fn nearest(&self, point: &Point2<f64>) -> Point2<f64> {
        self.at + self.along * self.along.dot(&(point - self.at))
    }
}

/// Moments of weighted segments.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct LineSum {
    weight: f64,
    places: Vector2<f64>,
    squares: Matrix2<f64>,
    along: Vector2<f64>,
}

impl LineSum {
    /// Adds a segment with its weight spread evenly over it.
    pub(crate) fn add(&mut self, [from, to]: [&Point2<f64>; 2], weight: f64) {
        let (middle, half) = (nalgebra::center(from, to).coords, (to - from) / 2.0);
        self.weight += weight;
        self.places += middle * weight;
        self.squares += (middle * middle.transpose() + half * half.transpose() / 3.0) * weight;
        self.along += (to - from) * weight;
    }

    /// Adds all that another sum holds.
    pub(crate) fn add_sum(&mut self, other: &Self) {
        self.weight += other.weight;
        self.places += other.places;
        self.squares += other.squares;
        self.along += other.along;
    }

    /// Makes all weights smaller by a factor.
    pub(crate) fn scale(&mut self, factor: f64) {
        self.weight *= factor;
        self.places *= factor;
        self.squares *= factor;
        self.along *= factor;
    }

    /// Turns every segment round.
    pub(crate) fn reverse(&mut self) {
        self.along = -self.along;
    }

    pub(crate) const fn weight(&self) -> f64 {
        self.weight
    }

    /// The line with the least squared distance from all segments; `None` without a segment of some length. Where it turns away from
    /// their mean direction by more than the angle of this cosine, they lie beside each other, and it has their mean direction.
    pub(crate) fn line(&self, agreement_needed: f64) -> Option<StraightLine> {
        let rough = self.along.try_normalize(1e-9)?;
        let mean = self.places / self.weight;
        let spread = self.squares / self.weight - mean * mean.transpose();
        let turn = 0.5 * libm::atan2(2.0 * spread.m12, spread.m11 - spread.m22);
        let along = Vector2::new(libm::cos(turn), libm::sin(turn));
        let agreement = along.dot(&rough);
        Some(StraightLine {
            at: mean.into(),
            along: if agreement.abs() > agreement_needed {
                along * agreement.signum()
            } else {
                rough
            },
        })
    }
}
