//! A leg of six joints and its inverse kinematics in closed form.

use nalgebra::{Isometry3, Matrix3, Vector2, Vector3};
use robot::{Body, LinkPoses, Side};

use crate::WalkError;

/// A deviation from the assumed geometry that does not matter, m or sine of an angle.
const TOLERANCE: f64 = 1e-6;

/// A leg whose yaw, roll and pitch axes meet in the hip and whose pitch and roll axes meet in the ankle, thigh and shank straight
/// below each other at joint angles zero.
#[derive(Debug, Clone)]
pub struct Leg {
    joints: [usize; 6],
    signs: [f64; 6],
    ranges_rad: [[f64; 2]; 6],
    hip: Vector3<f64>,
    thigh_m: f64,
    shank_m: f64,
    ankle_in_sole: Vector3<f64>,
    max_length_m: f64,
}

/// Joint angles of a leg, from the hip down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegAngles {
    /// Hip yaw, roll, pitch, knee, ankle pitch, ankle roll, rad; within the joints' ranges.
    pub angles_rad: [f64; 6],
    /// Whether the sole gets where it should; else it comes as near as length and ranges let it.
    pub reached: bool,
}

impl Leg {
    /// Reads a leg's geometry from the body; fails where the closed form does not hold for it. The leg gets no longer than
    /// `max_extension` of its straight length.
    pub fn new(body: &Body, side: Side, max_extension: f64) -> Result<Self, WalkError> {
        let mut poses = LinkPoses::default();
        body.pose_links(&vec![0.0; body.joint_count()], &mut poses)?;
        let joints = *body.leg_joints(side);
        let refuse = |what: String| WalkError::Leg { side, what };
        let mut anchors = [Vector3::zeros(); 6];
        let mut signs = [1.0; 6];
        let mut ranges_rad = [[0.0; 2]; 6];
        let wanted = [
            Vector3::z(),
            Vector3::x(),
            Vector3::y(),
            Vector3::y(),
            Vector3::y(),
            Vector3::x(),
        ];
        for (slot, &joint) in joints.iter().enumerate() {
            let (link, description) = body.hinge(joint).ok_or_else(|| {
                refuse(format!("its joint {} turns no link", slot + 1))
            })?;
            let pose = &poses.torso_from_link[link];
            let axis = pose.rotation * Vector3::from(description.axis).normalize();
            let along = axis.dot(&wanted[slot]);
            if along.abs() < 1.0 - TOLERANCE {
                return Err(refuse(format!(
                    "the axis of `{}` must be along {} at zero, got [{:.3}, {:.3}, {:.3}]",
                    description.name,
                    ["z", "x", "y", "y", "y", "x"][slot],
                    axis.x,
                    axis.y,
                    axis.z
                )));
            }
            signs[slot] = along.signum();
            ranges_rad[slot] = description.range;
            anchors[slot] = (pose * nalgebra::Point3::from(description.anchor)).coords;
        }
        // A point may be moved along an axis of its own: what counts is where the axes meet.
        let hip = Vector3::new(anchors[0].x, anchors[1].y, anchors[1].z);
        let knee = Vector3::new(anchors[3].x, hip.y, anchors[3].z);
        let ankle = Vector3::new(anchors[4].x, anchors[5].y, anchors[4].z);
        let near = |a: f64, b: f64| (a - b).abs() < TOLERANCE;
        let meets = [
            (near(anchors[0].y, hip.y) && near(anchors[2].x, hip.x) && near(anchors[2].z, hip.z), "yaw, roll and pitch of the hip must meet in a point"),
            (near(knee.x, hip.x) && knee.z < hip.z, "the knee must lie below the hip"),
            (near(ankle.x, knee.x) && ankle.z < knee.z, "the ankle must lie below the knee"),
            (near(ankle.y, hip.y) && near(anchors[5].z, ankle.z), "pitch and roll of the ankle must meet in a point below the hip"),
        ];
        for (holds, what) in meets {
            if !holds {
                return Err(refuse(what.to_owned()));
            }
        }
        let torso_from_sole = body.torso_from_sole(&poses, side);
        if torso_from_sole.rotation.angle() > TOLERANCE {
            return Err(refuse("the sole must be level at zero".to_owned()));
        }
        let (thigh_m, shank_m) = (hip.z - knee.z, knee.z - ankle.z);
        Ok(Self {
            joints,
            signs,
            ranges_rad,
            hip,
            thigh_m,
            shank_m,
            ankle_in_sole: ankle - torso_from_sole.translation.vector,
            max_length_m: max_extension * (thigh_m + shank_m),
        })
    }

