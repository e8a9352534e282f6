//! A leg of six joints and its inverse kinematics in closed form. Its yaw axis may slant sideways, and its yaw angle may be given.

use nalgebra::{Isometry3, Matrix3, Vector2, Vector3};
use robot::{Body, Side};

use crate::{error::WalkError, leg_geometry::LegGeometry, tuning::LegTuning};

/// A leg whose yaw, roll and pitch axes meet in the hip and whose pitch and roll axes meet in the ankle, thigh and shank straight
/// below each other at joint angles zero.
#[derive(Debug, Clone)]
pub struct LegSolver {
    joints: [usize; 6],
    geometry: LegGeometry,
    /// Longest distance from hip to ankle, m.
    pub(crate) max_length_m: f64,
    shortest_m: f64,
}

/// Joint angles of a leg, from the hip down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegAngles {
    /// Hip yaw, roll, pitch, knee, ankle pitch, ankle roll, rad; within the joints' ranges.
    pub angles_rad: [f64; 6],
    /// Whether the sole gets where it should; else it comes as near as length and ranges let it.
    pub reached: bool,
    /// How much further away from the hip the ankle should be than the leg is long, m.
    pub short_m: f64,
}

/// The triangle of hip, knee and ankle.
#[derive(Debug, Clone, Copy)]
struct Bend {
    /// Distance of hip and ankle, m.
    distance_m: f64,
    /// Angle of the knee, 0 when it is straight, rad.
    knee_rad: f64,
    reached: bool,
    short_m: f64,
}

