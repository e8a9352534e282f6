//! The walker: a command in, targets for all joints out, at every control tick.

use behaviour::{Command, Gaze};
use geometry::PlanarPose;
use localization::BodyState;
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector2, Vector3};
use robot::{Body, LinkPoses, Side};
use sensing::Observation;

use crate::balance::{Balance, GRAVITY_MPS2, Sensed};
use crate::capture::Capture;
use crate::feet::FeetControl;
use crate::footsteps::FootstepPlanner;
use crate::gait::{FootPose, Gait, Phase, Reference};
use crate::gaze::Head;
use crate::leg::Leg;
use crate::support::{Pressure, Soles};
use crate::{GaitConfig, JointTargets, WalkError};

/// Longest time between ticks that counts, s; also a tick when there was none before.
const TICK_S: f64 = 0.01;
/// How fast the correction of the swing foot for the tilt comes and goes, 1/s.
const TILT_FADE: f64 = 6.0;
/// Tilt that is not worth a correction, rad.
const TILT_DEADBAND_RAD: f64 = 0.02;

/// Walks. One a robot; see the crate's page for the parts.
#[derive(Debug, Clone)]
pub struct Walker {
    body: Body,
    config: GaitConfig,
    omega: f64,
    mass_kg: f64,
    legs: [Leg; 2],
    head: Head,
    gait: Gait,
    balance: Balance,
    soles: Soles,
    feet_control: FeetControl,
    capture: Capture,
    rest: Vec<f64>,
    targets: JointTargets,
    poses: LinkPoses,
    com: Vector2<f64>,
    yaw_rad: f64,
    pressure: Pressure,
    reference: Reference,
    swing_tilt: [f64; 2],
    last_ns: Option<u64>,
}

impl Walker {
    /// A walker for this body, standing as in the body's description; its gait is the description's `[gait]`.
    pub fn new(body: &Body) -> Result<Self, WalkError> {
        let description = body.description();
        let config: GaitConfig = if description.gait.is_null() {
            GaitConfig::default()
        } else {
            serde::Deserialize::deserialize(&description.gait)
                .map_err(|error: serde_json::Error| WalkError::Form(error.to_string()))?
        };
        config.check()?;
        let legs = [
            Leg::new(body, Side::Left, config.max_extension)?,
            Leg::new(body, Side::Right, config.max_extension)?,
        ];
        let mut rest = description.stand.clone();
        for (name, angle) in &description.arms_rest {
            rest[body.joint("arms.rest", name)?] = *angle;
        }
        let mut poses = LinkPoses::default();
        body.pose_links(&rest, &mut poses)?;
        let soles = Side::BOTH.map(|side| body.torso_from_sole(&poses, side).translation.vector);
        let middle = 0.5 * (soles[0] + soles[1]);
        let feet = soles.map(|sole| FootPose {
            planar: PlanarPose::new(sole.x - middle.x, sole.y - middle.y, 0.0),
            z_m: 0.0,
        });
        let com = body.center_of_mass_in_torso(&poses).coords - middle;
        let omega = (GRAVITY_MPS2 / com.z).sqrt();
        let gait = Gait::new(&config, FootstepPlanner::new(&config, body), feet);
        let joints = body.joint_count();
        let standing = gait.middle();
        Ok(Self {
            omega,
            mass_kg: body.mass_kg(),
            legs,
            head: Head::new(body, config.gaze_speed)?,
            balance: Balance::new(body, omega, config.velocity_blend, com.xy()),
            soles: Soles::new(body, config.sole_margin),
            feet_control: FeetControl::new(&config),
            capture: Capture::new(&config, FootstepPlanner::new(&config, body)),
            targets: JointTargets {
                positions_rad: rest.clone(),
                velocities_radps: vec![0.0; joints],
                torques_nm: vec![0.0; joints],
            },
            rest,
            poses,
            com: standing,
            yaw_rad: 0.0,
            pressure: Pressure {
                share: [0.5; 2],
                point: [standing; 2],
                zmp: standing,
            },
            reference: Reference {
                zmp: standing,
                dcm: standing,
            },
            swing_tilt: [0.0; 2],
            last_ns: None,
            gait,
            config,
            body: body.clone(),
        })
    }

