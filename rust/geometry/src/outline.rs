//! Convex outlines on the ground: hulls, areas, containment, overlap. The one place that calls parry in the plane.

use nalgebra::Point2;
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

impl Outline {
    /// The smallest convex polygon around the points.
    pub fn hull(points: &[Point2<f64>]) -> Result<Self, OutlineError> {
        if points.len() < 3 {
            return Err(OutlineError::Degenerate);
        }
        let input: Vec<_> = points
            .iter()
            .map(|p| parry2d_f64::math::Vector::new(p.x, p.y))
            .collect();
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

    /// Whether the point lies inside or on the outline.
    pub fn contains(&self, point: &Point2<f64>) -> bool {
        self.edges().all(|(a, b)| (b - a).perp(&(point - a)) >= 0.0)
    }
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

    #[test]
    fn points_on_one_line_have_no_outline() {
        let line: Vec<_> = (0..5)
            .map(|i| Point2::new(f64::from(i), 2.0 * f64::from(i)))
            .collect();
        assert_eq!(Outline::hull(&line), Err(OutlineError::Degenerate));
    }
}
