//! What the closed form of the inverse kinematics needs of a leg, read from the body's description and checked.

use nalgebra::{Point3, Vector3};
use robot::{Body, LinkPoses, Side};

use crate::{error::WalkError, leg_sizes::LegSizes, tuning::LegTuning};

/// A deviation from the assumed geometry that is that of rounding in a description, sine of an angle.
const TOLERANCE: f64 = 1e-6;
/// Axes at zero from the hip down, behind the first: roll, pitch, knee, ankle pitch, ankle roll.
const AXES: [(&str, [f64; 3]); 5] = [
    ("x", [1.0, 0.0, 0.0]),
    ("y", [0.0, 1.0, 0.0]),
    ("y", [0.0, 1.0, 0.0]),
    ("y", [0.0, 1.0, 0.0]),
    ("x", [1.0, 0.0, 0.0]),
];

/// A leg at joint angles zero, in the torso's frame.
#[derive(Debug, Clone)]
pub(crate) struct LegGeometry {
    /// Sign of a joint: +1 where it turns about the positive axis, else -1.
    pub(crate) signs: [f64; 6],
    /// By how much the yaw axis is turned about x from upright, rad: its upper end slants to the right where positive.
    pub(crate) slant_rad: f64,
    /// Smallest and largest angle of each joint, rad.
    pub(crate) ranges_rad: [[f64; 2]; 6],
    /// Where yaw, roll and pitch meet, m.
    pub(crate) hip: Vector3<f64>,
    /// From hip to knee, m.
    pub(crate) thigh_m: f64,
    /// From knee to ankle, m.
    pub(crate) shank_m: f64,
    /// Where pitch and roll of the ankle meet, in the sole's frame, m.
    pub(crate) ankle_in_sole: Vector3<f64>,
}

impl LegGeometry {
    /// Reads a leg; what is within says why the closed form does not hold for it.
    pub(crate) fn read(
        body: &Body,
        side: Side,
        tuning: &LegTuning,
    ) -> Result<Result<Self, String>, WalkError> {
        let mut poses = LinkPoses::default();
        body.pose_links(&vec![0.0; body.joint_count()], &mut poses)?;
        Ok(Self::of_poses(body, side, tuning, &poses))
    }

    fn of_poses(
        body: &Body,
        side: Side,
        tuning: &LegTuning,
        poses: &LinkPoses,
    ) -> Result<Self, String> {
        let joints = body.leg_joints(side);
        if joints.len() != 1 + AXES.len() {
            return Err(format!("it has {} joints", joints.len()));
        }
        let mut anchors = [Vector3::zeros(); 6];
        let mut signs = [1.0; 6];
        let mut ranges_rad = [[0.0; 2]; 6];
        let mut slant_rad = 0.0;
        for (slot, &joint) in joints.iter().enumerate() {
            let (link, hinge) = body
                .hinge(joint)
                .ok_or_else(|| format!("its joint {} turns no link", slot + 1))?;
            let pose = &poses.torso_from_link[link];
            let axis = pose.rotation * Vector3::from(hinge.axis).normalize();
            if slot == 0 {
                (signs[0], slant_rad) = yaw_axis(&axis, tuning.steepest)
                    .ok_or_else(|| misses(&hinge.name, "be upright or slant sideways", &axis))?;
            } else {
                let (letter, wanted) = AXES[slot - 1];
                let along = axis.dot(&Vector3::from(wanted));
                if along.abs() < 1.0 - TOLERANCE {
                    let wanted = format!("be along {letter}");
                    return Err(misses(&hinge.name, &wanted, &axis));
                }
                signs[slot] = along.signum();
            }
            ranges_rad[slot] = hinge.range;
            anchors[slot] = (pose * Point3::from(hinge.anchor)).coords;
        }
        let [hip, knee, ankle] = meeting_points(&anchors, slant_rad, tuning.miss)?;
        let torso_from_sole = body.torso_from_sole(poses, side);
        if torso_from_sole.rotation.angle() > TOLERANCE {
            return Err("the sole must be level at zero".to_owned());
        }
        Ok(Self {
            signs,
            slant_rad,
            ranges_rad,
            hip,
            thigh_m: hip.z - knee.z,
            shank_m: knee.z - ankle.z,
            ankle_in_sole: ankle - torso_from_sole.translation.vector,
        })
    }

    /// How large it is.
    pub(crate) const fn sizes(&self) -> LegSizes {
        LegSizes {
            hip: self.hip,
            thigh_m: self.thigh_m,
            shank_m: self.shank_m,
            ankle_in_sole: self.ankle_in_sole,
        }
    }
}

/// The sign and the slant of a hip's yaw axis: it may lie in the plane of y and z, as a NAO's does.
fn yaw_axis(axis: &Vector3<f64>, steepest_rad: f64) -> Option<(f64, f64)> {
    let sign = axis.z.signum();
    let slant_rad = libm::atan2(-sign * axis.y, sign * axis.z);
    let holds = axis.x.abs() < TOLERANCE && slant_rad.abs() < steepest_rad;
    let upright = axis.z.abs() >= 1.0 - TOLERANCE;
    holds.then_some((sign, if upright { 0.0 } else { slant_rad }))
}

fn misses(joint: &str, wanted: &str, axis: &Vector3<f64>) -> String {
    format!(
        "the axis of `{joint}` must {wanted} at zero, got [{:.3}, {:.3}, {:.3}]",
        axis.x, axis.y, axis.z
    )
}

/// Hip, knee and ankle. An anchor may lie anywhere on its own axis: what counts is where the axes meet.
fn meeting_points(
    anchors: &[Vector3<f64>; 6],
    slant_rad: f64,
    miss_m: f64,
) -> Result<[Vector3<f64>; 3], String> {
    let [yaw, roll, pitch, knee, ankle_pitch, ankle_roll] = anchors;
    let hip = Vector3::new(yaw.x, roll.y, roll.z);
    let knee = Vector3::new(knee.x, hip.y, knee.z);
    let ankle = Vector3::new(ankle_pitch.x, ankle_roll.y, ankle_pitch.z);
    let yaw_y = yaw.y - libm::tan(slant_rad) * (hip.z - yaw.z);
    let near = |a: f64, b: f64| (a - b).abs() < miss_m;
    let claims = [
        (
            near(yaw_y, hip.y) && near(pitch.x, hip.x) && near(pitch.z, hip.z),
            "yaw, roll and pitch of the hip must meet in a point",
        ),
        (
            near(knee.x, hip.x) && knee.z < hip.z,
            "the knee must lie below the hip",
        ),
        (
            near(ankle.x, knee.x) && ankle.z < knee.z,
            "the ankle must lie below the knee",
        ),
        (
            near(ankle.y, hip.y) && near(ankle_roll.z, ankle.z),
            "pitch and roll of the ankle must meet in a point below the hip",
        ),
    ];
    match claims.iter().find(|(holds, _)| !holds) {
        Some((_, claim)) => Err((*claim).to_owned()),
        None => Ok([hip, knee, ankle]),
    }
}
