//! The front or the back of a tread: all sightings of one edge, summed.

use geometry::Outline;
use nalgebra::{Point2, Vector2};

use crate::lines::line::{LineSum, StraightLine};
use crate::{BorderTuning, StairsTuning};

/// One end of an edge.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct BorderEnd {
    // Of the ends that were seen: weight and weighted sum of the places.
    weight: f64,
    places: Vector2<f64>,
    // The outermost place that any sighting reached.
    reached: Option<Point2<f64>>,
}

impl BorderEnd {
    fn add(&mut self, place: &Point2<f64>, weight: f64, outward: &Vector2<f64>) {
        self.weight += weight;
        self.places += place.coords * weight;
        self.reach(place, outward);
    }

    fn reach(&mut self, place: &Point2<f64>, outward: &Vector2<f64>) {
        let farther = |old: &Point2<f64>| outward.dot(&(place - old)) > 0.0;
        if self.reached.as_ref().is_none_or(farther) {
            self.reached = Some(*place);
        }
    }

    fn add_end(&mut self, other: &Self, outward: &Vector2<f64>) {
        self.weight += other.weight;
        self.places += other.places;
        if let Some(place) = &other.reached {
            self.reach(place, outward);
        }
    }

    /// Where it is, of sightings of this weight in all.
    fn place(&self, all: f64, tuning: &BorderTuning) -> Option<Point2<f64>> {
        let reached = self.reached?;
        if self.weight <= 0.0 {
            return Some(reached);
        }
        let seen = Point2::from(self.places / self.weight);
        let agrees = nalgebra::distance(&seen, &reached) < tuning.agrees;
        Some(if agrees || self.weight > tuning.believed * all {
            seen
        } else {
            reached
        })
    }
}

/// How a side of a sighting counts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Weights {
    /// Supporting points of the sighting.
    pub(crate) all: f64,
    /// Supporting points where the edge was seen to end the surface, else 0.
    pub(crate) edge: f64,
    /// Supporting points where the edge's left end was seen, else 0.
    pub(crate) left: f64,
    /// Supporting points where the edge's right end was seen, else 0.
    pub(crate) right: f64,
}

/// An edge, from its right to its left end for one who goes from front to back.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Border {
    seen: LineSum,
    unseen: LineSum,
    left: BorderEnd,
    right: BorderEnd,
}

impl Border {
    pub(crate) fn new([right, left]: [&Point2<f64>; 2], weights: Weights) -> Self {
        let mut border = Self::default();
        if weights.edge > 0.0 {
            border.seen.add([right, left], weights.edge);
        } else {
            border.unseen.add([right, left], weights.all);
        }
        let to_left = left - right;
        border.left.add(left, weights.left, &to_left);
        border.right.add(right, weights.right, &-to_left);
        border
    }

    /// Adds another sum of sightings of the same edge.
    pub(crate) fn add_border(&mut self, other: &Self, tuning: &StairsTuning) {
        let to_left = self.along(tuning);
        self.seen.add_sum(&other.seen);
        self.unseen.add_sum(&other.unseen);
        self.left.add_end(&other.left, &to_left);
        self.right.add_end(&other.right, &-to_left);
    }

    /// Makes all weights smaller by a factor.
    pub(crate) fn scale(&mut self, factor: f64) {
        for sum in [&mut self.seen, &mut self.unseen] {
            sum.scale(factor);
        }
        for end in [&mut self.left, &mut self.right] {
            end.weight *= factor;
            end.places *= factor;
        }
    }

    /// Left becomes right.
    pub(crate) fn reverse(&mut self) {
        self.seen.reverse();
        self.unseen.reverse();
        std::mem::swap(&mut self.left, &mut self.right);
    }

    /// Weight of the sightings in which the edge, its left and its right end were seen to end the surface.
    pub(crate) const fn seen_weights(&self) -> [f64; 3] {
        [self.seen.weight(), self.left.weight, self.right.weight]
    }

    /// Weight of all sightings.
    pub(crate) const fn weight(&self) -> f64 {
        self.seen.weight() + self.unseen.weight()
    }

