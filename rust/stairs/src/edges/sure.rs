//! An edge as far as it was ever fitted.

use geometry::Point;

use crate::Edge;

impl<F> Edge<F> {
    /// From end to end of this edge and another one on about its line.
    pub(crate) fn and(&self, other: &Self) -> Self {
        let Some(line) = self.line() else {
            return Self {
                left: other.left,
                right: other.right,
            };
        };
        let left_m = |end: &&Point<F>| (end.inner.xy() - line.at).dot(&line.along);
        let by_place = |a: &&Point<F>, b: &&Point<F>| left_m(a).total_cmp(&left_m(b));
        let ends = [&self.left, &self.right, &other.left, &other.right];
        let farthest = (
            ends.into_iter().max_by(by_place),
            ends.into_iter().min_by(by_place),
        );
        Self {
            left: *farthest.0.unwrap_or(&self.left),
            right: *farthest.1.unwrap_or(&self.right),
        }
    }
}

#[cfg(test)]
mod tests {
    use geometry::Map;
    use proptest::prelude::*;

    use super::*;

    fn edge(right_m: f64, left_m: f64) -> Edge<Map> {
        let end = |y_m: f64| Point::new(0.5, y_m, 0.03);
        Edge {
            left: end(left_m),
            right: end(right_m),
        }
    }

    proptest! {
        #[test]
        fn two_fits_reach_from_the_first_end_to_the_last(
            a in -1.0..1.0f64, b in 0.1..1.0f64, c in -1.0..1.0f64, d in 0.1..1.0f64,
        ) {
            let both = edge(a, a + b).and(&edge(c, c + d));
            prop_assert_eq!(both, edge(a.min(c), (a + b).max(c + d)));
            prop_assert_eq!(edge(c, c + d).and(&edge(a, a + b)), both);
        }
    }
}
