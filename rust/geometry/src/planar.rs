//! A pose on level ground: x, y and heading.

use serde::{Deserialize, Serialize};

use crate::wrap_angle;

/// Position and heading on the ground; composes like a pose, cheap enough for footsteps.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct PlanarPose {
    /// Metres along the frame's x.
    pub x_m: f64,
    /// Metres along the frame's y.
    pub y_m: f64,
    /// Heading, counter-clockwise from x, radians.
    pub yaw_rad: f64,
}

impl PlanarPose {
    /// A pose from its coordinates.
    pub const fn new(x_m: f64, y_m: f64, yaw_rad: f64) -> Self {
        Self { x_m, y_m, yaw_rad }
    }

    /// `self * local`: the pose that is `local` as seen from `self`.
    #[must_use]
    pub fn compose(&self, local: &Self) -> Self {
        let (x_m, y_m) = self.apply(local.x_m, local.y_m);
        Self {
            x_m,
            y_m,
            yaw_rad: wrap_angle(self.yaw_rad + local.yaw_rad),
        }
    }

    /// Coordinates of a local point in the frame that `self` is given in.
    pub fn apply(&self, x_m: f64, y_m: f64) -> (f64, f64) {
        let (sin, cos) = self.yaw_rad.sin_cos();
        (
            self.x_m + cos * x_m - sin * y_m,
            self.y_m + sin * x_m + cos * y_m,
        )
    }

    /// Turns the pose round: source in target.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let (sin, cos) = self.yaw_rad.sin_cos();
        Self {
            x_m: -cos * self.x_m - sin * self.y_m,
            y_m: sin * self.x_m - cos * self.y_m,
            yaw_rad: wrap_angle(-self.yaw_rad),
        }
    }

    /// `other` as seen from `self`.
    #[must_use]
    pub fn relative(&self, other: &Self) -> Self {
        self.inverse().compose(other)
    }

    /// Distance between the two positions, metres.
    pub fn distance_m(&self, other: &Self) -> f64 {
        (self.x_m - other.x_m).hypot(self.y_m - other.y_m)
    }
}

/// Distance between two places, m.
pub fn distance_m(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn pose() -> impl Strategy<Value = PlanarPose> {
        (-5.0..5.0f64, -5.0..5.0f64, -3.0..3.0f64)
            .prop_map(|(x, y, yaw)| PlanarPose::new(x, y, yaw))
    }

    proptest! {
        #[test]
        fn relative_undoes_compose(a in pose(), b in pose()) {
            let back = a.relative(&a.compose(&b));
            prop_assert!(back.distance_m(&b) < 1e-12);
            prop_assert!(wrap_angle(back.yaw_rad - b.yaw_rad).abs() < 1e-12);
        }
    }
}
