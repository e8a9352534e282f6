//! The servos: the one place where joint targets become torques, within what a motor could do.

use settings::{POSITIVE, Table, above_to, settings};

use crate::SimulatedBodyError;
use crate::error::check_length;

settings! {
    /// How the play in the gears follows the torque.
    pub struct ServoTuning("physics.servo") {
        /// Time in which the lost motion follows the torque's sign.
        play_time: f64 = 0.01, "s", POSITIVE;
        /// Share of the peak torque that takes up the play.
        play_torque: f64 = 0.05, "1", above_to(0.0, 1.0);
    }
}

/// What the motor of a joint can do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motor {
    /// Stiffness of the servo, N m/rad.
    pub kp: f64,
    /// Damping of the servo, N m s/rad.
    pub kv: f64,
    /// Never exceeded, N m.
    pub peak_torque_nm: f64,
    /// Where the torque-speed line starts, N m; at or above the peak.
    pub stall_torque_nm: f64,
    /// Where the line ends, rad/s.
    pub no_load_speed_radps: f64,
    /// Dry friction of motor, gear and joint, N m.
    pub friction_nm: f64,
    /// What turns with the motor, kg m²: its friction brings as much to rest within a step, and no more.
    pub inertia_kgm2: f64,
}

/// A motor, and what follows from it.
#[derive(Debug, Clone)]
struct DrivenJoint {
    motor: Motor,
    /// Fall of the torque-speed line, N m s/rad.
    slope: f64,
    /// How far the motor leads its joint for each newton metre, up to half of the play, rad/(N m).
    lead_per_torque: f64,
    /// What brings the motor to rest within a step, N m s/rad.
    stopping: f64,
    /// All that the targets contribute to the torque, N m.
    asked_nm: f64,
    /// Share that is left of the torque that the motor can give: 1 for a whole one.
    strength: f64,
}

/// A proportional-derivative servo with feed-forward on each joint, and the play in its gear.
///
/// The torque is `kp (position* - angle) + kv (velocity* - velocity) + torque*`, held within the peak torque and, where a motor drives,
/// within the line from the stall torque at rest to nothing at the no-load speed. Braking is limited by the peak alone.
///
/// What reaches the joint is that less the dry friction: `clip(velocity inertia / step, ± friction)`, which stops what turns with the
/// motor and drives nothing. Friction as constraints of the simulator's solver took a third of its time, and held a resting joint no
/// better.
///
/// The angle is the motor's, before the gear's play; the encoder sits there too. It leads the joint by half of the play in the direction
/// of the torque; the lead follows a change of sign with the time constant [`ServoTuning::play_time`] and grows with the torque up to
/// [`ServoTuning::play_torque`] of the peak, or more for a stiff servo, so that the loop through it has a gain below one and is stable.
#[derive(Debug, Clone)]
pub struct Servos {
    joints: Vec<DrivenJoint>,
    lead_rad: Vec<f64>,
    half_play_rad: f64,
    /// Share of the way to where the lead is drawn that it goes in a step.
    follow: f64,
}

impl Servos {
    /// At rest, in the middle of their play, which is `play_rad` between the two directions of torque.
    pub fn new(
        motors: &[Motor],
        play_rad: f64,
        timestep_s: f64,
        tuning: &ServoTuning,
    ) -> Result<Self, SimulatedBodyError> {
        tuning.check()?;
        let half_play_rad = 0.5 * play_rad;
        let joint = |motor: &Motor| {
            let takes_up_nm =
                (tuning.play_torque * motor.peak_torque_nm).max(motor.kp * half_play_rad);
            DrivenJoint {
                motor: *motor,
                slope: motor.stall_torque_nm / motor.no_load_speed_radps,
                // A joint that no motor turns has no gear either.
                lead_per_torque: if takes_up_nm > 0.0 {
                    half_play_rad / takes_up_nm
                } else {
                    0.0
                },
                stopping: motor.inertia_kgm2 / timestep_s,
                asked_nm: 0.0,
                strength: 1.0,
            }
        };
        Ok(Self {
            joints: motors.iter().map(joint).collect(),
            lead_rad: vec![0.0; motors.len()],
            half_play_rad,
            follow: -libm::expm1(-timestep_s / tuning.play_time),
        })
    }

