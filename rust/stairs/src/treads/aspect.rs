//! From which sides a tread was seen: for each a front and a back, of which the robot goes over one pair.

use geometry::Outline;
use nalgebra::{Point2, Vector2};

use crate::treads::border::Border;

/// Fronts that point further apart than this are different sides, cosine.
const SAME_SIDE: f64 = 0.82;
/// How far outside of a side the robot must be for it to become the front, and how much farther than outside of the present one, m.
const OUTSIDE_M: f64 = 0.05;
const FARTHER_M: f64 = 0.02;
/// Share of the heaviest aspect's weight that another must have to be taken for a side of the tread, not for a skewed look: of the
/// sightings in which an edge was seen to end it, where there are any.
const BELIEVED: f64 = 0.2;
/// Sightings, with those before a step worth less, without which none is: the head turns past a tread, and a few looks in a row are
/// cut off by the picture's border and a wall.
const LEAST_SIGHTINGS: f64 = 4.0;
/// Directions in which a tread is crossed: its two, and one that something stood before.
const MOST: usize = 3;

/// A front and a back, as seen from one side.
#[derive(Debug, Clone)]
pub(crate) struct Aspect {
    pub(crate) front: Border,
    pub(crate) back: Border,
    /// With those before a step worth less.
    sightings: f64,
}

impl Aspect {
    fn weight(&self) -> f64 {
        self.front.weight().max(self.back.weight())
    }

    /// Weight of the sightings in which it was seen to end the tread.
    fn seen_weight(&self) -> f64 {
        let [front, back] = [&self.front, &self.back].map(|border| border.seen_weights()[0]);
        front.max(back)
    }

    /// Direction from right to left: that of the edge which more was seen of. The other may be where the view ended, or a wall.
    fn along(&self) -> Vector2<f64> {
        let [front_seen, ..] = self.front.seen_weights();
        let [back_seen, ..] = self.back.seen_weights();
        if back_seen > front_seen {
            self.back.along()
        } else {
            self.front.along()
        }
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
        let sightings = 1.0;
        Self(vec![Aspect {
            front,
            back,
            sightings,
        }])
    }

    /// The one that is the robot's.
    pub(crate) fn present(&self) -> &Aspect {
        &self.0[0]
    }

    /// Joins those that run the same way; what was seen from another side is kept beside them.
    pub(crate) fn add(&mut self, others: &Self) {
        for other in &others.0 {
            let agreement = |own: &Aspect| own.along().dot(&other.along());
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
                    own.sightings += other.sightings;
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
            aspect.sightings *= factor;
        }
    }

    /// Makes the side on which the robot is the front. On the tread, and where it is hardly outside, the front stays.
    /// Returns whether it became another.
    pub(crate) fn face(&mut self, hull: &Outline, robot: &Point2<f64>) -> bool {
        let most = |weight: fn(&Aspect) -> f64| self.0.iter().map(weight).fold(0.0, f64::max);
        let (heaviest, most_seen) = (most(Aspect::weight), most(Aspect::seen_weight));
        let is_believed = |aspect: &Aspect| {
            if most_seen > 0.0 {
                aspect.seen_weight() >= BELIEVED * most_seen
            } else {
                aspect.weight() >= BELIEVED * heaviest
            }
        };
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
            .filter(|(_, aspect)| is_believed(aspect) && aspect.sightings >= LEAST_SIGHTINGS)
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
    use crate::treads::border::Weights;

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

    /// A landing that looks from its long side saw, then others from its front, with these weights in all.
    fn landing(from_the_side: f64, from_the_front: f64) -> Aspects {
        const LOOKS: usize = 5;
        let [near_right, far_right, far_left, near_left] = CORNERS;
        let side = from_the_side / LOOKS as f64;
        let front = from_the_front / LOOKS as f64;
        let looks = [
            Aspects::new(
                border(near_left, far_left, side),
                border(near_right, far_right, side),
            ),
            Aspects::new(
                border(near_right, near_left, front),
                border(far_right, far_left, front),
            ),
        ];
        let mut aspects = looks[0].clone();
        for _ in 1..LOOKS {
            aspects.add(&looks[0]);
        }
        for _ in 0..LOOKS {
            aspects.add(&looks[1]);
        }
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

    /// The left end of a tread across the way, seen while the head turns away from it: its front is cut off by the picture's border.
    fn cut_off(front_seen: f64, back: Border) -> Aspects {
        let weights = Weights {
            all: 500.0,
            edge: front_seen,
            left: 500.0,
            right: 0.0,
        };
        let ends = [[1.2, 0.0], [0.9, 0.25]].map(Point2::from);
        Aspects::new(Border::new([&ends[0], &ends[1]], weights), back)
    }

    /// The tread itself, after a step.
    fn remembered() -> Aspects {
        let mut aspects = Aspects::new(
            border([1.0, -0.25], [1.0, 0.25], 1000.0),
            border([3.0, -0.25], [3.0, 0.25], 1000.0),
        );
        aspects.0[0].sightings = 2.0;
        aspects
    }

    #[test]
    fn a_look_whose_front_is_cut_off_runs_as_its_back_does() {
        let mut aspects = remembered();
        for _ in 0..8 {
            aspects.add(&cut_off(0.0, border([3.0, 0.1], [3.0, 0.25], 60.0)));
        }
        assert_eq!(aspects.0.len(), 1);
        assert_eq!(ahead(&mut aspects, [0.5, 0.0]), [1, 0]);
        let [right, left] = aspects.present().front.ends(&hull(), -1.0).unwrap();
        assert!((right.x - 1.0).abs() < 1e-9 && (left.x - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_few_skewed_looks_in_a_row_are_no_side() {
        let mut aspects = remembered();
        let skewed = || cut_off(500.0, border([3.2, 0.0], [2.9, 0.25], 60.0));
        let turned = |aspects: &mut Aspects| {
            let _ = aspects.face(&hull(), &Point2::new(0.5, -0.6));
            aspects.present().front.across().y > 0.5
        };
        for _ in 0..3 {
            aspects.add(&skewed());
            assert!(!turned(&mut aspects));
        }
        aspects.add(&skewed());
        assert!(turned(&mut aspects), "what is seen again and again is one");
    }

    #[test]
    fn where_only_the_view_ended_is_no_side_however_often() {
        let mut aspects = remembered();
        for _ in 0..20 {
            aspects.add(&cut_off(0.0, border([3.2, 0.0], [2.9, 0.25], 5.0)));
        }
        let _ = aspects.face(&hull(), &Point2::new(0.5, -0.6));
        assert!(aspects.present().front.across().x > 0.99);
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
