//! Who stands near in a cloud: an R*-tree, built in the same order from the same points.

use rstar::RTree;
use rstar::primitives::GeomWithData;

use crate::cloud::Point3;

type NumberedPoint = GeomWithData<Point3, usize>;

/// The points of a cloud by place.
#[derive(Debug)]
pub struct Neighbours {
    tree: RTree<NumberedPoint>,
}

impl Neighbours {
    /// Of a cloud of finite points.
    pub fn new(points: &[Point3]) -> Self {
        let entries = points.iter().enumerate();
        Self {
            tree: RTree::bulk_load(
                entries
                    .map(|(index, point)| NumberedPoint::new(*point, index))
                    .collect(),
            ),
        }
    }

    /// The `count` points nearest to a place, from near to far: index and distance, m. A point of the cloud is its own nearest.
    pub fn nearest(&self, place: Point3, count: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.tree
            .nearest_neighbor_iter_with_distance_2(place)
            .take(count)
            .map(|(entry, squared)| (entry.data, squared.sqrt()))
    }

    /// The indices of all points within a radius (m) of a place.
    pub fn within(&self, place: Point3, radius_m: f64) -> impl Iterator<Item = usize> + '_ {
        self.tree
            .locate_within_distance(place, radius_m * radius_m)
            .map(|entry| entry.data)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::Noise;

    #[test]
    fn neighbours_are_those_of_brute_force() {
        let mut noise = Noise::new(4);
        let points: Vec<Point3> = (0..300)
            .map(|_| [0; 3].map(|_| noise.within(-1.0, 1.0)))
            .collect();
        let tree = Neighbours::new(&points);
        for place in &points[..40] {
            let away = |index: &usize| -> f64 {
                let squares = points[*index]
                    .iter()
                    .zip(place)
                    .map(|(a, b)| (a - b) * (a - b));
                squares.sum::<f64>().sqrt()
            };
            let mut all: Vec<usize> = (0..points.len()).collect();
            all.sort_by(|a, b| away(a).total_cmp(&away(b)));
            let nearest: Vec<_> = tree.nearest(*place, 12).map(|(index, _)| index).collect();
            assert_eq!(nearest, all[..12]);
            let mut within: Vec<_> = tree.within(*place, 0.4).collect();
            within.sort_unstable();
            let mut expected: Vec<_> = all.iter().copied().filter(|i| away(i) <= 0.4).collect();
            expected.sort_unstable();
            assert_eq!(within, expected);
        }
    }
}
