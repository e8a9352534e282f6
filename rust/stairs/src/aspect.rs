//! From which sides a tread was seen: for each a front and a back, of which the robot goes over one pair.

use geometry::Outline;
use nalgebra::Point2;

use crate::border::Border;

/// Fronts that point further apart than this are different sides, cosine.
const SAME_SIDE: f64 = 0.82;
/// How far outside of a side the robot must be for it to become the front, and how much farther than outside of the present one, m.
const OUTSIDE_M: f64 = 0.05;
const FARTHER_M: f64 = 0.02;
/// Share of the heaviest aspect's weight that another must have to be taken for a side of the tread, not for a skewed look.
const BELIEVED: f64 = 0.2;
/// Directions in which a tread is crossed: its two, and one that something stood before.
const MOST: usize = 3;

/// A front and a back, as seen from one side.
#[derive(Debug, Clone)]
pub(crate) struct Aspect {
    pub(crate) front: Border,
    pub(crate) back: Border,
}

impl Aspect {
    fn weight(&self) -> f64 {
        self.front.weight().max(self.back.weight())
    }

    fn turn_round(&mut self) {
        self.front.reverse();
        self.back.reverse();
        std::mem::swap(&mut self.front, &mut self.back);
    }

    /// How far a place lies before the front and how far beyond the back, m; negative: within.
    fn outside_m(&self, hull: &Outline, place: &Point2<f64>) -> [f64; 2] {
        let beyond_m = |border: &Border, outward: f64| {
            let [right, left] = border.ends(hull, outward)?;
            let across = border.across();
            Some(outward * across.dot(&(place - nalgebra::center(&right, &left))))
        };
        [(&self.front, -1.0), (&self.back, 1.0)]
            .map(|(border, outward)| beyond_m(border, outward).unwrap_or(f64::NEG_INFINITY))
    }
}

/// All of them, the one first that is the robot's.
#[derive(Debug, Clone)]
pub(crate) struct Aspects(Vec<Aspect>);

impl Aspects {
    pub(crate) fn new(front: Border, back: Border) -> Self {
        Self(vec![Aspect { front, back }])
    }

    /// The one that is the robot's.
    pub(crate) fn present(&self) -> &Aspect {
        &self.0[0]
    }

    /// Joins those that run the same way; what was seen from another side is kept beside them.
    pub(crate) fn add(&mut self, others: &Self) {
        for other in &others.0 {
            let agreement = |own: &Aspect| own.front.along().dot(&other.front.along());
            let closest = self
                .0
                .iter_mut()
                .max_by(|a, b| agreement(a).abs().total_cmp(&agreement(b).abs()));
            match closest {
                Some(own) if agreement(own).abs() > SAME_SIDE => {
                    let mut other = other.clone();
                    if agreement(own) < 0.0 {
                        other.turn_round();
                    }
                    own.front.add_border(&other.front);
                    own.back.add_border(&other.back);
                }
                _ => self.0.push(other.clone()),
            }
        }
        if self.0.len() > MOST {
            self.0[1..].sort_by(|a, b| b.weight().total_cmp(&a.weight()));
            self.0.truncate(MOST);
        }
    }

    /// Makes all weights smaller by a factor.
    pub(crate) fn scale(&mut self, factor: f64) {
        for aspect in &mut self.0 {
            aspect.front.scale(factor);
            aspect.back.scale(factor);
        }
    }

