//! A capsule about the z axis: a cylinder's side between two spheres. It is met where the first of the three is.

use crate::eye::{LocalEye, Triple, dot};
use crate::shapes::quadric::Round;
use crate::shapes::{larger, smaller};

/// A capsule around a body's origin before an eye.
pub(crate) struct CapsuleAhead {
    half_length: f64,
    place: Triple,
    side: Round,
    ends: [Round; 2],
}

impl CapsuleAhead {
    pub(crate) fn new(eye: &LocalEye, radius_m: f64, half_length_m: f64) -> Self {
        let [x, y, z] = eye.place;
        let beside = x * x + y * y - radius_m * radius_m;
        let end = |sign: f64| {
            let along = z - sign * half_length_m;
            Round::new(beside + along * along)
        };
        Self {
            half_length: half_length_m,
            place: eye.place,
            side: Round::new(beside),
            ends: [end(1.0), end(-1.0)],
        }
    }

    /// Whether the eye is outside of it.
    pub(crate) fn is_before(&self) -> bool {
        let beside = self.side.is_before() || self.place[2].abs() > self.half_length;
        beside && self.ends.iter().all(Round::is_before)
    }

    /// How near a ray meets it from outside; what is not above 0 is no meeting.
    #[inline]
    pub(crate) fn met(&self, ray: Triple) -> f64 {
        let (flat, b) = self.terms(ray);
        let side = self.side.through(flat, b).0;
        // Within the endless cylinder, `side` is where it was entered behind the eye, and not above 0.
        let mut near = if self.between(ray, side) { side } else { 0.0 };
        let a = flat + ray[2] * ray[2];
        for (end, sign) in self.ends.iter().zip([-1.0, 1.0]) {
            let b = b + ray[2] * (self.place[2] + sign * self.half_length);
            near = larger(end.through(a, b).0, near);
        }
        near
    }

    /// How near a ray meets it from within: where it leaves the last of the three.
    #[inline]
    pub(crate) fn met_within(&self, ray: Triple) -> f64 {
        let (flat, b) = self.terms(ray);
        let side = self.side.leave(flat, b);
        let mut near = if self.between(ray, side) {
            side
        } else {
            f64::INFINITY
        };
        let a = dot(ray, ray);
        for (end, sign) in self.ends.iter().zip([-1.0, 1.0]) {
            let b = b + ray[2] * (self.place[2] + sign * self.half_length);
            let exit = if end.is_before() {
                end.through(a, b).1
            } else {
                end.leave(a, b)
            };
            near = smaller(if exit > 0.0 { exit } else { f64::INFINITY }, near);
        }
        near
    }

    /// Whether a ray is between the ends at a nearness.
    #[inline]
    fn between(&self, ray: Triple, near: f64) -> bool {
        (self.place[2] * near + ray[2]).abs() <= self.half_length * near
    }

    #[inline]
    fn terms(&self, ray: Triple) -> (f64, f64) {
        let a = ray[0] * ray[0] + ray[1] * ray[1];
        (a, ray[0] * self.place[0] + ray[1] * self.place[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn capsule(place: Triple) -> CapsuleAhead {
        let eye = LocalEye {
            place,
            across: [0.0; 3],
            down: [0.0; 3],
            ahead: [0.0; 3],
        };
        CapsuleAhead::new(&eye, 1.0, 2.0)
    }

    #[test]
    fn a_capsule_is_met_on_its_side_and_on_its_ends() {
        let beside = capsule([-3.0, 0.0, 0.0]);
        assert!(beside.is_before());
        assert!((beside.met([1.0, 0.0, 0.5]) - 0.5).abs() < 1e-12);
        let above = capsule([0.0, 0.0, 5.0]);
        assert!(above.is_before());
        assert!((above.met([0.0, 0.0, -1.0]) - 0.5).abs() < 1e-12);
        assert!(above.met([0.0, 0.0, 1.0]) <= 0.0);
        // Beside the upper end, past it.
        assert_eq!(capsule([-3.0, 0.0, 2.9]).met([1.0, 0.0, 0.1]), 0.0);
    }

    #[test]
    fn a_capsule_that_the_eye_is_in_is_met_from_within() {
        for height_m in [0.0, 1.5, 2.5, -2.9] {
            let within = capsule([0.0, 0.0, height_m]);
            assert!(!within.is_before());
            let up = 1.0 / within.met_within([0.0, 0.0, 1.0]);
            assert!((up - (3.0 - height_m)).abs() < 1e-12, "{height_m}: {up}");
        }
        assert_eq!(capsule([0.5, 0.0, 0.0]).met_within([1.0, 0.0, 0.0]), 2.0);
    }
}
