//! Convex outlines on the ground: hulls, areas, containment, overlap. The one place that calls parry in the plane.

use nalgebra::{Point2, Vector2};
use parry2d_f64::math::{Pose, Vector};
use parry2d_f64::query::distance;
use parry2d_f64::shape::{ConvexPolygon, Segment};
use parry2d_f64::transformation::convex_hull;

/// Why no outline could be made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum OutlineError {
    /// Fewer than three points that are not on one line.
    #[error("an outline needs three points that are not on one line")]
    Degenerate,
}

/// A convex polygon, corners counter-clockwise, metres.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    corners: Vec<Point2<f64>>,
}

/// Where a line cuts the outline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cut {
    /// The edge from this corner to the next is cut.
    pub edge: usize,
    /// The place, m.
    pub at: Point2<f64>,
}

impl Outline {
    /// The smallest convex polygon around the points.
    pub fn hull(points: &[Point2<f64>]) -> Result<Self, OutlineError> {
        if points.len() < 3 {
            return Err(OutlineError::Degenerate);
        }
        let input: Vec<_> = points.iter().map(|p| Vector::new(p.x, p.y)).collect();
        let corners: Vec<_> = convex_hull(&input)
            .iter()
            .map(|p| Point2::new(p.x, p.y))
            .collect();
        let outline = Self { corners };
        if outline.corners.len() < 3 || outline.area_m2() <= 0.0 {
            return Err(OutlineError::Degenerate);
        }
        Ok(outline)
    }

    /// Corners, counter-clockwise, metres.
    pub fn corners(&self) -> &[Point2<f64>] {
        &self.corners
    }

    /// Pairs of neighbouring corners, counter-clockwise.
    pub fn edges(&self) -> impl Iterator<Item = (Point2<f64>, Point2<f64>)> {
        let n = self.corners.len();
        (0..n).map(move |i| (self.corners[i], self.corners[(i + 1) % n]))
    }

    /// Area, square metres.
    pub fn area_m2(&self) -> f64 {
        self.edges()
            .map(|(a, b)| a.x * b.y - b.x * a.y)
            .sum::<f64>()
            / 2.0
    }

    /// Area that two outlines have in common, square metres: one is cut off along each edge of the other. (parry's own
    /// intersection is wrong for outlines that share a corner.)
    pub fn shared_area_m2(&self, other: &Self) -> f64 {
        let mut shared = self.corners.clone();
        for (a, b) in other.edges() {
            let side = b - a;
            shared = cut_off(&shared, &a, &Vector2::new(-side.y, side.x));
        }
        Self { corners: shared }.area_m2().max(0.0)
    }

    /// The part on that side of the line through `point` to which `inward` points.
    pub fn cut_off(
        &self,
        point: &Point2<f64>,
        inward: &Vector2<f64>,
    ) -> Result<Self, OutlineError> {
        Self::hull(&cut_off(&self.corners, point, inward))
    }

    /// Where the line through `point` in this direction enters and leaves the outline; `None` when it misses it.
    pub fn cuts(&self, point: &Point2<f64>, direction: &Vector2<f64>) -> Option<[Cut; 2]> {
        let side = |corner: &Point2<f64>| direction.perp(&(corner - point));
        let (mut enters, mut leaves) = (None, None);
        for (edge, (a, b)) in self.edges().enumerate() {
            let (from, to) = (side(&a), side(&b));
            if (from > 0.0) == (to > 0.0) {
                continue;
            }
            let at = a + (b - a) * (from / (from - to));
            let cut = Some(Cut { edge, at });
            // Counter-clockwise: the line enters over an edge that goes from its left to its right.
            if from > 0.0 {
                enters = cut;
            } else {
                leaves = cut;
            }
        }
        Some([enters?, leaves?])
    }

    /// Room that a disc of `radius_m` has to the outline on its way along straight pieces between `places_m`, m: by how
    /// much it passes clear of it, negative where it touches. Infinite without a place.
    pub fn swept_clearance_m(&self, places_m: &[[f64; 2]], radius_m: f64) -> f64 {
        let corners = self.corners.iter().map(|p| Vector::new(p.x, p.y)).collect();
        let Some(polygon) = ConvexPolygon::from_convex_polyline(corners) else {
            return f64::INFINITY;
        };
        let still = Pose::IDENTITY;
        let distance_m = |from: [f64; 2], to: [f64; 2]| {
            let way = Segment::new(Vector::new(from[0], from[1]), Vector::new(to[0], to[1]));
            // Two convex shapes always have a distance.
            distance(&still, &way, &still, &polygon).map_or(f64::INFINITY, |found| found.distance)
        };
        let last = places_m.last().map(|&place| distance_m(place, place));
        let pieces = places_m.windows(2).map(|pair| distance_m(pair[0], pair[1]));
        pieces.chain(last).fold(f64::INFINITY, f64::min) - radius_m
    }

    /// Whether the point lies inside or on the outline.
    pub fn contains(&self, point: &Point2<f64>) -> bool {
        self.edges().all(|(a, b)| (b - a).perp(&(point - a)) >= 0.0)
    }
}