    /// The targets for this tick. Allocates nothing.
    pub fn step(
        &mut self,
        command: &Command,
        observation: &Observation,
        state: &BodyState,
    ) -> Result<&JointTargets, WalkError> {
        let passed_s = self.pass(observation.time_ns);
        self.sense(observation, state, passed_s);
        let error = self.balance.dcm() - self.reference.dcm;
        let hurry = self.capture.adjust(&mut self.gait, &self.soles, &error, self.omega, passed_s);
        self.gait.advance(passed_s * hurry, &command.motion);
        self.reference = self.gait.reference(self.omega, &command.motion);
        self.com += (self.reference.dcm - self.com) * (self.omega * passed_s)
            + (self.balance.com - self.com) * (self.config.reference_pull * passed_s);
        self.push();
        self.feet_control.update(
            &self.gait.phase,
            &self.pressure.share,
            &state.foot_loads_n,
            self.mass_kg * GRAVITY_MPS2,
            passed_s,
        );
        self.pose(passed_s)?;
        self.feed_forward(state);
        self.head.turn(
            &command.gaze,
            passed_s,
            &mut self.targets.positions_rad,
            &mut self.targets.velocities_radps,
        );
        Ok(&self.targets)
    }

    /// Whether it stands still on both soles.
    pub fn standing(&self) -> bool {
        self.gait.phase == Phase::Standing
    }

    /// Landings so far.
    pub const fn steps_taken(&self) -> u64 {
        self.gait.steps_taken
    }

    /// The foot that stands while the other moves; `None` while both carry.
    pub const fn support(&self) -> Option<Side> {
        match &self.gait.phase {
            Phase::Single { swing, .. } => Some(swing.side.other()),
            Phase::Standing | Phase::Double { .. } => None,
        }
    }

    /// What the feet do, for the recording.
    pub const fn phase(&self) -> &Phase {
        &self.gait.phase
    }

    /// Reference and estimate of the divergent component of motion and of the zero moment point, for the recording.
    pub fn balance(&self) -> (&Reference, &Balance, &Pressure) {
        (&self.reference, &self.balance, &self.pressure)
    }

    /// Where the head was told to look at the last tick.
    pub fn gaze(&self) -> Gaze {
        self.head.gaze()
    }

    fn pass(&mut self, now_ns: u64) -> f64 {
        let passed_s = match self.last_ns {
            Some(last_ns) if now_ns > last_ns => (now_ns - last_ns) as f64 * 1e-9,
            _ => TICK_S,
        };
        self.last_ns = Some(now_ns);
        passed_s.min(2.0 * TICK_S)
    }

    fn sense(&mut self, observation: &Observation, state: &BodyState, passed_s: f64) {
        let [left, right] = state.foot_loads_n.map(|load| load.max(0.0));
        let trust = match self.support() {
            Some(Side::Left) => [1.0, 0.0],
            Some(Side::Right) => [0.0, 1.0],
            None if left + right > 1.0 => [left / (left + right), right / (left + right)],
            None => [0.5, 0.5],
        };
        let sensed = Sensed {
            attitude: &state.odometry_from_torso_rotation,
            torso_from_sole: Side::BOTH.map(|side| self.body.torso_from_sole(&state.links, side)),
            com_in_torso: self.body.center_of_mass_in_torso(&state.links).coords,
            foot_forces_n: &observation.foot_forces_n,
            feet: &self.gait.feet,
            trust,
            weight_n: self.mass_kg * GRAVITY_MPS2,
            passed_s,
        };
        self.balance.update(&sensed, &self.pressure.zmp);
    }

    /// DCM feedback: p = p_ref + k (xi - xi_ref), within the soles that stand.
    fn push(&mut self) {
        let wanted = self.reference.zmp
            + (self.balance.dcm() - self.reference.dcm) * self.config.dcm_gain;
        self.pressure = match self.support() {
            Some(stance) => self.soles.on_one(&self.gait.feet, stance, &wanted),
            None => {
                let carry = Side::BOTH
                    .map(|side| self.gait.support_point(&self.gait.feet[side.index()], side));
                self.soles.on_both(&self.gait.feet, &carry, &wanted)
            }
        };
    }

