//! Lost motion in the gears of the legs, taken out of the encoders' readings.
//!
//! An encoder sits at the motor and leads its joint by half of the play in the direction of the torque. On a stride the
//! torques change sign between landing and lift-off; left in, that shortens every step by a few per cent. The torque is the
//! servo's, by what it was commanded and what its encoder reads; before the first command, what holds the load at rest.

use geometry::GRAVITY_MPS2;
use nalgebra::{Point3, UnitQuaternion, Vector3};
use robot::{Body, LinkPoses, Side};
use sensing::Observation;

use crate::tuning::PlayTuning;

/// A motor of a leg, by the joint that it turns.
#[derive(Debug, Clone, Copy)]
struct Gear {
    joint: usize,
    takes_up_nm: f64,
    peak_nm: f64,
    kp: f64,
    kv: f64,
    /// What the servo was asked for: torque fed forward, plus stiffness times angle, plus damping times speed, N m.
    asked_nm: Option<f64>,
    lead_rad: f64,
}

/// What the gears hide.
#[derive(Debug, Clone)]
pub(crate) struct Play {
    half_rad: f64,
    follow: f64,
    gears: Vec<Gear>,
    torques_nm: Vec<f64>,
    joint_positions_rad: Vec<f64>,
}

impl Play {
    pub(crate) fn new(body: &Body, tuning: &PlayTuning) -> Self {
        let description = body.description();
        let mut motors = Vec::new();
        for &joint in Side::BOTH.iter().flat_map(|&side| body.leg_joints(side)) {
            let tie = body.followers.iter().find(|tie| tie.joint == joint);
            let motor = tie.map_or(joint, |tie| tie.leader);
            if !motors.contains(&motor) {
                motors.push(motor);
            }
        }
        let gears = motors
            .into_iter()
            .filter_map(|joint| {
                let name = &description.joints[joint];
                let mut hinges = description
                    .links
                    .iter()
                    .filter_map(|link| link.joint.as_ref());
                let hinge = hinges.find(|hinge| hinge.name == *name)?;
                Some(Gear {
                    joint,
                    takes_up_nm: tuning.takes_up * hinge.peak_torque,
                    peak_nm: hinge.peak_torque,
                    kp: hinge.kp,
                    kv: hinge.kv,
                    asked_nm: None,
                    lead_rad: 0.0,
                })
            })
            .collect();
        Self {
            half_rad: 0.5 * description.play,
            follow: tuning.follow,
            gears,
            torques_nm: vec![0.0; body.joint_count()],
            joint_positions_rad: vec![0.0; body.joint_count()],
        }
    }

    /// Takes note of what the servos are told from now on: angles (rad), speeds (rad/s), torques (N m), joint order.
    pub(crate) fn note_command(
        &mut self,
        positions_rad: &[f64],
        velocities_radps: &[f64],
        torques_nm: &[f64],
    ) {
        for gear in &mut self.gears {
            let joint = gear.joint;
            let asked_nm = torques_nm[joint]
                + gear.kp * positions_rad[joint]
                + gear.kv * velocities_radps[joint];
            gear.asked_nm = Some(asked_nm);
        }
    }

    /// Joint angles from the motors' angles, rad, joint order. `links` are posed by the motors' angles.
    pub(crate) fn joint_positions_rad(
        &mut self,
        body: &Body,
        links: &LinkPoses,
        observation: &Observation,
        odometry_from_torso: &UnitQuaternion<f64>,
    ) -> &[f64] {
        let (angles_rad, speeds_radps) = (
            &observation.joint_positions_rad,
            &observation.joint_velocities_radps,
        );
        self.joint_positions_rad.copy_from_slice(angles_rad);
        if self.half_rad <= 0.0 {
            return &self.joint_positions_rad;
        }
        let up = odometry_from_torso.inverse() * Vector3::z();
        self.torques_nm.fill(0.0);
        body.add_gravity(links, &(up * -GRAVITY_MPS2), &mut self.torques_nm);
        for side in Side::BOTH {
            let forces_n = &observation.foot_forces_n[side.index()];
            let load_n: f64 = forces_n.iter().sum();
            let pressed_at = center_of_pressure(body, links, side, forces_n);
            let link = body.sole_link(side);
            body.add_force(
                links,
                link,
                &pressed_at,
                &(up * load_n),
                &mut self.torques_nm,
            );
        }
        for tie in &body.followers {
            self.torques_nm[tie.leader] += self.torques_nm[tie.joint] * tie.ratio;
        }
        let follow = self.follow;
        for gear in &mut self.gears {
            let joint = gear.joint;
            let torque_nm = gear.asked_nm.map_or(-self.torques_nm[joint], |asked_nm| {
                let servo_nm =
                    asked_nm - gear.kp * angles_rad[joint] - gear.kv * speeds_radps[joint];
                servo_nm.clamp(-gear.peak_nm, gear.peak_nm)
            });
            let lead_rad =
                self.half_rad * (torque_nm / gear.takes_up_nm.max(1e-9)).clamp(-1.0, 1.0);
            gear.lead_rad += (lead_rad - gear.lead_rad) * follow;
            self.joint_positions_rad[gear.joint] -= gear.lead_rad;
        }
        for tie in &body.followers {
            self.joint_positions_rad[tie.joint] =
                tie.angle_rad(self.joint_positions_rad[tie.leader]);
        }
        &self.joint_positions_rad
    }
}