    /// Direction from front to back, square to it; nothing where nothing is known.
    pub(crate) fn across(&self, tuning: &StairsTuning) -> Vector2<f64> {
        let along = self.along(tuning);
        Vector2::new(along.y, -along.x)
    }

    /// Direction from right to left; nothing where nothing is known.
    pub(crate) fn along(&self, tuning: &StairsTuning) -> Vector2<f64> {
        let agreement = tuning.lines.agreement;
        let seen = self.seen.line(agreement);
        let line = seen.or_else(|| self.unseen.line(agreement));
        line.map_or_else(Vector2::zeros, |line| line.along)
    }

    /// The edge, right end first. Where it was never seen it is drawn outside of all of the hull, on the side that
    /// `outward` says: 1 for the back, -1 for the front. Sightings that did not see it count against it only where they go
    /// on beyond it: from near by, only what lies behind a front is in view.
    pub(crate) fn ends(
        &self,
        hull: &Outline,
        outward: f64,
        tuning: &StairsTuning,
    ) -> Option<[Point2<f64>; 2]> {
        let agreement = tuning.lines.agreement;
        let tuning = &tuning.treads.border;
        let all = self.weight();
        let mostly_seen = self.seen.weight() > tuning.believed * all;
        let goes_on = |seen: &StraightLine| {
            let unseen = self.unseen.line(agreement);
            unseen.is_some_and(|unseen| outward * seen.offset_m(&unseen.at) > tuning.agrees)
        };
        let seen = self.seen.line(agreement);
        let seen = seen.filter(|seen| mostly_seen || !goes_on(seen));
        let line = seen.or_else(|| {
            let mut line: StraightLine = self.unseen.line(agreement)?;
            let out = |p: &Point2<f64>| outward * line.offset_m(p);
            let outermost = hull.corners().iter().map(out).fold(f64::MIN, f64::max);
            line.at += line.across() * outward * outermost;
            Some(line)
        })?;
        Some([
            line.nearest(&self.right.place(all, tuning)?),
            line.nearest(&self.left.place(all, tuning)?),
        ])
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Edges across the way: one that `seen` sightings saw at 0.4 m, and where the view of `unseen` others ended.
    fn front_m(seen: u32, unseen: u32, unseen_at_m: f64, hull_from_m: f64) -> f64 {
        let at = |x_m: f64, y_m: f64| Point2::new(x_m, y_m);
        let sighting = |x_m: f64, edge: f64| {
            let weights = Weights {
                all: 100.0,
                edge,
                left: 100.0,
                right: 100.0,
            };
            Border::new([&at(x_m, -0.2), &at(x_m, 0.2)], weights)
        };
        let tuning = StairsTuning::default();
        let mut border = sighting(0.4, 12.0);
        for _ in 1..seen {
            border.add_border(&sighting(0.4, 12.0), &tuning);
        }
        for _ in 0..unseen {
            border.add_border(&sighting(unseen_at_m, 0.0), &tuning);
        }
        let corners = [at(hull_from_m, 0.0), at(0.5, -0.2), at(0.5, 0.2)];
        let [right, left] = border
            .ends(&Outline::hull(&corners).unwrap(), -1.0, &tuning)
            .unwrap();
        nalgebra::center(&right, &left).x
    }

    proptest! {
        #[test]
        fn sightings_of_what_lies_behind_a_front_leave_it_where_it_was_seen(
            seen in 1..20u32, unseen in 0..200u32, at_m in 0.4..0.48f64, hull_from_m in 0.25..0.4f64,
        ) {
            prop_assert!((front_m(seen, unseen, at_m, hull_from_m) - 0.4).abs() < 1e-9);
        }

        #[test]
        fn sightings_that_go_on_beyond_a_front_that_few_saw_move_it_outside_of_all(
            unseen in 4..200u32, at_m in 0.3..0.375f64, hull_from_m in 0.25..0.3f64,
        ) {
            prop_assert!((front_m(1, unseen, at_m, hull_from_m) - hull_from_m).abs() < 1e-9);
        }
    }
}
