//! A box: three pairs of faces. A ray is within it while it is within all three pairs.

use crate::eye::{LocalEye, Triple};
use crate::shapes::{larger, smaller};

/// The room between two parallel faces.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Between {
    /// Nearness of the face that is entered by, for a ray's part along the axis of 1; 0 where the eye is between the faces.
    entry: f64,
    /// Infinite where the eye is between the faces: nothing has to be entered.
    entered: f64,
    /// Nearnesses of the faces that may be left by.
    exits: [f64; 2],
}

impl Between {
    pub(crate) fn new(place: f64, half: f64) -> Self {
        // In the plane of a face one leaves by it at once, or not at all: what is not finite would be no number for a ray in the plane.
        let upper = (1.0 / (half - place)).clamp(f64::MIN, f64::MAX);
        let lower = (-1.0 / (half + place)).clamp(f64::MIN, f64::MAX);
        if place > half {
            Self {
                entry: upper,
                entered: 0.0,
                exits: [lower; 2],
            }
        } else if place < -half {
            Self {
                entry: lower,
                entered: 0.0,
                exits: [upper; 2],
            }
        } else {
            Self {
                entry: 0.0,
                entered: f64::INFINITY,
                exits: [lower, upper],
            }
        }
    }

    /// Whether the eye is between the faces.
    pub(crate) const fn is_around(&self) -> bool {
        self.entered > 0.0
    }

    /// How near a ray enters, infinite where it begins within; not above 0 where it leads away.
    #[inline]
    pub(crate) fn entry(&self, along: f64) -> f64 {
        along * self.entry + self.entered
    }

    /// How near a ray leaves, once it is within.
    #[inline]
    pub(crate) fn exit(&self, along: f64) -> f64 {
        larger(along * self.exits[0], along * self.exits[1])
    }
}

/// A box around a body's origin before an eye.
pub(crate) struct CuboidAhead {
    sides: [Between; 3],
    around: bool,
}

impl CuboidAhead {
    pub(crate) fn new(eye: &LocalEye, half_m: Triple) -> Self {
        let sides = [0, 1, 2].map(|axis| Between::new(eye.place[axis], half_m[axis]));
        Self {
            sides,
            around: sides.iter().all(Between::is_around),
        }
    }

    /// How near a ray meets it; what is not above 0 is no meeting.
    #[inline]
    pub(crate) fn met(&self, ray: Triple) -> f64 {
        let [x, y, z] = &self.sides;
        let exit = larger(larger(x.exit(ray[0]), y.exit(ray[1])), z.exit(ray[2]));
        if self.around {
            return exit;
        }
        let entry = smaller(smaller(x.entry(ray[0]), y.entry(ray[1])), z.entry(ray[2]));
        if entry >= exit { entry } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cuboid(place: Triple) -> CuboidAhead {
        let eye = LocalEye {
            place,
            across: [0.0; 3],
            down: [0.0; 3],
            ahead: [0.0; 3],
        };
        CuboidAhead::new(&eye, [1.0, 2.0, 3.0])
    }

    #[test]
    fn a_box_is_met_at_the_face_towards_the_eye() {
        let before = cuboid([-3.0, 0.0, 0.0]);
        assert_eq!(before.met([1.0, 0.0, 0.0]), 0.5);
        assert_eq!(before.met([1.0, 0.99, 0.0]), 0.5);
        assert_eq!(before.met([-1.0, 0.0, 0.0]).max(0.0), 0.0);
        // Past the face at once, and past the box at all.
        assert_eq!(before.met([1.0, 1.01, 0.0]), 0.0);
    }

    #[test]
    fn a_box_is_met_from_the_plane_of_any_of_its_sides() {
        for side in [-1.0, 1.0] {
            let before = cuboid([side, -4.0, 0.0]);
            assert_eq!(before.met([0.0, 1.0, 0.0]), 0.5);
            assert_eq!(before.met([-0.1 * side, 1.0, 0.0]), 0.5);
            assert_eq!(before.met([0.1 * side, 1.0, 0.0]).max(0.0), 0.0);
            assert_eq!(before.met([-side, 0.0, 0.0]).max(0.0), 0.0);
        }
    }

    #[test]
    fn a_box_that_the_eye_is_in_is_met_at_the_face_that_the_ray_leaves_by() {
        let within = cuboid([0.5, 0.0, 0.0]);
        assert_eq!(within.met([1.0, 0.0, 0.0]), 2.0);
        assert_eq!(within.met([-1.0, 0.0, 0.0]), 1.0 / 1.5);
        assert_eq!(within.met([0.0, 0.0, 1.0]), 1.0 / 3.0);
    }
}
