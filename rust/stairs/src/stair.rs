//! What a stair is (003, section IV.A, Fig. 5), and the product of the recognizer.

use geometry::{Map, Point, Pose, Robot};
use nalgebra::{Point2, Vector2};

use crate::{PlacesTuning, edge_line::EdgeLine, lines::line::StraightLine};

/// A straight edge of a level surface. Its ends are left and right for one who goes over it from front to back.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge<Frame> {
    /// Left end, at the height of the surface that the edge bounds.
    pub left: Point<Frame>,
    /// Right end, at the height of the surface that the edge bounds.
    pub right: Point<Frame>,
}

/// How surely an edge was found by fitting a step to the disparities.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeFit {
    /// Frames whose fits were joined.
    pub frames: u32,
    /// Standard deviation of the edge's place across itself, m.
    pub place_sigma_m: f64,
    /// Standard deviation of its heading, rad.
    pub heading_sigma_rad: f64,
}

/// How much of the support saw a side of a stair end there, in points. 0: the side is only where the view ended, or where
/// something stood before it; the stair may go on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Sides {
    /// Front edge.
    pub front: usize,
    /// Back edge.
    pub back: usize,
    /// Left ends of the edges.
    pub left: usize,
    /// Right ends of the edges.
    pub right: usize,
}

/// One surface to step on: a step of a staircase, a sill, a landing, or the lower ground at the foot of a staircase.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stair<Frame> {
    /// Edge that is crossed onto it: the one on the robot's side.
    pub front: Edge<Frame>,
    /// Edge that is crossed off it; only the end of the view where `seen_ends.back` is 0 and `back_fit` is `None`.
    pub back: Edge<Frame>,
    /// Mean of the supporting points; its z is the stair's height.
    pub reference: Point<Frame>,
    /// Room to the left of both edges, m.
    pub left_margin_m: f64,
    /// Room to the right of both edges, m.
    pub right_margin_m: f64,
    /// Supporting points, of all frames that still count.
    pub support: usize,
    /// Which sides were seen to be its own ends.
    pub seen_ends: Sides,
    /// How surely the front edge was found; `None` when it is only the hull's.
    pub front_fit: Option<EdgeFit>,
    /// How surely the back edge was found; `None` when it is only the hull's.
    pub back_fit: Option<EdgeFit>,
    /// From how near it was seen: the least distance of its front edge's middle, m. From afar treads run into each other.
    pub seen_from_m: f64,
    /// Steps taken since it was last seen.
    pub steps_ago: u32,
}

/// The product: the stairs that are seen or remembered, nearest first, in the map.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Staircase {
    /// The stairs; no two overlap.
    pub stairs: Vec<Stair<Map>>,
    /// Frames merged since the robot last stepped.
    pub frames: u32,
    /// Every edge that was fitted well, whatever became of the stairs beside it.
    pub edges: Vec<SureEdge>,
}

/// An edge that was fitted well: where ground of one level ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SureEdge {
    /// As far as it was ever fitted.
    pub edge: Edge<Map>,
    /// Heights before and behind it, m.
    pub heights_m: [f64; 2],
}

impl<F> Edge<F> {
    /// Its middle.
    pub fn middle(&self) -> Point<F> {
        Point::wrap(nalgebra::center(&self.left.inner, &self.right.inner))
    }

    /// Its middle in the plane, m.
    #[inline]
    pub fn middle_m(&self) -> [f64; 2] {
        self.middle().inner.xy().into()
    }

    /// Its length in the plane, m.
    pub fn length_m(&self) -> f64 {
        (self.left.inner - self.right.inner).xy().norm()
    }

    /// Heading square to it, from front to back, rad.
    pub fn heading_rad(&self) -> f64 {
        let along = self.left.inner - self.right.inner;
        libm::atan2(-along.x, along.y)
    }

    /// Its line seen from above, for one who goes over it.
    #[inline]
    pub fn as_line(&self) -> EdgeLine {
        EdgeLine::new(self.middle_m(), self.heading_rad(), self.length_m())
    }

    /// How far a place lies beyond the edge, m; negative in front of it.
    pub fn beyond_m(&self, at_m: [f64; 2]) -> f64 {
        self.as_line().beyond_m(at_m)
    }

    /// How far to the left of the edge's middle a place lies, m.
    pub fn aside_m(&self, at_m: [f64; 2]) -> f64 {
        self.as_line().offset_m(at_m)
    }

    /// Where one crosses its line who goes straight on from a place, square to it, m.
    pub fn straight_on_m(&self, [x_m, y_m]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = libm::sincos(self.heading_rad());
        let away_m = -self.beyond_m([x_m, y_m]);
        [x_m + cos * away_m, y_m + sin * away_m]
    }