/// Corners of the part of a convex polygon on that side of the line through `point` to which `inward` points.
fn cut_off(
    corners: &[Point2<f64>],
    point: &Point2<f64>,
    inward: &Vector2<f64>,
) -> Vec<Point2<f64>> {
    let side = |corner: &Point2<f64>| inward.dot(&(corner - point));
    let mut left = Vec::with_capacity(corners.len() + 1);
    for (i, corner) in corners.iter().enumerate() {
        let next = &corners[(i + 1) % corners.len()];
        let (here, there) = (side(corner), side(next));
        if here >= 0.0 {
            left.push(*corner);
        }
        if (here >= 0.0) != (there >= 0.0) {
            left.push(corner + (next - corner) * (here / (here - there)));
        }
    }
    left
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_hull_contains_its_points(points in prop::collection::vec((-2.0..2.0f64, -2.0..2.0f64), 3..40)) {
            let points: Vec<_> = points.into_iter().map(|(x, y)| Point2::new(x, y)).collect();
            if let Ok(hull) = Outline::hull(&points) {
                let inflated_area = hull.area_m2();
                prop_assert!(inflated_area > 0.0);
                for p in &points {
                    let outside = hull.edges().map(|(a, b)| -(b - a).normalize().perp(&(p - a))).fold(f64::MIN, f64::max);
                    prop_assert!(outside < 1e-9);
                }
            }
        }
    }

    fn square() -> Outline {
        let corners = [(1.0, -0.5), (2.0, -0.5), (2.0, 0.5), (1.0, 0.5)];
        Outline::hull(&corners.map(|(x, y)| Point2::new(x, y))).unwrap()
    }

    proptest! {
        #[test]
        fn a_sweep_has_the_least_room_of_all_places_on_it(
            ax in -2.0..0.8f64, ay in -2.0..2.0f64, bx in -2.0..0.8f64, by in -2.0..2.0f64,
        ) {
            let square = square();
            let swept = square.swept_clearance_m(&[[ax, ay], [bx, by]], 0.14);
            let place = |i: i32| {
                let t = f64::from(i) / 200.0;
                let [x, y] = [ax + t * (bx - ax), ay + t * (by - ay)];
                crate::hypot(1.0 - x, y.abs().max(0.5) - 0.5) - 0.14
            };
            let least = (0..=200).map(place).fold(f64::INFINITY, f64::min);
            prop_assert!(swept <= least + 1e-6 && swept > least - 0.02);
        }
    }

    fn points() -> impl Strategy<Value = Vec<Point2<f64>>> {
        let point = (-2.0..2.0f64, -2.0..2.0f64).prop_map(|(x, y)| Point2::new(x, y));
        prop::collection::vec(point, 3..20)
    }

    proptest! {
        #[test]
        fn two_outlines_share_no_more_than_either_has_and_as_much_either_way(a in points(), b in points()) {
            let (Ok(a), Ok(b)) = (Outline::hull(&a), Outline::hull(&b)) else { return Ok(()) };
            let shared = a.shared_area_m2(&b);
            prop_assert!((0.0..=a.area_m2().min(b.area_m2()) + 1e-6).contains(&shared));
            prop_assert!((shared - b.shared_area_m2(&a)).abs() < 1e-6);
            prop_assert!((a.shared_area_m2(&a) - a.area_m2()).abs() < 1e-6);
            let inside = (0..40_000).filter(|i| {
                let at = Point2::new(f64::from(i % 200) / 50.0 - 1.99, f64::from(i / 200) / 50.0 - 1.99);
                a.contains(&at) && b.contains(&at)
            });
            prop_assert!((shared - inside.count() as f64 / 2500.0).abs() < 0.1);
        }

        #[test]
        fn a_line_through_the_inside_enters_before_it_leaves(points in points(), weights in prop::collection::vec(0.1..1.0f64, 20), heading in 0.0..6.3f64) {
            let Ok(hull) = Outline::hull(&points) else { return Ok(()) };
            let total: f64 = weights.iter().take(points.len()).sum();
            let inside = points.iter().zip(&weights).map(|(p, w)| p.coords * *w / total).sum::<Vector2<f64>>();
            let direction = Vector2::new(libm::cos(heading), libm::sin(heading));
            let [enters, leaves] = hull.cuts(&inside.into(), &direction).unwrap();
            for cut in [enters, leaves] {
                prop_assert!(direction.perp(&(cut.at.coords - inside)).abs() < 1e-9);
                let (a, b) = hull.edges().nth(cut.edge).unwrap();
                prop_assert!((nalgebra::distance(&a, &cut.at) + nalgebra::distance(&cut.at, &b) - nalgebra::distance(&a, &b)).abs() < 1e-9);
            }
            prop_assert!(direction.dot(&(leaves.at - enters.at)) > 0.0);
        }
    }

    #[test]
    fn a_line_beside_the_outline_cuts_nothing() {
        assert_eq!(square().cuts(&Point2::new(0.0, 0.6), &Vector2::x()), None);
        let cut = square().cuts(&Point2::origin(), &Vector2::x()).unwrap();
        assert_eq!(
            cut.map(|cut| cut.at),
            [Point2::new(1.0, 0.0), Point2::new(2.0, 0.0)]
        );
    }

    #[test]
    fn a_sweep_through_the_outline_touches_it_though_no_end_does() {
        let through = square().swept_clearance_m(&[[0.0, 0.0], [3.0, 0.0]], 0.1);
        assert!(through <= -0.1);
        let beside = square().swept_clearance_m(&[[0.0, 0.8], [3.0, 0.8]], 0.1);
        assert!((beside - 0.2).abs() < 1e-9);
        assert_eq!(square().swept_clearance_m(&[], 0.1), f64::INFINITY);
    }

    #[test]
    fn points_on_one_line_have_no_outline() {
        let line: Vec<_> = (0..5)
            .map(|i| Point2::new(f64::from(i), 2.0 * f64::from(i)))
            .collect();
        assert_eq!(Outline::hull(&line), Err(OutlineError::Degenerate));
    }
}
