//! Vegetation as a tree of balls: where leaves may be, in few numbers.

use nalgebra::Vector3;
use settings::{ConfigError, POSITIVE, Table, settings};

use crate::cloud::{CloudError, Point3, check};

settings! {
    /// How vegetation becomes a tree of balls.
    pub struct BallTreeConfig("classification.ball_tree") {
        /// Balls are halved until their radius is no larger.
        radius: f64 = 0.1, "m", POSITIVE;
    }
}

/// A ball that holds points, and the two within it.
#[derive(Debug, Clone, PartialEq)]
pub struct Ball {
    /// Its middle, m.
    pub middle: Vector3<f64>,
    /// Its radius, m.
    pub radius_m: f64,
    /// How far the leaves below it reach from its middle, m.
    pub reach_m: f64,
    /// How many points it holds.
    pub count: usize,
    /// The balls of its two halves, as numbers in the tree; `None` for a leaf.
    pub halves: Option<[usize; 2]>,
}

/// A tree of balls (Omohundro 1989): every point lies in each of the balls on its way down, the leaves are the vegetation.
#[derive(Debug, Clone, PartialEq)]
pub struct BallTree {
    balls: Vec<Ball>,
}

impl BallTree {
    /// Of points of vegetation.
    pub fn new(config: &BallTreeConfig, points: &[Point3]) -> Result<Self, TreeError> {
        config.check()?;
        check(points, 1)?;
        let mut tree = Self { balls: Vec::new() };
        let mut places: Vec<_> = points.iter().map(|point| Vector3::from(*point)).collect();
        let _ = tree.grow(&mut places, config.radius);
        Ok(tree)
    }

    /// The balls, the one around everything first.
    pub fn balls(&self) -> &[Ball] {
        &self.balls
    }

    /// The leaves: what stands for the vegetation.
    pub fn leaves(&self) -> impl Iterator<Item = &Ball> {
        self.balls.iter().filter(|ball| ball.halves.is_none())
    }

    /// How far a place is from the nearest leaf, m; 0 within one.
    pub fn distance_m(&self, place: Point3) -> f64 {
        let place = Vector3::from(place);
        let mut best_m = f64::INFINITY;
        let mut open = vec![0];
        while let Some(at) = open.pop() {
            let ball = &self.balls[at];
            let middle_m = (ball.middle - place).norm();
            if middle_m - ball.reach_m >= best_m {
                continue;
            }
            if let Some(halves) = ball.halves {
                open.extend(halves);
            } else {
                best_m = best_m.min((middle_m - ball.radius_m).max(0.0));
            }
        }
        best_m
    }

    /// Puts a ball around points, and halves it along the axis in which they lie farthest apart.
    fn grow(&mut self, places: &mut [Vector3<f64>], radius_m: f64) -> usize {
        let low = places.iter().fold(places[0], |low, place| low.inf(place));
        let high = places.iter().fold(places[0], |high, place| high.sup(place));
        let middle = (low + high) / 2.0;
        let largest_m = places
            .iter()
            .map(|place| (place - middle).norm())
            .fold(0.0, f64::max);
        let number = self.balls.len();
        self.balls.push(Ball {
            middle,
            radius_m: largest_m,
            reach_m: largest_m,
            count: places.len(),
            halves: None,
        });
        if largest_m > radius_m && places.len() > 1 {
            let axis = (high - low).imax();
            let half = places.len() / 2;
            let _ = places.select_nth_unstable_by(half, |a, b| a[axis].total_cmp(&b[axis]));
            let (lower, upper) = places.split_at_mut(half);
            let halves = [self.grow(lower, radius_m), self.grow(upper, radius_m)];
            let reaches_m = halves.map(|half| {
                let half = &self.balls[half];
                (half.middle - middle).norm() + half.reach_m
            });
            let ball = &mut self.balls[number];
            ball.halves = Some(halves);
            ball.reach_m = reaches_m[0].max(reaches_m[1]);
        }
        number
    }
}

/// Why there is no tree.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TreeError {
    /// A setting that cannot be used.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// Points that cannot be used.
    #[error(transparent)]
    Cloud(#[from] CloudError),
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::Noise;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_point_lies_in_a_leaf_and_the_nearest_leaf_is_that_of_all(seed in 0_u64..300, count in 1_usize..200) {
            let mut noise = Noise::new(seed);
            let points: Vec<Point3> = (0..count).map(|_| [0; 3].map(|_| noise.normal(0.5))).collect();
            let config = BallTreeConfig::default();
            let tree = BallTree::new(&config, &points).unwrap();
            prop_assert_eq!(tree.balls()[0].count, count);
            prop_assert_eq!(tree.leaves().map(|leaf| leaf.count).sum::<usize>(), count);
            prop_assert!(tree.leaves().all(|leaf| leaf.radius_m <= config.radius));
            for point in &points {
                prop_assert!(tree.distance_m(*point) < 1e-12);
            }
            for _ in 0..20 {
                let place = [0; 3].map(|_| noise.within(-3.0, 3.0));
                let away = tree.leaves().map(|leaf| {
                    ((leaf.middle - Vector3::from(place)).norm() - leaf.radius_m).max(0.0)
                });
                let nearest_m = away.fold(f64::INFINITY, f64::min);
                prop_assert!((tree.distance_m(place) - nearest_m).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn a_bush_takes_a_tenth_of_the_numbers() {
        let mut noise = Noise::new(1);
        let bush: Vec<Point3> = (0..30_000)
            .map(|_| [0; 3].map(|_| noise.normal(0.3)))
            .collect();
        let tree = BallTree::new(&BallTreeConfig::default(), &bush).unwrap();
        assert!(
            tree.leaves().count() * 10 < bush.len(),
            "{}",
            tree.leaves().count()
        );
        assert!(BallTree::new(&BallTreeConfig::default(), &[]).is_err());
    }
}
