//! A cylinder about the z axis with flat ends.

use crate::eye::{LocalEye, Triple};
use crate::shapes::cuboid::Between;
use crate::shapes::quadric::Round;
use crate::shapes::{larger, smaller};

/// A cylinder around a body's origin before an eye.
pub(crate) struct CylinderAhead {
    place: [f64; 2],
    side: Round,
    ends: Between,
}

impl CylinderAhead {
    pub(crate) fn new(eye: &LocalEye, radius_m: f64, half_length_m: f64) -> Self {
        let [x, y, z] = eye.place;
        Self {
            place: [x, y],
            side: Round::new(x * x + y * y - radius_m * radius_m),
            ends: Between::new(z, half_length_m),
        }
    }

    /// Whether the eye is outside of the round side, if not of the ends.
    pub(crate) fn is_beside(&self) -> bool {
        self.side.is_before()
    }

    /// How near a ray meets it from beside; what is not above 0 is no meeting.
    #[inline]
    pub(crate) fn met(&self, ray: Triple) -> f64 {
        let (a, b) = self.terms(ray);
        let (entry, exit) = self.side.through(a, b);
        // Where the ray misses the round side, `entry` is no number and stays none.
        let entry = smaller(self.ends.entry(ray[2]), entry);
        let exit = larger(self.ends.exit(ray[2]), exit);
        if entry >= exit { entry } else { 0.0 }
    }

    /// How near a ray meets it from within the round side, before an end or behind it.
    #[inline]
    pub(crate) fn met_within(&self, ray: Triple) -> f64 {
        let (a, b) = self.terms(ray);
        let exit = larger(self.ends.exit(ray[2]), self.side.leave(a, b));
        if self.ends.is_around() {
            return exit;
        }
        let entry = self.ends.entry(ray[2]);
        if entry >= exit { entry } else { 0.0 }
    }

    #[inline]
    fn terms(&self, ray: Triple) -> (f64, f64) {
        let a = ray[0] * ray[0] + ray[1] * ray[1];
        (a, ray[0] * self.place[0] + ray[1] * self.place[1])
    }
}
