//! Inverse kinematics in closed form of a leg of six joints. Its yaw axis may slant sideways, and its yaw angle may be given.

use nalgebra::{Isometry3, Matrix3, Vector3};
use robot::MOST_LEG_JOINTS;

use crate::leg_angles::LegAngles;
use crate::leg_geometry::LegGeometry;

/// A leg whose yaw, roll and pitch axes meet in the hip and whose pitch and roll axes meet in the ankle, thigh and shank straight
/// below each other at joint angles zero.
#[derive(Debug, Clone)]
pub(crate) struct ClosedForm {
    geometry: LegGeometry,
    longest_m: f64,
    shortest_m: f64,
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

impl ClosedForm {
    /// Which joint is the knee.
    pub(crate) const KNEE: usize = 3;

    /// From hip to ankle it gets no longer than `longest_m` and no shorter than `shortest_m`.
    pub(crate) const fn new(geometry: LegGeometry, longest_m: f64, shortest_m: f64) -> Self {
        Self {
            geometry,
            longest_m,
            shortest_m,
        }
    }

    /// The joint angles that put the sole at `torso_from_sole`. Closed form of Kajita et al., Introduction to Humanoid Robotics,
    /// section 2.5.1: the knee from the law of cosines, the ankle from the direction to the hip, the hip from the rest.
    pub(crate) fn solve(&self, torso_from_sole: &Isometry3<f64>) -> LegAngles {
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
        let lean = libm::asin(
            (self.geometry.thigh_m / bend.distance_m * libm::sin(knee)).clamp(-1.0, 1.0),
        );
        let (x, y, z) = (ankle_to_hip.x, ankle_to_hip.y, ankle_to_hip.z);
        let ankle_roll = libm::atan2(y, z);
        let ankle_pitch = -libm::atan2(x, geometry::hypot(y, z) * z.signum()) - lean;
        let hip = rotation_x(-self.geometry.slant_rad)
            * rotation
            * rotation_x(-ankle_roll)
            * rotation_y(-knee - ankle_pitch);
        let hip_yaw = libm::atan2(-hip[(0, 1)], hip[(1, 1)]);
        let (sin, cos) = libm::sincos(hip_yaw);
        let hip_roll = libm::atan2(hip[(2, 1)], -hip[(0, 1)] * sin + hip[(1, 1)] * cos);
        let hip_pitch = libm::atan2(-hip[(2, 0)], hip[(2, 2)]);
        let hip_roll = hip_roll + self.geometry.slant_rad;
        (
            [hip_yaw, hip_roll, hip_pitch, knee, ankle_pitch, ankle_roll],
            bend,
        )
    }

    /// The angle of the yaw joint that [`Self::solve`] would like, without regard to its range, rad.
    pub(crate) fn wanted_yaw_rad(&self, torso_from_sole: &Isometry3<f64>) -> f64 {
        self.solve_freely(torso_from_sole).0[0] * self.geometry.signs[0]
    }

    /// How much the angle of the yaw joint has to grow by a turn of the torso to the left.
    pub(crate) fn yaw_per_turn(&self) -> f64 {
        -self.geometry.signs[0] / libm::cos(self.geometry.slant_rad)
    }

    /// The joint angles that put the ankle where it is at `torso_from_sole` and the sole as level as there, the yaw joint being
    /// held at `yaw_rad`: where the sole points to follows. The hip's roll turns the leg's plane to the ankle, knee and hip pitch
    /// reach it within, the ankle turns the sole's normal.
    pub(crate) fn solve_turned(&self, torso_from_sole: &Isometry3<f64>, yaw_rad: f64) -> LegAngles {
        let geometry = &self.geometry;
        let rotation = torso_from_sole.rotation.to_rotation_matrix().into_inner();
        let ankle = torso_from_sole.translation.vector + rotation * geometry.ankle_in_sole;
        let yaw = yaw_rad * geometry.signs[0];
        let turned = rotation_x(geometry.slant_rad) * rotation_z(yaw);
        // In the frame behind the yaw joint, its own axis upright: the roll from here is the slant less.
        let to_ankle = turned.transpose() * (ankle - geometry.hip);
        let roll = libm::atan2(to_ankle.y, -to_ankle.z);
        let bend = self.bend(to_ankle.norm());
        let knee = bend.knee_rad;
        let within = geometry.shank_m * libm::sin(knee);
        let below = geometry.thigh_m + geometry.shank_m * libm::cos(knee);
        let drop = geometry::hypot(to_ankle.y, to_ankle.z);
        let pitch = libm::atan2(-to_ankle.x, drop) - libm::atan2(within, below);
        let shank = turned * rotation_x(roll) * rotation_y(pitch + knee);
        let normal = shank.transpose() * (rotation * Vector3::z());
        let ankle_pitch = libm::atan2(normal.x, normal.z);
        let ankle_roll = -libm::asin(normal.y.clamp(-1.0, 1.0));
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
        let distance_m = wanted_m.clamp(self.shortest_m, self.longest_m);
        let inner = ((a * a + b * b - distance_m * distance_m) / (2.0 * a * b)).clamp(-1.0, 1.0);
        Bend {
            distance_m,
            knee_rad: std::f64::consts::PI - libm::acos(inner),
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
        let mut all_rad = [0.0; MOST_LEG_JOINTS];
        all_rad[..angles_rad.len()].copy_from_slice(&angles_rad);
        LegAngles {
            angles_rad: all_rad,
            reached,
            short_m: bend.short_m,
        }
    }
}

fn rotation_x(angle_rad: f64) -> Matrix3<f64> {
    let (s, c) = libm::sincos(angle_rad);
    Matrix3::new(1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c)
}

fn rotation_z(angle_rad: f64) -> Matrix3<f64> {
    let (s, c) = libm::sincos(angle_rad);
    Matrix3::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0)
}

fn rotation_y(angle_rad: f64) -> Matrix3<f64> {
    let (s, c) = libm::sincos(angle_rad);
    Matrix3::new(c, 0.0, s, 0.0, 1.0, 0.0, -s, 0.0, c)
}