/// Where the ground presses on a sole, in the torso's frame, as far as a force for each quarter tells.
fn center_of_pressure(
    body: &Body,
    links: &LinkPoses,
    side: Side,
    [front_left, front_right, rear_left, rear_right]: &[f64; 4],
) -> Point3<f64> {
    let ([x, y], [length, width]) = body.description().legs.get(side).sensors_on_sole_m();
    let load_n = (front_left + front_right + rear_left + rear_right).max(1e-6);
    let x = x + length / 4.0 * (front_left + front_right - rear_left - rear_right) / load_n;
    let y = y + width / 4.0 * (front_left + rear_left - front_right - rear_right) / load_n;
    body.torso_from_sole(links, side) * Point3::new(x, y, 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::{Walk, biped};

    fn corrected(play_rad: f64, forces_n: [[f64; 4]; 2]) -> (Vec<f64>, Vec<f64>) {
        let mut description = biped().description().clone();
        description.play = play_rad;
        corrected_of(description, forces_n)
    }

    fn corrected_of(
        description: robot::Description,
        forces_n: [[f64; 4]; 2],
    ) -> (Vec<f64>, Vec<f64>) {
        let body = Body::new(description).unwrap();
        let mut observation = Walk::new().stand(1).observations[0].clone();
        observation.foot_forces_n = forces_n;
        let measured = observation.joint_positions_rad.clone();
        let mut links = LinkPoses::default();
        body.pose_links(&measured, &mut links).unwrap();
        let mut play = Play::new(&body, &PlayTuning::default());
        for _ in 0..20 {
            let level = UnitQuaternion::identity();
            let _ = play.joint_positions_rad(&body, &links, &observation, &level);
        }
        (measured, play.joint_positions_rad)
    }

    #[test]
    fn gears_without_play_are_believed() {
        let (measured, joints) = corrected(0.0, [[8.0; 4]; 2]);
        assert_eq!(measured, joints);
    }

    #[test]
    fn a_loaded_bent_knee_is_bent_further_than_its_motor_says() {
        let (measured, joints) = corrected(0.005, [[16.0; 4], [0.0; 4]]);
        // The motor pushes the knee straight; the joint lags behind it by half of the play.
        assert!((joints[3] - measured[3] - 0.0025).abs() < 1e-6);
        // Nothing leads by more than half of the play, and the trunk is left alone.
        assert!(
            joints
                .iter()
                .zip(&measured)
                .all(|(j, m)| (j - m).abs() <= 0.0025 + 1e-12)
        );
        assert_eq!(joints[12], measured[12]);
    }

    #[test]
    fn a_joint_that_follows_is_where_the_one_is_whose_motor_turns_it() {
        let mut description = biped().description().clone();
        description.play = 0.005;
        let [leader, follower] = Side::BOTH.map(|side| biped().leg_joints(side)[3]);
        let name = description.joints[leader].clone();
        let mut hinges = description
            .links
            .iter_mut()
            .filter_map(|link| link.joint.as_mut());
        let follows = hinges.find(|hinge| hinge.name == description.joints[follower]);
        follows.unwrap().follows = Some(name);
        let (measured, joints) = corrected_of(description, [[0.0; 4], [16.0; 4]]);
        // The load is on the follower's leg: the leader's motor holds it, and lags for both.
        assert!((joints[leader] - measured[leader] - 0.0025).abs() < 1e-6);
        assert_eq!(joints[follower], joints[leader]);
    }

    #[test]
    fn a_commanded_torque_says_on_which_side_of_its_play_a_joint_is() {
        let mut description = biped().description().clone();
        description.play = 0.005;
        let body = Body::new(description).unwrap();
        let observation = Walk::new().stand(1).observations[0].clone();
        let measured = &observation.joint_positions_rad;
        let mut links = LinkPoses::default();
        body.pose_links(measured, &mut links).unwrap();
        let still = vec![0.0; measured.len()];
        for push_nm in [2.0, -2.0] {
            let mut play = Play::new(&body, &PlayTuning::default());
            play.note_command(measured, &still, &vec![push_nm; measured.len()]);
            let level = UnitQuaternion::identity();
            for _ in 0..20 {
                let _ = play.joint_positions_rad(&body, &links, &observation, &level);
            }
            for &joint in body.leg_joints(Side::Right) {
                let lead_rad = measured[joint] - play.joint_positions_rad[joint];
                assert!((lead_rad - 0.0025_f64.copysign(push_nm)).abs() < 1e-6);
            }
        }
    }
}
