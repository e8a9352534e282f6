//! What the encoders between the soles and the inertial measurement unit are wrong by in roll and pitch.
//!
//! Offsets of the trunk's and the legs' encoders and the accelerometer's bias tilt the torso against gravity; a tilt of one
//! degree lets a step of 8 cm climb by 1.4 mm. While the robot stands at the start, its soles lie on level ground.

use nalgebra::{UnitQuaternion, Vector3};

/// A small rotation without yaw, learned as a running mean.
#[derive(Debug, Clone)]
pub(crate) struct Levelling {
    /// To be applied from the left to the measured `torso_from_imu`.
    pub(crate) correction: UnitQuaternion<f64>,
    learned_s: f64,
}

impl Levelling {
    pub(crate) fn new() -> Self {
        Self {
            correction: UnitQuaternion::identity(),
            learned_s: 0.0,
        }
    }

    /// Whether standing still teaches it something yet.
    pub(crate) fn is_learning(&self, level_time_s: f64) -> bool {
        self.learned_s < level_time_s
    }

    /// Takes in the vertical as the inertial measurement unit and as the soles see it, both in the torso's frame.
    pub(crate) fn learn(
        &mut self,
        up_by_imu: &Vector3<f64>,
        up_by_soles: &Vector3<f64>,
        passed_s: f64,
        limit_rad: f64,
    ) {
        let Some(whole) = UnitQuaternion::rotation_between(up_by_imu, up_by_soles) else {
            return;
        };
        if whole.angle() > limit_rad || passed_s <= 0.0 {
            return;
        }
        self.learned_s += passed_s;
        self.correction = self.correction.nlerp(&whole, passed_s / self.learned_s);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_tilt_between_soles_and_imu_is_found(roll in -0.03..0.03f64, pitch in -0.03..0.03f64) {
            let error = UnitQuaternion::from_euler_angles(roll, pitch, 0.0);
            let mut levelling = Levelling::new();
            for _ in 0..50 {
                levelling.learn(&(error.inverse() * Vector3::z()), &Vector3::z(), 0.01, 0.06);
            }
            let up = levelling.correction * (error.inverse() * Vector3::z());
            prop_assert!(up.angle(&Vector3::z()) < 1e-7);
        }
    }

    #[test]
    fn a_slope_is_not_taken_for_an_encoder_error() {
        let mut levelling = Levelling::new();
        let slope = UnitQuaternion::from_euler_angles(0.0, 0.1, 0.0) * Vector3::z();
        levelling.learn(&Vector3::z(), &slope, 0.01, 0.06);
        assert_eq!(levelling.correction, UnitQuaternion::identity());
        assert!(levelling.is_learning(0.01));
    }
}
