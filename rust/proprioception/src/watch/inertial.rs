//! Claims: what an inertial unit measures never repeats itself; and its accelerometer feels gravity.

use geometry::GRAVITY_MPS2;
use nalgebra::Vector3;
use sensing::SenseFault;

use super::repair::Repair;
use super::{Check, Finding, Lasting, Moment};

fn finding(which: &str, what: String) -> Finding {
    Finding {
        fault: SenseFault::new(which, what),
        repair: Repair::Inertial,
    }
}

/// How long the unit has said the same.
#[derive(Debug, Clone, Default)]
pub(super) struct ConstantUnit {
    before: Option<([f64; 6], [[f64; 4]; 2])>,
    constant: Lasting,
}

impl Check for ConstantUnit {
    fn look(&mut self, moment: &Moment<'_>) -> Option<Finding> {
        let [a, b, c] = moment.observation.angular_velocity_radps;
        let [d, e, f] = moment.observation.specific_force_mps2;
        let now = [a, b, c, d, e, f];
        let forces_n = moment.observation.foot_forces_n;
        let (before, forces_before_n) = self.before.replace((now, forces_n))?;
        // Where nothing changes at all, it is no single sense.
        let same = now.map(f64::to_bits) == before.map(f64::to_bits) && forces_n != forces_before_n;
        let lasted_s = self.constant.count(same, moment.passed_s);
        if lasted_s <= moment.config.constant {
            return None;
        }
        Some(finding(
            "the inertial unit",
            if now == [0.0; 6] {
                "is dead: it reads zero in all axes".to_owned()
            } else {
                "is stuck: its readings do not change".to_owned()
            },
        ))
    }
}

/// The specific force, smoothed.
#[derive(Debug, Clone, Default)]
pub(super) struct Gravity {
    smooth_mps2: Option<Vector3<f64>>,
}

impl Check for Gravity {
    fn look(&mut self, moment: &Moment<'_>) -> Option<Finding> {
        let force_mps2 = Vector3::from(moment.observation.specific_force_mps2);
        let smooth_mps2 = self.smooth_mps2.get_or_insert(force_mps2);
        let passed_s = moment.passed_s;
        *smooth_mps2 +=
            (force_mps2 - *smooth_mps2) * (passed_s / (passed_s + moment.config.smooth));
        let strength_mps2 = smooth_mps2.norm();
        if (strength_mps2 - GRAVITY_MPS2).abs() <= moment.config.gravity {
            return None;
        }
        Some(finding(
            "the accelerometer",
            format!("feels {strength_mps2:.1} m/s^2 where gravity is {GRAVITY_MPS2:.1}"),
        ))
    }
}