    fn pose(&mut self, passed_s: f64) -> Result<(), WalkError> {
        let feet = Side::BOTH.map(|side| self.feet_control.place(self.gait.foot(side), side));
        let yaw_goal = Gait::center_of(&feet).yaw_rad;
        self.yaw_rad += geometry::angle_between(self.yaw_rad, yaw_goal) * (8.0 * passed_s).min(1.0);
        let rotation = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), self.yaw_rad);
        self.body
            .pose_links(&self.targets.positions_rad, &mut self.poses)?;
        let offset = rotation * self.body.center_of_mass_in_torso(&self.poses).coords;
        let height = self.torso_height(&feet, &rotation, &offset);
        let torso = Vector3::new(self.com.x - offset.x, self.com.y - offset.y, height);
        let plan_from_torso = Isometry3::from_parts(Translation3::from(torso), rotation);
        let torso_from_plan = plan_from_torso.inverse();
        for joint in 0..self.rest.len() {
            self.targets.velocities_radps[joint] = 0.0;
        }
        for side in Side::BOTH {
            let foot = &feet[side.index()];
            let plan_from_sole = Isometry3::from_parts(
                Translation3::new(foot.planar.x_m, foot.planar.y_m, foot.z_m),
                UnitQuaternion::from_axis_angle(&Vector3::z_axis(), foot.planar.yaw_rad),
            );
            let lean = self.lean(&plan_from_torso, side, passed_s);
            let leg = &self.legs[side.index()];
            let solution = leg.solve(&(torso_from_plan * lean * plan_from_sole));
            for (&joint, &angle) in leg.joints().iter().zip(&solution.angles_rad) {
                let before = self.targets.positions_rad[joint];
                self.targets.velocities_radps[joint] = (angle - before) / passed_s;
                self.targets.positions_rad[joint] = angle;
            }
        }
        Ok(())
    }

    /// How the plan appears to a leg whose foot is in the air, as seen from the reference's torso: leaning by the measured tilt,
    /// so that the foot meets the ground at its time. Fades in after lifting and out after landing.
    fn lean(
        &mut self,
        plan_from_torso: &Isometry3<f64>,
        side: Side,
        passed_s: f64,
    ) -> Isometry3<f64> {
        let goal = match &self.gait.phase {
            Phase::Single { swing, .. } if swing.side == side => self.config.swing_tilt,
            _ => 0.0,
        };
        let weight = &mut self.swing_tilt[side.index()];
        *weight += (goal - *weight).clamp(-TILT_FADE * passed_s, TILT_FADE * passed_s);
        if *weight <= 0.0 {
            return Isometry3::identity();
        }
        let measured = self.balance.plan_from_torso;
        let error = (measured.rotation * plan_from_torso.rotation.inverse()).scaled_axis();
        let size = error.norm();
        let used = (size - TILT_DEADBAND_RAD).max(0.0) / size.max(1e-9) * *weight;
        let turn = UnitQuaternion::from_scaled_axis(-error * used);
        let pivot = self.gait.feet[side.other().index()];
        let pivot = Vector3::new(pivot.planar.x_m, pivot.planar.y_m, pivot.z_m);
        Isometry3::from_parts(Translation3::from(pivot - turn * pivot), turn)
    }

    /// Height of the torso's origin: the hips at their height over the lower foot, lower where a leg would get too long.
    fn torso_height(
        &self,
        feet: &[FootPose; 2],
        rotation: &UnitQuaternion<f64>,
        offset: &Vector3<f64>,
    ) -> f64 {
        let ground = self.gait.ground_m();
        let mut height = f64::INFINITY;
        for side in Side::BOTH {
            let (leg, foot) = (&self.legs[side.index()], &feet[side.index()]);
            let hip = rotation * leg.hip();
            let ankle = leg.ankle_in_plan(&foot.planar);
            let across = Vector2::new(
                self.com.x - offset.x + hip.x - ankle.x,
                self.com.y - offset.y + hip.y - ankle.y,
            );
            let reach = leg.max_length_m();
            let rise = (reach * reach - across.norm_squared()).max(0.0).sqrt();
            height = height
                .min(foot.z_m + leg.ankle_height_m() + rise - hip.z)
                .min(ground + self.config.hip_height - hip.z);
        }
        height
    }

    /// Torques that hold the posture against gravity with the wanted pressure under the feet.
    fn feed_forward(&mut self, state: &BodyState) {
        let torques = &mut self.targets.torques_nm;
        torques.fill(0.0);
        let torso_from_plan = self.balance.plan_from_torso.rotation.inverse();
        let gravity = torso_from_plan * Vector3::new(0.0, 0.0, -GRAVITY_MPS2);
        self.body.add_gravity(&state.links, &gravity, torques);
        let pull = (self.balance.com - self.pressure.zmp)
            * (self.mass_kg * self.omega * self.omega);
        let weight_n = self.mass_kg * GRAVITY_MPS2;
        let force = Vector3::new(pull.x, pull.y, weight_n);
        for side in Side::BOTH {
            let index = side.index();
            let foot = &self.gait.feet[index];
            let point = self.pressure.point[index];
            let (x, y) = foot.planar.inverse().apply(point.x, point.y);
            let sole = self.body.torso_from_sole(&state.links, side);
            let at = sole * Point3::new(x, y, 0.0);
            let push = torso_from_plan * force * self.pressure.share[index];
            self.body
                .add_force(&state.links, self.body.sole_link(side), &at, &push, torques);
        }
        for torque in torques.iter_mut() {
            *torque = -*torque;
        }
    }
}
