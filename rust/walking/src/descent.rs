//! Where the foot that stands carries while the other one is put down on a lower level.
//!
//! With the weight over the middle of the upper foot, the leg that goes ahead and down leans back so far that its ankle may come to its end
//! before the sole is level. Then the hips have to come down a long way, and the upper leg bends deep. With the weight further forward over
//! the same foot the leg ahead is steeper, as far as the ankle that stands can hold that.

use geometry::GRAVITY_MPS2;
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector2, Vector3};
use robot::{Body, LinkPoses, Side};

use crate::config::GaitConfig;
use crate::error::WalkError;
use crate::leg::LegSolver;
use crate::phase::{FootPose, Manner, Swing};
use crate::tuning::DescentTuning;

/// What of a robot's legs says how far forward the weight goes.
#[derive(Debug, Clone, Copy)]
pub struct Descent {
    /// A step down that is lower than this is none, m.
    level_m: f64,
    /// How far the hips are ahead of the centre of mass of an upright robot, m.
    hips_ahead_m: f64,
    legs: [DescendingLeg; 2],
}

#[derive(Debug, Clone, Copy)]
#[expect(clippy::struct_field_names, reason = "all three are lengths")]
struct DescendingLeg {
    /// How far ahead of the sole's middle the ankle is, m.
    ankle_ahead_m: f64,
    /// How far ahead of its hip the ankle may be with a stretched leg and a level sole, m.
    reach_m: f64,
    /// How far ahead of the ankle all the weight may be, m.
    lever_m: f64,
}

impl Descent {
    /// Reads it from the body, whose joints are at `rest_rad` in the upright stance.
    ///
    /// # Errors
    ///
    /// A leg does not fit the inverse kinematics.
    pub fn read(body: &Body, config: &GaitConfig, rest_rad: &[f64]) -> Result<Self, WalkError> {
        let tuning = &config.tuning;
        let mut poses = LinkPoses::default();
        body.pose_links(rest_rad, &mut poses)?;
        let com = body.center_of_mass_in_torso(&poses);
        let mut hips_ahead_m = 0.0;
        let mut read = |side| -> Result<DescendingLeg, WalkError> {
            let leg = LegSolver::new(body, side, config.max_extension, &tuning.leg)?;
            hips_ahead_m += 0.5 * (leg.hip().x - com.x);
            Ok(DescendingLeg {
                ankle_ahead_m: leg.ankle_in_sole().x,
                reach_m: reach_m(&leg, &tuning.descent),
                lever_m: tuning.descent.torque * ankle_torque_nm(body, &leg, &poses)
                    / (body.mass_kg() * GRAVITY_MPS2),
            })
        };
        let legs = [read(Side::Left)?, read(Side::Right)?];
        Ok(Self {
            level_m: tuning.listed.level,
            hips_ahead_m,
            legs,
        })
    }

    /// How much further forward than at `point` the foot that stands carries while `swing` is under way, m.
    pub fn ahead_m(&self, point: &Vector2<f64>, stance: &FootPose, swing: &Swing) -> f64 {
        let down = swing.to.z_m < stance.z_m - self.level_m;
        if swing.manner != Manner::Careful || !down {
            return 0.0;
        }
        let (goes, stands) = (swing.side.index(), swing.side.other().index());
        let to_stance = stance.planar.inverse();
        let (here_m, _) = to_stance.apply(point.x, point.y);
        let leg = &self.legs[goes];
        let (x, y) = swing.to.planar.apply(leg.ankle_ahead_m, 0.0);
        let (ankle_m, _) = to_stance.apply(x, y);
        let lacks_m = ankle_m - (here_m + self.hips_ahead_m) - leg.reach_m;
        let leg = &self.legs[stands];
        let left_m = leg.lever_m - (here_m - leg.ankle_ahead_m);
        lacks_m.min(left_m).max(0.0)
    }
}