    /// How many joints there are.
    pub const fn joints(&self) -> usize {
        self.joints.len()
    }

    /// How far each motor, where the encoder sits, leads its joint, rad.
    pub fn lead_rad(&self) -> &[f64] {
        &self.lead_rad
    }

    /// Lets the motors be weak, or whole again: what share is left of the torque that each can give, in the joint order.
    pub fn weaken(&mut self, shares: &[f64]) -> Result<(), SimulatedBodyError> {
        check_length("strength", shares.len(), self.joints())?;
        for (joint, &share) in self.joints.iter_mut().zip(shares) {
            joint.strength = share;
        }
        Ok(())
    }

    /// Takes what is asked for from now on: angles (rad), velocities (rad/s) and torques (N m) by the joint order. Each servo goes by
    /// its encoder, which reads too much by its offset.
    pub fn command(
        &mut self,
        positions_rad: &[f64],
        velocities_radps: &[f64],
        torques_nm: &[f64],
        encoder_offsets_rad: &[f64],
    ) -> Result<(), SimulatedBodyError> {
        let joints = self.joints();
        check_length("position", positions_rad.len(), joints)?;
        check_length("velocity", velocities_radps.len(), joints)?;
        check_length("torque", torques_nm.len(), joints)?;
        check_length("offsets", encoder_offsets_rad.len(), joints)?;
        let targets = positions_rad.iter().zip(velocities_radps).zip(torques_nm);
        let offsets = encoder_offsets_rad.iter();
        for (joint, (((position, velocity), torque), offset)) in
            self.joints.iter_mut().zip(targets.zip(offsets))
        {
            let Motor { kp, kv, .. } = joint.motor;
            joint.asked_nm = torque + kp * (position - offset) + kv * velocity;
        }
        Ok(())
    }

    /// The torques at the joints (N m) for the coming physics step at these true angles (rad) and velocities (rad/s); in the joint order.
    pub fn torques<'a>(
        &'a mut self,
        positions_rad: &'a [f64],
        velocities_radps: &'a [f64],
    ) -> impl Iterator<Item = f64> + 'a {
        let (half_play_rad, follow) = (self.half_play_rad, self.follow);
        let truth = positions_rad.iter().zip(velocities_radps);
        let joints = self.joints.iter().zip(&mut self.lead_rad);
        joints
            .zip(truth)
            .map(move |((joint, lead_rad), (&angle_rad, &speed_radps))| {
                let torque_nm = joint.torque_nm(angle_rad + *lead_rad, speed_radps);
                if half_play_rad > 0.0 {
                    let drawn = joint.lead_per_torque * torque_nm;
                    let most = drawn.min(half_play_rad).max(-half_play_rad);
                    *lead_rad += (most - *lead_rad) * follow;
                }
                torque_nm - joint.friction_nm(speed_radps)
            })
    }
}

impl DrivenJoint {
    /// What friction takes at the joint's speed, N m.
    fn friction_nm(&self, speed_radps: f64) -> f64 {
        let most_nm = self.motor.friction_nm;
        (self.stopping * speed_radps).min(most_nm).max(-most_nm)
    }

    /// What the motor gives at its angle and the joint's speed, N m.
    fn torque_nm(&self, angle_rad: f64, speed_radps: f64) -> f64 {
        let motor = &self.motor;
        let wanted_nm = self.asked_nm - angle_rad * motor.kp - speed_radps * motor.kv;
        let lost_nm = self.slope * speed_radps;
        let most_nm = (motor.stall_torque_nm - lost_nm).max(0.0) * self.strength;
        let least_nm = (-motor.stall_torque_nm - lost_nm).min(0.0) * self.strength;
        let peak_nm = motor.peak_torque_nm * self.strength;
        wanted_nm
            .min(most_nm)
            .max(least_nm)
            .min(peak_nm)
            .max(-peak_nm)
    }
}

#[cfg(test)]
#[path = "servo_tests.rs"]
mod tests;
