//! Where the foot that stands carries while the other one is put down on a lower level.
//!
//! With the weight over the middle of the upper foot, the leg that goes ahead and down leans back so far that its ankle may come to its end
//! before the sole is level. Then the hips have to come down a long way, and the upper leg bends deep. With the weight further forward over
//! the same foot the leg ahead is steeper, as far as the ankle that stands can hold that.

use geometry::GRAVITY_MPS2;
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector2};
use robot::{Body, LinkPoses, Side};

use crate::config::GaitConfig;
use crate::error::WalkError;
use crate::leg::LegSolver;
use crate::phase::{FootPose, Manner, Swing};
use crate::tuning::DescentTuning;

/// What of a robot's legs says how far forward the weight goes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Descent {
    /// A step down that is lower than this is none, m.
    level_m: f64,
    /// How far the hips are ahead of the centre of mass of an upright robot, m.
    hips_ahead_m: f64,
    legs: [DescendingLeg; 2],
}

#[derive(Debug, Clone, Copy)]
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
    pub(crate) fn read(
        body: &Body,
        config: &GaitConfig,
        rest_rad: &[f64],
    ) -> Result<Self, WalkError> {
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
    pub(crate) fn ahead_m(&self, point: &Vector2<f64>, stance: &FootPose, swing: &Swing) -> f64 {
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
        let ankle = leg.hip() + nalgebra::Vector3::new(ahead_m, 0.0, -down_m);
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
            let axis = poses.torso_from_link[link].rotation
                * nalgebra::Vector3::from(hinge.axis).normalize();
            hinge.peak_torque * axis.y.abs()
        })
        .fold(0.0, f64::max)
}
