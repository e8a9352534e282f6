//! The observations that the biped would make on a walk with known footholds.

use geometry::{GRAVITY_MPS2, PlanarPose};
use nalgebra::{Isometry3, Matrix6, Translation3, UnitQuaternion, Vector2, Vector3, Vector6};
use robot::{Body, LinkPoses, Side};
use sensing::{Observation, TICK_NS};

use crate::biped::{HIP_Y_M, biped};

const HIP_HEIGHT_M: f64 = 0.22;
const JOINTS: usize = 13;

/// A walker without dynamics: it goes from foothold to foothold and writes down what its sensors would say.
pub struct Walk {
    /// The biped.
    pub body: Body,
    /// What its sensors said, tick by tick.
    pub observations: Vec<Observation>,
    /// True robot frame at each observation: x, y, yaw and the level.
    pub truth: Vec<(PlanarPose, f64)>,
    soles: [(PlanarPose, f64); 2],
    torso: Isometry3<f64>,
    speed_mps: Vector2<f64>,
    joints: Vec<f64>,
}

/// Ticks in which the load goes from one foot to both.
const SHIFT_TICKS: u32 = 25;

/// From 0 to 1, at rest at both ends.
fn smooth(share: f64) -> f64 {
    share * share * (3.0 - 2.0 * share)
}

impl Default for Walk {
    fn default() -> Self {
        Self::new()
    }
}

impl Walk {
    /// Stands at the origin.
    pub fn new() -> Self {
        let mut joints = vec![0.0; JOINTS];
        for leg in [0, 6] {
            joints[leg + 2] = -0.4;
            joints[leg + 3] = 0.8;
            joints[leg + 4] = -0.4;
        }
        let soles = [1.0, -1.0].map(|sign| (PlanarPose::new(0.0, sign * HIP_Y_M, 0.0), 0.0));
        Self {
            body: biped(),
            observations: Vec::new(),
            truth: Vec::new(),
            soles,
            torso: Isometry3::translation(0.0, 0.0, HIP_HEIGHT_M),
            speed_mps: Vector2::zeros(),
            joints,
        }
    }

    /// Stands on both feet for a number of ticks.
    #[must_use]
    pub fn stand(mut self, ticks: usize) -> Self {
        for _ in 0..ticks {
            self.tick(0.5, self.soles, Side::Left);
        }
        self
    }

    /// Moves one foot to a place and a level: load shift, 20 ticks in the air, load shift back to the middle.
    #[must_use]
    pub fn step(mut self, side: Side, to: PlanarPose, level_m: f64) -> Self {
        let from = self.soles;
        let lifted = if side == Side::Left { 1.0 } else { 0.0 };
        for tick in 1..=SHIFT_TICKS {
            self.tick(
                0.5 + (lifted - 0.5) * smooth(f64::from(tick) / f64::from(SHIFT_TICKS)),
                from,
                side.other(),
            );
        }
        for tick in 1..=20 {
            let share = f64::from(tick) / 20.0;
            let (start, start_level_m) = from[side.index()];
            let mut soles = from;
            soles[side.index()] = (
                PlanarPose::new(
                    start.x_m + (to.x_m - start.x_m) * share,
                    start.y_m + (to.y_m - start.y_m) * share,
                    start.yaw_rad + (to.yaw_rad - start.yaw_rad) * share,
                ),
                start_level_m
                    + (level_m - start_level_m) * share
                    + 0.02 * libm::sin(share * std::f64::consts::PI),
            );
            self.tick(lifted, soles, side.other());
        }
        for tick in 1..=SHIFT_TICKS {
            self.tick(
                lifted + (0.5 - lifted) * smooth(f64::from(tick) / f64::from(SHIFT_TICKS)),
                self.soles,
                side.other(),
            );
        }
        self
    }

    /// Walks `count` steps; each brings one foot to where `forward`, and `turn_rad` more of heading, put it.
    #[must_use]
    pub fn walk(mut self, count: usize, forward_m: f64, turn_rad: f64) -> Self {
        let mut at = PlanarPose::default();
        for step in 0..count {
            let side = if step % 2 == 0 {
                Side::Left
            } else {
                Side::Right
            };
            if step > 0 {
                at = at.compose(&PlanarPose::new(forward_m, 0.0, turn_rad));
            }
            let foot = at.compose(&PlanarPose::new(
                forward_m * 0.5,
                side.sign() * HIP_Y_M,
                turn_rad * 0.5,
            ));
            self = self.step(side, foot, 0.0);
        }
        self
    }