    /// The line through it, from right to left; `None` where it has no length.
    pub(crate) fn line(&self) -> Option<StraightLine> {
        let (right, left) = (self.right.inner.xy(), self.left.inner.xy());
        Some(StraightLine {
            at: right,
            along: (left - right).try_normalize(1e-9)?,
        })
    }

    /// Direction square to it, from front to back, length 1.
    pub(crate) fn across(&self) -> Vector2<f64> {
        let (sin, cos) = libm::sincos(self.heading_rad());
        Vector2::new(cos, sin)
    }

    /// This edge at another height, m.
    pub(crate) fn at_height(&self, height_m: f64) -> Self {
        let at = |end: &Point<F>| Point::new(end.inner.x, end.inner.y, height_m);
        Self {
            left: at(&self.left),
            right: at(&self.right),
        }
    }

    /// This edge on a line.
    pub(crate) fn onto(&self, line: &StraightLine) -> Self {
        let at = |end: &Point<F>| {
            let place = line.nearest(&end.inner.xy());
            Point::new(place.x, place.y, end.inner.z)
        };
        Self {
            left: at(&self.left),
            right: at(&self.right),
        }
    }

    /// This edge for one who crosses it the other way.
    pub(crate) const fn reversed(&self) -> Self {
        Self {
            left: self.right,
            right: self.left,
        }
    }

    /// This edge, farther back, m.
    pub(crate) fn shifted(&self, back_m: f64) -> Self {
        let shift = (self.across() * back_m).push(0.0);
        Self {
            left: Point::wrap(self.left.inner + shift),
            right: Point::wrap(self.right.inner + shift),
        }
    }

    /// This edge in another frame.
    #[must_use]
    pub fn transformed<T>(&self, target_from_frame: &Pose<T, F>) -> Edge<T> {
        Edge {
            left: *target_from_frame * self.left,
            right: *target_from_frame * self.right,
        }
    }
}

/// A level edge from its right to its left end, at a height.
pub(crate) fn level_edge([right, left]: [Point2<f64>; 2], z_m: f64) -> Edge<Robot> {
    let at = |p: Point2<f64>| Point::new(p.x, p.y, z_m);
    Edge {
        left: at(left),
        right: at(right),
    }
}

impl Stair<Robot> {
    /// A stair as one frame shows it: no margins, no end seen for certain, no edge fitted.
    pub(crate) fn seen(
        front: Edge<Robot>,
        back: Edge<Robot>,
        reference: Point<Robot>,
        support: usize,
    ) -> Self {
        Self {
            front,
            back,
            reference,
            left_margin_m: 0.0,
            right_margin_m: 0.0,
            support,
            seen_ends: Sides::default(),
            front_fit: None,
            back_fit: None,
            seen_from_m: front.middle().inner.coords.xy().norm(),
            steps_ago: 0,
        }
    }
}

impl<F> Stair<F> {
    /// Height in its frame, m.
    pub fn height_m(&self) -> f64 {
        self.reference.inner.z
    }

    /// Depth from front to back through the reference point, m (003: `width`).
    pub fn depth_m(&self) -> f64 {
        let at = [self.reference.inner.x, self.reference.inner.y];
        self.front.beyond_m(at).abs() + self.back.beyond_m(at).abs()
    }

    /// Room to stand on beyond the left and beyond the right ends of its edges, m: the margins, but none where it was seen to
    /// end. A margin reaches as far as anything that was ever taken for this surface; in a first, tilted look that may be a lot.
    pub fn room_beside_m(&self) -> [f64; 2] {
        let ends = &self.seen_ends;
        [
            (self.left_margin_m, ends.left),
            (self.right_margin_m, ends.right),
        ]
        .map(|(margin_m, seen)| if seen > 0 { 0.0 } else { margin_m })
    }

    /// A square pattern of places inside.
    pub(crate) fn places(&self, tuning: &PlacesTuning) -> impl Iterator<Item = Point<F>> {
        let PlacesTuning {
            each_way,
            first,
            apart,
        } = *tuning;
        let share = move |i: usize| first + apart * i as f64;
        (0..each_way * each_way).map(move |i| {
            let (across, along) = (share(i / each_way), share(i % each_way));
            let on = |edge: &Edge<F>| edge.right.inner.lerp(&edge.left.inner, along);
            Point::wrap(on(&self.front).lerp(&on(&self.back), across))
        })
    }

    /// This stair in another frame.
    #[must_use]
    pub fn transformed<T>(&self, target_from_frame: &Pose<T, F>) -> Stair<T> {
        Stair {
            front: self.front.transformed(target_from_frame),
            back: self.back.transformed(target_from_frame),
            reference: *target_from_frame * self.reference,
            left_margin_m: self.left_margin_m,
            right_margin_m: self.right_margin_m,
            support: self.support,
            seen_ends: self.seen_ends,
            front_fit: self.front_fit,
            back_fit: self.back_fit,
            seen_from_m: self.seen_from_m,
            steps_ago: self.steps_ago,
        }
    }
}
