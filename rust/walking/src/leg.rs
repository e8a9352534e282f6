//! A leg of six joints and its inverse kinematics in closed form.

use nalgebra::{Isometry3, Matrix3, Vector2, Vector3};
use robot::{Body, Side};

use crate::WalkError;
use crate::leg_geometry::LegGeometry;

/// A leg whose yaw, roll and pitch axes meet in the hip and whose pitch and roll axes meet in the ankle, thigh and shank straight
/// below each other at joint angles zero.
#[derive(Debug, Clone)]
pub struct Leg {
    joints: [usize; 6],
    geometry: LegGeometry,
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
        let geometry = LegGeometry::read(body, side)?;
        Ok(Self {
            joints: *body.leg_joints(side),
            max_length_m: max_extension * (geometry.thigh_m + geometry.shank_m),
            geometry,
        })
    }

    /// Indices of its joints, from the hip down.
    pub const fn joints(&self) -> &[usize; 6] {
        &self.joints
    }

    /// Centre of the hip in the torso, m.
    pub const fn hip(&self) -> &Vector3<f64> {
        &self.geometry.hip
    }

    /// Longest distance from hip to ankle, m.
    pub const fn max_length_m(&self) -> f64 {
        self.max_length_m
    }

    /// Height of the ankle over the sole, m.
    pub fn ankle_height_m(&self) -> f64 {
        self.geometry.ankle_in_sole.z
    }

    /// The ankle over the ground when the sole is level at `foot`, m.
    pub fn ankle_in_plan(&self, foot: &geometry::PlanarPose) -> Vector2<f64> {
        let (x, y) = foot.apply(self.geometry.ankle_in_sole.x, self.geometry.ankle_in_sole.y);
        Vector2::new(x, y)
    }

    /// The joint angles that put the sole at `torso_from_sole`. Closed form of Kajita et al., Introduction to Humanoid Robotics,
    /// section 2.5.1: the knee from the law of cosines, the ankle from the direction to the hip, the hip from the rest.
    pub fn solve(&self, torso_from_sole: &Isometry3<f64>) -> LegAngles {
        let rotation = torso_from_sole.rotation.to_rotation_matrix().into_inner();
        let ankle = torso_from_sole.translation.vector + rotation * self.geometry.ankle_in_sole;
        let ankle_to_hip = rotation.transpose() * (self.geometry.hip - ankle);
        let wanted_m = ankle_to_hip.norm();
        let shortest_m =
            (self.geometry.thigh_m - self.geometry.shank_m).abs() + 0.05 * self.geometry.thigh_m;
        let length_m = wanted_m.clamp(shortest_m, self.max_length_m);
        let (a, b) = (self.geometry.thigh_m, self.geometry.shank_m);
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
            let turned = *angle * self.geometry.signs[slot];
            let [low, high] = self.geometry.ranges_rad[slot];
            *angle = turned.clamp(low, high);
            reached &= *angle == turned;
        }
        LegAngles {
            angles_rad,
            reached,
        }
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
