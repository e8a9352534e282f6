//! A stair under construction: sums of all that was seen of it, in the map.

use geometry::{Map, Outline, Point, Pose, Robot};
use nalgebra::{Point2, Vector3};

use crate::frame::extract::StairSighting;
use crate::treads::aspect::{Aspect, Aspects};
use crate::treads::border::{Border, Weights};
use crate::{Edge, Sides, Stair, StairsTuning};

/// Sums over the sightings of one tread. Sums commute: the order of sightings does not matter.
#[derive(Debug, Clone)]
pub(crate) struct Tread {
    hull: Outline,
    aspects: Aspects,
    weight: f64,
    reference: Vector3<f64>,
    /// Sightings that it is worth.
    pub(crate) worth: f64,
    /// Sightings in all.
    pub(crate) sightings: u32,
    /// From how near it was seen, m.
    seen_from_m: f64,
    /// Steps since the last of them.
    pub(crate) steps_ago: u32,
    /// Frames in a row in which something lower was seen through it, or a level surface over it.
    pub(crate) contradicted: u32,
    // What the sums come to, with the outline between the edges' ends.
    shape: Option<(Stair<Map>, Outline)>,
}

impl Tread {
    pub(crate) fn new(
        sighting: &StairSighting,
        map_from_robot: &Pose<Map, Robot>,
        tuning: &StairsTuning,
    ) -> Option<Self> {
        let stair = sighting.stair.transformed(map_from_robot);
        let corners: Vec<_> = sighting
            .hull
            .corners()
            .iter()
            .map(|p| in_map(p, map_from_robot))
            .collect();
        let weight = stair.support as f64;
        let seen = &stair.seen_ends;
        // Where an edge ends is known no better than which way it runs.
        let surest = seen.front.max(seen.back);
        let border = |edge: &Edge<Map>, seen_edge: usize| {
            let [right, left] = [&edge.right, &edge.left].map(|p| p.inner.xy());
            let weights = Weights {
                all: weight,
                edge: seen_edge as f64,
                left: seen.left.min(surest) as f64,
                right: seen.right.min(surest) as f64,
            };
            Border::new([&right, &left], weights)
        };
        let mut tread = Self {
            hull: Outline::hull(&corners).ok()?,
            aspects: Aspects::new(
                border(&stair.front, seen.front),
                border(&stair.back, seen.back),
            ),
            weight,
            reference: stair.reference.inner.coords * weight,
            worth: 1.0,
            sightings: 1,
            seen_from_m: stair.seen_from_m,
            steps_ago: 0,
            contradicted: 0,
            shape: None,
        };
        tread.shape(tuning);
        Some(tread)
    }

    /// Adds another tread that is the same one.
    pub(crate) fn add(&mut self, other: &Self, tuning: &StairsTuning) {
        self.aspects.add(&other.aspects, tuning);
        let corners: Vec<_> = [&self.hull, &other.hull]
            .iter()
            .flat_map(|hull| hull.corners())
            .copied()
            .collect();
        if let Ok(hull) = Outline::hull(&corners) {
            self.hull = hull;
        }
        self.weight += other.weight;
        self.reference += other.reference;
        self.worth += other.worth;
        self.sightings = self.sightings.saturating_add(other.sightings);
        self.seen_from_m = self.seen_from_m.min(other.seen_from_m);
        self.steps_ago = self.steps_ago.min(other.steps_ago);
        self.contradicted = 0;
        self.shape(tuning);
    }

    /// The robot stepped: what is known is remembered, and counts less against what will be seen.
    pub(crate) fn step(&mut self, tuning: &StairsTuning) {
        let remembered = tuning.treads.remembered_sightings;
        self.steps_ago = self.steps_ago.saturating_add(1);
        let factor = remembered / self.worth;
        if factor < 1.0 {
            self.aspects.scale(factor);
            self.weight *= factor;
            self.reference *= factor;
            self.worth = remembered;
        }
        self.shape(tuning);
    }

    /// Makes the side on which the robot is the front.
    pub(crate) fn face(&mut self, robot: &Point2<f64>, tuning: &StairsTuning) {
        if self.aspects.face(&self.hull, robot, tuning) {
            self.shape(tuning);
        }
    }

    /// Mean of all supporting points, m.
    pub(crate) fn middle(&self) -> Point2<f64> {
        (self.reference / self.weight).xy().into()
    }

    pub(crate) fn height_m(&self) -> f64 {
        self.reference.z / self.weight
    }

    /// The stair as far as it is known.
    pub(crate) fn stair(&self) -> Option<Stair<Map>> {
        self.shape.as_ref().map(|(stair, _)| *stair)
    }

    /// The stair's outline between the ends of its edges.
    pub(crate) fn outline(&self) -> Option<&Outline> {
        self.shape.as_ref().map(|(_, outline)| outline)
    }

    fn shape(&mut self, tuning: &StairsTuning) {
        self.shape = self
            .sum(tuning)
            .and_then(|stair| Some((stair, quadrangle(&stair)?)));
    }

    /// The smallest quadrangle with the directions of the edges around all sightings, but no larger than the ends that
    /// were seen, with the margins that the hull has beyond it.
    fn sum(&self, tuning: &StairsTuning) -> Option<Stair<Map>> {
        let reference = self.reference / self.weight;
        let Aspect {
            front: before,
            back: behind,
            ..
        } = self.aspects.present();
        let [front, back] = [
            before.ends(&self.hull, -1.0, tuning)?,
            behind.ends(&self.hull, 1.0, tuning)?,
        ];
        let along = before.along(tuning);
        let span = |p: &Point2<f64>| along.dot(&p.coords);
        let corners = self.hull.corners().iter().map(span);
        let (least, most) = corners.fold((f64::MAX, f64::MIN), |(a, b), s| (a.min(s), b.max(s)));
        let left_margin_m = (most - span(&front[1]).max(span(&back[1]))).max(0.0);
        let right_margin_m = (span(&front[0]).min(span(&back[0])) - least).max(0.0);
        let at = |p: &Point2<f64>| Point::new(p.x, p.y, reference.z);
        let edge = |[right, left]: [Point2<f64>; 2]| Edge {
            left: at(&left),
            right: at(&right),
        };
        let ([front_seen, ..], [back_seen, left_seen, right_seen]) =
            (before.seen_weights(), behind.seen_weights());
        let [_, left_too, right_too] = before.seen_weights();
        Some(Stair {
            front: edge(front),
            back: edge(back),
            reference: Point::wrap(reference.into()),
            left_margin_m,
            right_margin_m,
            support: self.weight.round() as usize,
            seen_ends: Sides {
                front: front_seen.ceil() as usize,
                back: back_seen.ceil() as usize,
                left: left_seen.max(left_too).ceil() as usize,
                right: right_seen.max(right_too).ceil() as usize,
            },
            front_fit: None,
            back_fit: None,
            seen_from_m: self.seen_from_m,
            steps_ago: self.steps_ago,
        })
    }
}

fn in_map(place: &Point2<f64>, map_from_robot: &Pose<Map, Robot>) -> Point2<f64> {
    (*map_from_robot * Point::<Robot>::new(place.x, place.y, 0.0))
        .inner
        .xy()
}

/// The outline of a stair between its edges' ends.
fn quadrangle<F>(stair: &Stair<F>) -> Option<Outline> {
    let corners =
        [&stair.front, &stair.back].map(|edge| [edge.left.inner.xy(), edge.right.inner.xy()]);
    Outline::hull(corners.as_flattened()).ok()
}
