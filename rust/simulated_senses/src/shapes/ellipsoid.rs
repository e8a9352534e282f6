//! An ellipsoid, a sphere among them.

use crate::eye::{LocalEye, Triple, dot};
use crate::shapes::quadric::Round;

/// An ellipsoid around a body's origin before an eye.
pub(crate) struct EllipsoidAhead {
    over: Triple,
    place: Triple,
    round: Round,
}

impl EllipsoidAhead {
    pub(crate) fn new(eye: &LocalEye, radii_m: Triple) -> Self {
        let over = radii_m.map(|radius| 1.0 / radius);
        let place = [0, 1, 2].map(|axis| eye.place[axis] * over[axis]);
        Self {
            over,
            place,
            round: Round::new(dot(place, place) - 1.0),
        }
    }

    /// Whether the eye is outside of it.
    pub(crate) fn is_before(&self) -> bool {
        self.round.is_before()
    }

    /// How near a ray meets it; what is not above 0, or no number, is no meeting.
    #[inline]
    pub(crate) fn met(&self, ray: Triple) -> f64 {
        let (a, b) = self.terms(ray);
        self.round.through(a, b).0
    }

    /// How near a ray meets it from within.
    #[inline]
    pub(crate) fn met_within(&self, ray: Triple) -> f64 {
        let (a, b) = self.terms(ray);
        self.round.leave(a, b)
    }

    #[inline]
    fn terms(&self, ray: Triple) -> (f64, f64) {
        let ray = [0, 1, 2].map(|axis| ray[axis] * self.over[axis]);
        (dot(ray, ray), dot(ray, self.place))
    }
}