    /// Makes the side on which the robot is the front. On the tread, and where it is hardly outside, the front stays.
    /// Returns whether it became another.
    pub(crate) fn face(&mut self, hull: &Outline, robot: &Point2<f64>) -> bool {
        let heaviest = self.0.iter().map(Aspect::weight).fold(0.0, f64::max);
        let is_believed = |aspect: &Aspect| aspect.weight() >= BELIEVED * heaviest;
        let outside_m = |aspect: &Aspect| {
            let [before_m, behind_m] = aspect.outside_m(hull, robot);
            before_m.max(behind_m)
        };
        let present_m = outside_m(self.present());
        let least_m = if is_believed(self.present()) {
            OUTSIDE_M.max(present_m + FARTHER_M)
        } else {
            f64::NEG_INFINITY
        };
        let others = self.0.iter().enumerate().skip(1);
        let other = others
            .filter(|(_, aspect)| is_believed(aspect))
            .map(|(index, aspect)| (index, outside_m(aspect)))
            .filter(|&(_, other_m)| other_m >= least_m)
            .max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((index, _)) = other {
            self.0.swap(0, index);
        }
        let [_, behind_m] = self.present().outside_m(hull, robot);
        let turned = behind_m > OUTSIDE_M;
        if turned {
            self.0[0].turn_round();
        }
        turned || other.is_some()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::border::Weights;

    /// An edge that was seen, from its right to its left end.
    fn border(right: [f64; 2], left: [f64; 2], weight: f64) -> Border {
        let weights = Weights {
            all: weight,
            edge: weight,
            left: weight,
            right: weight,
        };
        Border::new([&right.into(), &left.into()], weights)
    }

    const CORNERS: [[f64; 2]; 4] = [[1.0, -0.25], [3.0, -0.25], [3.0, 0.25], [1.0, 0.25]];

    fn hull() -> Outline {
        Outline::hull(&CORNERS.map(Point2::from)).unwrap()
    }

    /// A landing seen first from its long side, then from its front.
    fn landing(from_the_side: f64, from_the_front: f64) -> Aspects {
        let [near_right, far_right, far_left, near_left] = CORNERS;
        let mut aspects = Aspects::new(
            border(near_left, far_left, from_the_side),
            border(near_right, far_right, from_the_side),
        );
        aspects.add(&Aspects::new(
            border(near_right, near_left, from_the_front),
            border(far_right, far_left, from_the_front),
        ));
        aspects
    }

    /// Where one goes who crosses the front.
    fn ahead(aspects: &mut Aspects, [x, y]: [f64; 2]) -> [i32; 2] {
        let _ = aspects.face(&hull(), &Point2::new(x, y));
        let across = aspects.present().front.across();
        [across.x.round() as i32, across.y.round() as i32]
    }

    #[test]
    fn the_front_is_the_side_that_the_robot_stands_before_and_on_the_tread_it_stays() {
        let mut aspects = landing(900.0, 300.0);
        assert_eq!(ahead(&mut aspects, [2.0, 0.6]), [0, -1]);
        assert_eq!(ahead(&mut aspects, [0.8, 0.0]), [1, 0]);
        assert_eq!(ahead(&mut aspects, [2.0, 0.1]), [1, 0]);
        assert_eq!(ahead(&mut aspects, [3.3, 0.0]), [-1, 0]);
        assert_eq!(ahead(&mut aspects, [2.0, -0.6]), [0, 1]);
    }

    #[test]
    fn a_skewed_look_is_no_side() {
        assert_eq!(ahead(&mut landing(900.0, 90.0), [0.8, 0.0]), [0, -1]);
        assert_eq!(ahead(&mut landing(90.0, 900.0), [2.0, 0.6]), [1, 0]);
    }

    proptest! {
        /// Whatever was seen first: the robot stands before its front, and no side is farther from it.
        #[test]
        fn no_other_side_is_much_farther_in_front_of_the_robot(
            x in -1.0..5.0f64, y in -2.0..2.0f64, side in 1.0..4.0f64,
        ) {
            let mut aspects = landing(side * 100.0, 200.0);
            let [x_ahead, y_ahead] = ahead(&mut aspects, [x, y]);
            let outside_m = |across: [i32; 2]| match across {
                [1, 0] => 1.0 - x,
                [-1, 0] => x - 3.0,
                [0, 1] => -0.25 - y,
                _ => y - 0.25,
            };
            let most_m = [[1, 0], [-1, 0], [0, 1], [0, -1]].map(outside_m);
            let most_m = most_m.into_iter().fold(f64::MIN, f64::max);
            prop_assert!(most_m <= OUTSIDE_M || outside_m([x_ahead, y_ahead]) > most_m - FARTHER_M);
        }
    }
}