impl LegSolver {
    /// Reads a leg's geometry from the body; fails where the closed form does not hold for it. The leg gets no longer than
    /// `max_extension` of its straight length.
    pub fn new(
        body: &Body,
        side: Side,
        max_extension: f64,
        tuning: &LegTuning,
    ) -> Result<Self, WalkError> {
        let geometry = LegGeometry::read(body, side, tuning)?;
        let (a, b) = (geometry.thigh_m, geometry.shank_m);
        Ok(Self {
            joints: *body.leg_joints(side),
            max_length_m: max_extension * (geometry.thigh_m + geometry.shank_m),
            shortest_m: (a - b).abs() + tuning.shortest * a,
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

    /// From hip to knee, and from knee to ankle, m.
    pub const fn lengths_m(&self) -> (f64, f64) {
        (self.geometry.thigh_m, self.geometry.shank_m)
    }

    /// The greatest height of the hip over an ankle that is `back_m` behind and `aside_m` beside it at which the thigh stretches back by
    /// no more than `stretch_rad`: the knee bends until the shank makes up for the rest.
    pub fn stretched_m(&self, back_m: f64, aside_m: f64, stretch_rad: f64) -> f64 {
        let (thigh_m, shank_m) = (self.geometry.thigh_m, self.geometry.shank_m);
        let (sin, cos) = stretch_rad.sin_cos();
        if back_m <= (thigh_m + shank_m) * sin {
            return f64::INFINITY;
        }
        let left_m = (back_m - thigh_m * sin).min(shank_m);
        let along_m = thigh_m * cos + (shank_m * shank_m - left_m * left_m).sqrt();
        (along_m * along_m - aside_m * aside_m).max(0.0).sqrt()
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
        let (angles_rad, bend) = self.solve_freely(torso_from_sole);
        self.within_ranges(angles_rad, &bend)
    }

    /// Angles about positive axes, whatever the joints' ranges are, and how the leg bends.
    fn solve_freely(&self, torso_from_sole: &Isometry3<f64>) -> ([f64; 6], Bend) {
        let rotation = torso_from_sole.rotation.to_rotation_matrix().into_inner();
        let ankle = torso_from_sole.translation.vector + rotation * self.geometry.ankle_in_sole;
        let ankle_to_hip = rotation.transpose() * (self.geometry.hip - ankle);
        let bend = self.bend(ankle_to_hip.norm());
        let knee = bend.knee_rad;
        let lean = (self.geometry.thigh_m / bend.distance_m * knee.sin())
            .clamp(-1.0, 1.0)
            .asin();
        let (x, y, z) = (ankle_to_hip.x, ankle_to_hip.y, ankle_to_hip.z);
        let ankle_roll = y.atan2(z);
        let ankle_pitch = -x.atan2(y.hypot(z) * z.signum()) - lean;
        let hip = rotation_x(-self.geometry.slant_rad)
            * rotation
            * rotation_x(-ankle_roll)
            * rotation_y(-knee - ankle_pitch);
        let hip_yaw = (-hip[(0, 1)]).atan2(hip[(1, 1)]);
        let (sin, cos) = hip_yaw.sin_cos();
        let hip_roll = hip[(2, 1)].atan2(-hip[(0, 1)] * sin + hip[(1, 1)] * cos);
        let hip_pitch = (-hip[(2, 0)]).atan2(hip[(2, 2)]);
        let hip_roll = hip_roll + self.geometry.slant_rad;
        (
            [hip_yaw, hip_roll, hip_pitch, knee, ankle_pitch, ankle_roll],
            bend,
        )
    }

    /// The angle of the yaw joint that [`Self::solve`] would like, without regard to its range, rad.
    pub fn wanted_yaw_rad(&self, torso_from_sole: &Isometry3<f64>) -> f64 {
        self.solve_freely(torso_from_sole).0[0] * self.geometry.signs[0]
    }

    /// How much the angle of the yaw joint has to grow by a turn of the torso to the left.
    pub fn yaw_per_turn(&self) -> f64 {
        -self.geometry.signs[0] / self.geometry.slant_rad.cos()
    }

    /// The joint angles that put the ankle where it is at `torso_from_sole` and the sole as level as there, the yaw joint being
    /// held at `yaw_rad`: where the sole points to follows. The hip's roll turns the leg's plane to the ankle, knee and hip pitch
    /// reach it within, the ankle turns the sole's normal.
    pub fn solve_turned(&self, torso_from_sole: &Isometry3<f64>, yaw_rad: f64) -> LegAngles {
        let geometry = &self.geometry;
        let rotation = torso_from_sole.rotation.to_rotation_matrix().into_inner();
        let ankle = torso_from_sole.translation.vector + rotation * geometry.ankle_in_sole;
        let yaw = yaw_rad * geometry.signs[0];
        let turned = rotation_x(geometry.slant_rad) * rotation_z(yaw);
        // In the frame behind the yaw joint, its own axis upright: the roll from here is the slant less.
        let to_ankle = turned.transpose() * (ankle - geometry.hip);
        let roll = to_ankle.y.atan2(-to_ankle.z);
        let bend = self.bend(to_ankle.norm());
        let knee = bend.knee_rad;
        let within = geometry.shank_m * knee.sin();
        let below = geometry.thigh_m + geometry.shank_m * knee.cos();
        let drop = to_ankle.y.hypot(to_ankle.z);
        let pitch = (-to_ankle.x).atan2(drop) - within.atan2(below);
        let shank = turned * rotation_x(roll) * rotation_y(pitch + knee);
        let normal = shank.transpose() * (rotation * Vector3::z());
        let ankle_pitch = normal.x.atan2(normal.z);
        let ankle_roll = -normal.y.clamp(-1.0, 1.0).asin();
        self.within_ranges(
            [
                yaw,
                roll + geometry.slant_rad,
                pitch,
                knee,
                ankle_pitch,
                ankle_roll,
            ],
            &bend,
        )
    }

    fn bend(&self, wanted_m: f64) -> Bend {
        let (a, b) = (self.geometry.thigh_m, self.geometry.shank_m);
        let distance_m = wanted_m.clamp(self.shortest_m, self.max_length_m);
        let inner = ((a * a + b * b - distance_m * distance_m) / (2.0 * a * b)).clamp(-1.0, 1.0);
        Bend {
            distance_m,
            knee_rad: std::f64::consts::PI - inner.acos(),
            reached: (wanted_m - distance_m).abs() < 1e-9,
            short_m: (wanted_m - distance_m).max(0.0),
        }
    }

    /// Angles about positive axes as the joints count them, clamped to what they can.
    fn within_ranges(&self, mut angles_rad: [f64; 6], bend: &Bend) -> LegAngles {
        let mut reached = bend.reached;
        for (slot, angle) in angles_rad.iter_mut().enumerate() {
            let turned = *angle * self.geometry.signs[slot];
            let [low, high] = self.geometry.ranges_rad[slot];
            *angle = turned.clamp(low, high);
            reached &= *angle == turned;
        }
        LegAngles {
            angles_rad,
            reached,
            short_m: bend.short_m,
        }
    }
}

fn rotation_x(angle_rad: f64) -> Matrix3<f64> {
    let (s, c) = angle_rad.sin_cos();
    Matrix3::new(1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c)
}

fn rotation_z(angle_rad: f64) -> Matrix3<f64> {
    let (s, c) = angle_rad.sin_cos();
    Matrix3::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0)
}

fn rotation_y(angle_rad: f64) -> Matrix3<f64> {
    let (s, c) = angle_rad.sin_cos();
    Matrix3::new(c, 0.0, s, 0.0, 1.0, 0.0, -s, 0.0, c)
}

#[cfg(test)]
#[path = "leg_tests.rs"]
mod tests;
