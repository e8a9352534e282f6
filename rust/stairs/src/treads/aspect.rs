//! From which sides a tread was seen: for each a front and a back, of which the robot goes over one pair.

use geometry::Outline;
use nalgebra::{Point2, Vector2};

use crate::{SidesTuning, StairsTuning, treads::border::Border};

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
    fn along(&self, tuning: &StairsTuning) -> Vector2<f64> {
        let [front_seen, ..] = self.front.seen_weights();
        let [back_seen, ..] = self.back.seen_weights();
        if back_seen > front_seen {
            self.back.along(tuning)
        } else {
            self.front.along(tuning)
        }
    }

    fn turn_round(&mut self) {
        self.front.reverse();
        self.back.reverse();
        std::mem::swap(&mut self.front, &mut self.back);
    }

    /// How far a place lies before the front and how far beyond the back, m; negative: within.
    fn outside_m(&self, hull: &Outline, place: &Point2<f64>, tuning: &StairsTuning) -> [f64; 2] {
        let beyond_m = |border: &Border, outward: f64| {
            let [right, left] = border.ends(hull, outward, tuning)?;
            let across = border.across(tuning);
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
    pub(crate) fn add(&mut self, others: &Self, tuning: &StairsTuning) {
        let SidesTuning {
            same_side, most, ..
        } = tuning.treads.sides;
        for other in &others.0 {
            let agreement = |own: &Aspect| own.along(tuning).dot(&other.along(tuning));
            let closest = self
                .0
                .iter_mut()
                .max_by(|a, b| agreement(a).abs().total_cmp(&agreement(b).abs()));
            match closest {
                Some(own) if agreement(own).abs() > same_side => {
                    let mut other = other.clone();
                    if agreement(own) < 0.0 {
                        other.turn_round();
                    }
                    own.front.add_border(&other.front, tuning);
                    own.back.add_border(&other.back, tuning);
                    own.sightings += other.sightings;
                }
                _ => self.0.push(other.clone()),
            }
        }
        if self.0.len() > most {
            self.0[1..].sort_by(|a, b| b.weight().total_cmp(&a.weight()));
            self.0.truncate(most);
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
    pub(crate) fn face(
        &mut self,
        hull: &Outline,
        robot: &Point2<f64>,
        tuning: &StairsTuning,
    ) -> bool {
        let sides = &tuning.treads.sides;
        let most = |weight: fn(&Aspect) -> f64| self.0.iter().map(weight).fold(0.0, f64::max);
        let (heaviest, most_seen) = (most(Aspect::weight), most(Aspect::seen_weight));
        let is_believed = |aspect: &Aspect| {
            if most_seen > 0.0 {
                aspect.seen_weight() >= sides.believed * most_seen
            } else {
                aspect.weight() >= sides.believed * heaviest
            }
        };
        let outside_m = |aspect: &Aspect| {
            let [before_m, behind_m] = aspect.outside_m(hull, robot, tuning);
            before_m.max(behind_m)
        };
        let present_m = outside_m(self.present());
        let least_m = if is_believed(self.present()) {
            sides.outside.max(present_m + sides.farther)
        } else {
            f64::NEG_INFINITY
        };
        let others = self.0.iter().enumerate().skip(1);
        let other = others
            .filter(|(_, aspect)| is_believed(aspect) && aspect.sightings >= sides.least_sightings)
            .map(|(index, aspect)| (index, outside_m(aspect)))
            .filter(|&(_, other_m)| other_m >= least_m)
            .max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((index, _)) = other {
            self.0.swap(0, index);
        }
        let [_, behind_m] = self.present().outside_m(hull, robot, tuning);
        let turned = behind_m > sides.outside;
        if turned {
            self.0[0].turn_round();
        }
        turned || other.is_some()
    }
}

#[cfg(test)]
mod tests;
