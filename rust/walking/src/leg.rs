//! A leg of six joints and its inverse kinematics in closed form. Its yaw axis may slant sideways, and its yaw angle may be given.

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
    /// How much further away from the hip the ankle should be than the leg is long, m.
    pub short_m: f64,
}

/// The triangle of hip, knee and ankle.
#[derive(Debug, Clone, Copy)]
struct Bend {
    /// Of hip and ankle, m.
    distance_m: f64,
    /// Angle of the knee, 0 when it is straight, rad.
    knee_rad: f64,
    reached: bool,
    short_m: f64,
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

    /// From hip to knee, and from knee to ankle, m.
    pub const fn lengths_m(&self) -> (f64, f64) {
        (self.geometry.thigh_m, self.geometry.shank_m)
    }

    /// Longest distance from hip to ankle, m.
    pub const fn max_length_m(&self) -> f64 {
        self.max_length_m
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
        let shortest_m = (a - b).abs() + 0.05 * a;
        let distance_m = wanted_m.clamp(shortest_m, self.max_length_m);
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
mod tests {
    use super::*;
    use crate::WalkError;
    use crate::test_biped::{biped, description};
    use nalgebra::Translation3;
    use proptest::prelude::*;
    use robot::LinkPoses;

    fn sole_at(body: &Body, side: Side, angles: &[f64; 6]) -> Isometry3<f64> {
        let mut all = vec![0.0; body.joint_count()];
        for (&joint, &angle) in body.leg_joints(side).iter().zip(angles) {
            all[joint] = angle;
        }
        let mut poses = LinkPoses::default();
        body.pose_links(&all, &mut poses).unwrap();
        body.torso_from_sole(&poses, side)
    }

    fn reachable() -> impl Strategy<Value = [f64; 6]> {
        (
            -0.6..0.6f64,
            -0.5..0.5f64,
            -1.4..0.6f64,
            0.1..2.2f64,
            -1.2..0.8f64,
            -0.5..0.5f64,
        )
            .prop_map(|(a, b, c, d, e, f)| [a, b, c, d, e, f])
    }

    proptest! {
        #[test]
        fn inverse_kinematics_finds_back_the_angles_of_any_reachable_pose(angles in reachable(), left in any::<bool>()) {
            let side = if left { Side::Left } else { Side::Right };
            let body = biped();
            let leg = Leg::new(&body, side, 0.9999).unwrap();
            let sole = sole_at(&body, side, &angles);
            let hip_in_sole = sole.inverse_transform_vector(&(leg.hip() - sole.translation.vector));
            prop_assume!(hip_in_sole.z > 0.06);
            let found = leg.solve(&sole);
            prop_assert!(found.reached);
            for (a, b) in found.angles_rad.iter().zip(&angles) {
                prop_assert!((a - b).abs() < 1e-6, "{:?} became {:?}", angles, found.angles_rad);
            }
        }

        #[test]
        fn no_pose_gives_anything_but_finite_angles(
            xyz in prop::array::uniform3(-0.5..0.5f64),
            turn in prop::array::uniform3(-3.0..3.0f64),
        ) {
            let leg = Leg::new(&biped(), Side::Left, 0.985).unwrap();
            let rotation = nalgebra::UnitQuaternion::from_scaled_axis(Vector3::from(turn));
            let pose = Isometry3::from_parts(Translation3::from(xyz), rotation);
            prop_assert!(leg.solve(&pose).angles_rad.iter().all(|angle| angle.is_finite()));
        }
    }

    #[test]
    fn at_the_greatest_height_for_a_thigh_it_stretches_back_just_so_far() {
        let leg = Leg::new(&biped(), Side::Left, 0.9999).unwrap();
        for (back_m, aside_m) in [(0.11, 0.0), (0.13, 0.0), (0.12, 0.03)] {
            let rise_m = leg.stretched_m(back_m, aside_m, 0.45);
            let ankle_m = leg.ankle_height_m();
            let place = leg.hip() - Vector3::new(back_m, aside_m, rise_m + ankle_m);
            let found = leg.solve(&Isometry3::translation(place.x, place.y, place.z));
            assert!(found.reached);
            assert!((found.angles_rad[2] - 0.45).abs() < 1e-6, "{found:?}");
        }
        assert!(leg.stretched_m(0.08, 0.0, 0.45).is_infinite());
    }

    #[test]
    fn a_pose_out_of_reach_is_said_to_be_so() {
        let leg = Leg::new(&biped(), Side::Left, 0.985).unwrap();
        let far = Isometry3::translation(0.0, 0.0425, -0.4);
        let found = leg.solve(&far);
        assert!(
            !found.reached && (0.1..0.2).contains(&found.short_m),
            "{found:?}"
        );
    }

    #[test]
    fn a_leg_whose_yaw_axis_slants_forward_is_refused_by_name() {
        let mut slanting = description();
        slanting.links[1].joint.as_mut().unwrap().axis = [0.7, 0.0, -0.7];
        let error = Leg::new(&Body::new(slanting).unwrap(), Side::Left, 0.985).unwrap_err();
        assert!(matches!(
            error,
            WalkError::Leg {
                side: Side::Left,
                ..
            }
        ));
        assert!(error.to_string().contains("left_hip_yaw"), "{error}");
    }

    #[test]
    fn a_leg_whose_hip_axes_do_not_meet_is_refused() {
        let mut apart = description();
        apart.links[3].position = [0.02, 0.0, 0.0];
        let error = Leg::new(&Body::new(apart).unwrap(), Side::Left, 0.985).unwrap_err();
        assert!(error.to_string().contains("must meet"), "{error}");
    }

    #[test]
    fn hip_axes_that_miss_each_other_by_a_tenth_of_a_millimetre_put_the_sole_that_near() {
        let mut apart = description();
        apart.links[3].position = [1e-4, 0.0, 0.0];
        let body = Body::new(apart).unwrap();
        let leg = Leg::new(&body, Side::Left, 0.985).unwrap();
        let wanted = Isometry3::translation(0.03, 0.05, -0.22);
        let found = leg.solve(&wanted);
        assert!(found.reached);
        let sole = sole_at(&body, Side::Left, &found.angles_rad);
        let off = wanted.inverse() * sole;
        assert!(off.translation.vector.norm() < 2e-4, "{off}");
    }
}