    /// Indices of its joints, from the hip down.
    pub const fn joints(&self) -> &[usize; 6] {
        &self.joints
    }

    /// Centre of the hip in the torso, m.
    pub const fn hip(&self) -> &Vector3<f64> {
        &self.hip
    }

    /// Longest distance from hip to ankle, m.
    pub const fn max_length_m(&self) -> f64 {
        self.max_length_m
    }

    /// Height of the ankle over the sole, m.
    pub fn ankle_height_m(&self) -> f64 {
        self.ankle_in_sole.z
    }

    /// The ankle over the ground when the sole is level at `foot`, m.
    pub fn ankle_in_plan(&self, foot: &geometry::PlanarPose) -> Vector2<f64> {
        let (x, y) = foot.apply(self.ankle_in_sole.x, self.ankle_in_sole.y);
        Vector2::new(x, y)
    }

    /// The joint angles that put the sole at `torso_from_sole`. Closed form of Kajita et al., Introduction to Humanoid Robotics,
    /// section 2.5.1: the knee from the law of cosines, the ankle from the direction to the hip, the hip from the rest.
    pub fn solve(&self, torso_from_sole: &Isometry3<f64>) -> LegAngles {
        let rotation = torso_from_sole.rotation.to_rotation_matrix().into_inner();
        let ankle = torso_from_sole.translation.vector + rotation * self.ankle_in_sole;
        let ankle_to_hip = rotation.transpose() * (self.hip - ankle);
        let wanted_m = ankle_to_hip.norm();
        let shortest_m = (self.thigh_m - self.shank_m).abs() + 0.05 * self.thigh_m;
        let length_m = wanted_m.clamp(shortest_m, self.max_length_m);
        let (a, b) = (self.thigh_m, self.shank_m);
        let inner = ((a * a + b * b - length_m * length_m) / (2.0 * a * b)).clamp(-1.0, 1.0);
        let knee = std::f64::consts::PI - inner.acos();
        let lean = (a / length_m * knee.sin()).clamp(-1.0, 1.0).asin();
        let (x, y, z) = (ankle_to_hip.x, ankle_to_hip.y, ankle_to_hip.z);
        let ankle_roll = y.atan2(z);
        let ankle_pitch = -x.atan2(y.hypot(z) * z.signum()) - lean;
        let hip = rotation * rotation_x(-ankle_roll) * rotation_y(-knee - ankle_pitch);
        let hip_yaw = (-hip[(0, 1)]).atan2(hip[(1, 1)]);
        let (sin, cos) = hip_yaw.sin_cos();
        let hip_roll = hip[(2, 1)].atan2(-hip[(0, 1)] * sin + hip[(1, 1)] * cos);
        let hip_pitch = (-hip[(2, 0)]).atan2(hip[(2, 2)]);
        let mut angles_rad = [hip_yaw, hip_roll, hip_pitch, knee, ankle_pitch, ankle_roll];
        let mut reached = (wanted_m - length_m).abs() < 1e-9;
        for (slot, angle) in angles_rad.iter_mut().enumerate() {
            let turned = *angle * self.signs[slot];
            let [low, high] = self.ranges_rad[slot];
            *angle = turned.clamp(low, high);
            reached &= *angle == turned;
        }
        LegAngles { angles_rad, reached }
    }
}

fn rotation_x(angle_rad: f64) -> Matrix3<f64> {
    let (s, c) = angle_rad.sin_cos();
    Matrix3::new(1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c)
}

fn rotation_y(angle_rad: f64) -> Matrix3<f64> {
    let (s, c) = angle_rad.sin_cos();
    Matrix3::new(c, 0.0, s, 0.0, 1.0, 0.0, -s, 0.0, c)
}