    fn tick(&mut self, right_share: f64, soles: [(PlanarPose, f64); 2], support: Side) {
        self.soles = soles;
        let [(left, left_m), (right, right_m)] = soles;
        let yaw_rad = f64::midpoint(left.yaw_rad, right.yaw_rad);
        let middle = PlanarPose::new(
            f64::midpoint(left.x_m, right.x_m),
            f64::midpoint(left.y_m, right.y_m),
            yaw_rad,
        );
        let level_m = soles[support.index()].1;
        // The torso is over the foot that carries, and moves on while the load does.
        let over = |left: f64, right: f64| left + (right - left) * right_share;
        let before = self.torso;
        let turn = UnitQuaternion::from_euler_angles(0.02 * (right_share - 0.5), 0.0, yaw_rad);
        let height_m = HIP_HEIGHT_M - 0.02 + (left_m.min(right_m)).max(-0.1);
        self.torso = Isometry3::from_parts(
            Translation3::new(
                over(left.x_m, right.x_m),
                over(left.y_m, right.y_m),
                height_m,
            ),
            turn,
        );
        for side in Side::BOTH {
            let (sole, sole_m) = soles[side.index()];
            let odometry_from_sole = Isometry3::from_parts(
                Translation3::new(sole.x_m, sole.y_m, sole_m),
                UnitQuaternion::from_euler_angles(0.0, 0.0, sole.yaw_rad),
            );
            self.solve_leg(side, &(self.torso.inverse() * odometry_from_sole));
        }
        let weight_n = self.body.mass_kg() * GRAVITY_MPS2;
        let turned = before.rotation.inverse() * self.torso.rotation;
        let first = self.observations.is_empty();
        let rate = if first {
            Vector3::zeros()
        } else {
            turned.scaled_axis() / 0.01
        };
        let speed = (self.torso.translation.vector - before.translation.vector).xy() / 0.01;
        let pull = if first {
            Vector2::zeros()
        } else {
            (speed - self.speed_mps) / 0.01
        };
        self.speed_mps = speed;
        let force = self.torso.rotation.inverse() * Vector3::new(pull.x, pull.y, GRAVITY_MPS2);
        self.observations.push(Observation {
            time_ns: self.observations.len() as u64 * TICK_NS,
            joint_positions_rad: self.joints.clone(),
            joint_velocities_radps: vec![0.0; JOINTS],
            angular_velocity_radps: rate.into(),
            specific_force_mps2: force.into(),
            foot_forces_n: [
                [weight_n * (1.0 - right_share) / 4.0; 4],
                [weight_n * right_share / 4.0; 4],
            ],
            depth: None,
        });
        self.truth.push((middle, level_m));
    }

    /// Newton's method on the forward kinematics, from the angles of the tick before.
    fn solve_leg(&mut self, side: Side, torso_from_sole: &Isometry3<f64>) {
        let indices = self.body.leg_joints(side).to_vec();
        for _ in 0..30 {
            let error = self.sole_error(side, torso_from_sole);
            if error.norm() < 1e-13 {
                break;
            }
            let mut jacobian = Matrix6::zeros();
            for (column, &joint) in indices.iter().enumerate() {
                let angle = self.joints[joint];
                self.joints[joint] = angle + 1e-6;
                jacobian.set_column(
                    column,
                    &((self.sole_error(side, torso_from_sole) - error) / 1e-6),
                );
                self.joints[joint] = angle;
            }
            let change = jacobian.lu().solve(&error).unwrap();
            for (&joint, change) in indices.iter().zip(change.iter()) {
                self.joints[joint] -= change;
            }
        }
        assert!(
            self.sole_error(side, torso_from_sole).norm() < 1e-9,
            "the walk asks for an impossible leg"
        );
    }

    fn sole_error(&self, side: Side, torso_from_sole: &Isometry3<f64>) -> Vector6<f64> {
        let mut links = LinkPoses::default();
        self.body.pose_links(&self.joints, &mut links).unwrap();
        let is = self.body.torso_from_sole(&links, side);
        let shift = is.translation.vector - torso_from_sole.translation.vector;
        let turn = (torso_from_sole.rotation.inverse() * is.rotation).scaled_axis();
        Vector6::new(shift.x, shift.y, shift.z, turn.x, turn.y, turn.z)
    }
}