/// How far ahead of its hip the ankle gets with the sole level, the leg as long as it may be, m.
fn reach_m(leg: &LegSolver, tuning: &DescentTuning) -> f64 {
    let length_m = tuning.stretched * leg.max_length_m;
    let reached = |ahead_m: f64| {
        let down_m = (length_m * length_m - ahead_m * ahead_m).max(0.0).sqrt();
        let ankle = leg.hip() + Vector3::new(ahead_m, 0.0, -down_m);
        let sole = Translation3::from(ankle - leg.ankle_in_sole());
        leg.solve(
            &Isometry3::from_parts(sole, UnitQuaternion::identity()),
            leg.rest_rad(),
        )
        .reached
    };
    let (mut near_m, mut far_m) = (0.0, length_m);
    for _ in 0..tuning.halvings {
        let middle_m = 0.5 * (near_m + far_m);
        if reached(middle_m) {
            near_m = middle_m;
        } else {
            far_m = middle_m;
        }
    }
    near_m
}

/// The peak torque about the y axis of the sole of the joints below the knee, N m.
fn ankle_torque_nm(body: &Body, leg: &LegSolver, poses: &LinkPoses) -> f64 {
    let joints = &leg.joints()[leg.knee_slot() + 1..];
    joints
        .iter()
        .filter_map(|&joint| body.hinge(joint))
        .map(|(link, hinge)| {
            let axis = poses.torso_from_link[link].rotation * Vector3::from(hinge.axis).normalize();
            hinge.peak_torque * axis.y.abs()
        })
        .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::stance::UprightStance;
    use crate::test_biped::{biped, config, description, foot_at};

    const HALF_WIDTH_M: f64 = 0.0425;
    const ANKLE_PITCHES: [usize; 2] = [5, 11];

    /// The biped, its ankles stretching the foot by this angle at most.
    fn stretching(most_rad: f64) -> Body {
        let mut described = description();
        for link in ANKLE_PITCHES {
            let joint = described.links[link].joint.as_mut().unwrap();
            assert!(joint.name.ends_with("ankle_pitch"), "{}", joint.name);
            joint.range = [-1.4, most_rad];
        }
        Body::new(described).unwrap()
    }

    fn descent(body: &Body) -> Descent {
        let rest = UprightStance::upright(body, &config().tuning.leg)
            .unwrap()
            .rest;
        Descent::read(body, &config(), &rest).unwrap()
    }

    /// How far forward the right foot carries while the left one goes there.
    fn ahead_m(descent: &Descent, forward_m: f64, up_m: f64, manner: Manner) -> f64 {
        let (stance, mut to) = (
            foot_at(0.0, -HALF_WIDTH_M),
            foot_at(forward_m, HALF_WIDTH_M),
        );
        to.z_m = up_m;
        let swing = Swing::new(Side::Left, manner, foot_at(0.0, HALF_WIDTH_M), to);
        descent.ahead_m(&Vector2::new(0.0, -HALF_WIDTH_M), &stance, &swing)
    }

    #[test]
    fn ankles_that_bend_far_enough_leave_the_weight_where_it_is() {
        assert_eq!(
            ahead_m(&descent(&biped()), 0.12, -0.04, Manner::Careful),
            0.0
        );
    }

    #[test]
    fn only_careful_steps_down_take_the_weight_ahead() {
        let descent = descent(&stretching(0.1));
        assert!(ahead_m(&descent, 0.12, -0.04, Manner::Careful) > 0.0);
        assert_eq!(ahead_m(&descent, 0.12, -0.04, Manner::Walk), 0.0);
        assert_eq!(ahead_m(&descent, 0.12, 0.0, Manner::Careful), 0.0);
        assert_eq!(ahead_m(&descent, 0.12, 0.04, Manner::Careful), 0.0);
    }

    proptest! {
        #[test]
        fn the_weight_goes_as_far_ahead_as_the_ankle_lacks_or_the_one_that_stands_can_hold(
            most_rad in 0.0..0.6f64, forward_m in 0.0..0.14f64,
        ) {
            let descent = descent(&stretching(most_rad));
            let [left, right] = &descent.legs;
            let ahead_m = ahead_m(&descent, forward_m, -0.04, Manner::Careful);
            let hip_m = ahead_m + descent.hips_ahead_m;
            let lacks_m = forward_m + left.ankle_ahead_m - hip_m - left.reach_m;
            let held_m = right.lever_m + right.ankle_ahead_m - ahead_m;
            prop_assert!(ahead_m >= 0.0 && held_m >= 0.0);
            prop_assert!(lacks_m < 1e-9 || held_m < 1e-9, "{lacks_m} {held_m}");
            prop_assert!(ahead_m == 0.0 || lacks_m > -1e-9);
        }
    }
}
