//! A plane, seen from its front alone, as large as it is drawn.

use crate::eye::{LocalEye, Triple};

/// The plane z = 0 of a body's frame before an eye.
pub(crate) struct PlaneAhead {
    place: Triple,
    half: [f64; 2],
    scale: f64,
}

impl PlaneAhead {
    /// Half sizes that are not above 0 mean without end. `None` where the eye is not before the plane.
    pub(crate) fn new(eye: &LocalEye, half_m: [f64; 2]) -> Option<Self> {
        (eye.place[2] > 0.0).then(|| Self {
            place: eye.place,
            half: half_m.map(|half| if half > 0.0 { half } else { f64::INFINITY }),
            scale: -1.0 / eye.place[2],
        })
    }

    /// How near a ray meets it; what is not above 0 is no meeting.
    #[inline]
    pub(crate) fn met(&self, ray: Triple) -> f64 {
        let near = ray[2] * self.scale;
        let x = (self.place[0] * near + ray[0]).abs();
        let y = (self.place[1] * near + ray[1]).abs();
        let within = x <= self.half[0] * near && y <= self.half[1] * near;
        if within { near } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn eye(height_m: f64) -> LocalEye {
        LocalEye {
            place: [0.5, 0.0, height_m],
            across: [0.0; 3],
            down: [0.0; 3],
            ahead: [0.0; 3],
        }
    }

    #[test]
    fn a_plane_is_met_from_above_and_within_its_size() {
        let plane = PlaneAhead::new(&eye(2.0), [1.0, 0.0]).unwrap();
        assert_eq!(plane.met([0.0, 0.0, -1.0]), 0.5);
        assert_eq!(plane.met([0.2, 9.0, -1.0]), 0.5);
        assert_eq!(plane.met([0.3, 9.0, -1.0]), 0.0);
        assert!(plane.met([0.0, 0.0, 1.0]) <= 0.0);
    }

    #[test]
    fn a_plane_is_not_met_from_below() {
        assert!(PlaneAhead::new(&eye(-1.0), [0.0; 2]).is_none());
    }
}
