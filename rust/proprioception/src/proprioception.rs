//! The body's own senses at every control tick: observation in, body state out.

use geometry::{GRAVITY_MPS2, Pose};
use nalgebra::{UnitQuaternion, Vector3};
use robot::{Body, LinkPoses, Side};
use sensing::{Observation, ObservationError};
use settings::{ConfigError, Table};

use crate::attitude::{AttitudeFilter, ImuSample};
use crate::body_state::{BodyState, ProprioceptionError};
use crate::config::ProprioceptionConfig;
use crate::contact::FootContacts;
use crate::leg_odometry::{LegOdometry, LegPosture, TrunkMotion, odometry_from_torso};
use crate::levelling::Levelling;
use crate::play::Play;
use crate::trunk::TrunkChain;

/// Attitude, contacts and leg odometry.
#[derive(Debug, Clone)]
pub struct Proprioception {
    body: Body,
    config: ProprioceptionConfig,
    play: Play,
    trunk: TrunkChain,
    attitude: AttitudeFilter,
    levelling: Levelling,
    contacts: FootContacts,
    odometry: LegOdometry,
    motion: TrunkMotion,
    state: BodyState,
    before_ns: Option<u64>,
    /// Set until the robot has settled on its soles after the first observation.
    starting_since_ns: Option<u64>,
    stood: bool,
}

impl Proprioception {
    /// For this robot. Odometry starts with the robot's frame at its origin, at the first observation.
    pub fn new(body: &Body, config: ProprioceptionConfig) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self {
            play: Play::new(body, &config.tuning.play),
            trunk: TrunkChain::new(body, &config.tuning.motion),
            attitude: AttitudeFilter::new(&config),
            levelling: Levelling::new(),
            contacts: FootContacts::new(body.mass_kg() * GRAVITY_MPS2, &config),
            odometry: LegOdometry::new(),
            motion: TrunkMotion::default(),
            state: BodyState {
                time_ns: 0,
                odometry_from_torso_rotation: UnitQuaternion::identity(),
                angular_velocity_radps: Vector3::zeros(),
                links: LinkPoses {
                    torso_from_link: Vec::with_capacity(body.description().links.len()),
                },
                foot_loads_n: [0.0; 2],
                support: Side::Left,
                stands_level: true,
                on_slope: false,
                odometry_from_robot: Pose::identity(),
                robot_from_torso: Pose::identity(),
            },
            before_ns: None,
            starting_since_ns: None,
            stood: false,
            body: body.clone(),
            config,
        })
    }

    /// The body state at this observation. A refused observation leaves everything as it was.
    pub fn update(&mut self, observation: &Observation) -> Result<&BodyState, ProprioceptionError> {
        self.check(observation)?;
        self.pose_links(observation)?;
        let passed_s = self.before_ns.map_or(0.0, |before_ns| {
            (observation.time_ns - before_ns) as f64 * 1e-9
        });
        if self.before_ns.is_none() {
            self.starting_since_ns = Some(observation.time_ns);
        }
        self.before_ns = Some(observation.time_ns);
        self.contacts
            .update(&observation.foot_forces_n, &self.config);
        let sample = ImuSample {
            angular_velocity_radps: Vector3::from(observation.angular_velocity_radps),
            specific_force_mps2: Vector3::from(observation.specific_force_mps2),
            acceleration_mps2: self.motion.acceleration_mps2,
        };
        let both_feet = self.contacts.both_hold();
        self.attitude
            .update(&sample, passed_s, both_feet, &self.config);
        let torso_from_sole =
            Side::BOTH.map(|side| self.body.torso_from_sole(&self.state.links, side));
        let torso_from_imu_measured = self.body.torso_from_imu(&self.state.links).rotation;
        let learning = self.levelling.is_learning(self.config.level_time);
        if learning && self.attitude.is_still(&self.config) {
            let up_in_imu = self.attitude.odometry_from_imu.inverse() * Vector3::z();
            let up_by_imu = torso_from_imu_measured * up_in_imu;
            let up_by_soles =
                torso_from_sole.map(|torso_from_sole| torso_from_sole.rotation * Vector3::z());
            let up_by_soles = up_by_soles[0] + up_by_soles[1];
            let limit_rad = self.config.level_limit;
            self.levelling
                .learn(&up_by_imu, &up_by_soles, passed_s, limit_rad);
        }
        let torso_from_imu = self.levelling.correction * torso_from_imu_measured;
        let mut legs = LegPosture {
            odometry_from_torso_rotation: self.attitude.odometry_from_imu
                * torso_from_imu.inverse(),
            torso_from_sole,
            half_sole_m: 0.5 * self.body.description().legs.left.sole.length,
        };
        self.watch_start(observation.time_ns, &legs);
        if self.starting_since_ns.is_some() && (self.contacts.both_hold() || !self.stood) {
            let heading_rad = legs.heading_rad();
            self.attitude.turn_odometry(-heading_rad);
            legs.odometry_from_torso_rotation =
                self.attitude.odometry_from_imu * torso_from_imu.inverse();
            self.odometry.start(&legs);
        }
        let rate_in_imu = sample.angular_velocity_radps - self.attitude.bias_radps;
        let speeds_radps = &observation.joint_velocities_radps;
        let trunk_rate = self.trunk.rate_radps(&self.state.links, speeds_radps);
        self.state.angular_velocity_radps = torso_from_imu * rate_in_imu - trunk_rate;
        self.fill(observation.time_ns, &legs);
        let starting = self.starting_since_ns.is_some();
        let filter_s = self.config.tuning.motion.speed_filter_time;
        self.motion
            .follow(&self.odometry.torso_m, passed_s, filter_s, starting);
        Ok(&self.state)
    }

    /// Takes note of what the servos are told from now on (angles rad, speeds rad/s, torques N m; joint order): which way
    /// they push decides on which side of their gears' play the joints are. May be left out; then loads at rest decide.
    pub fn note_command(
        &mut self,
        positions_rad: &[f64],
        velocities_radps: &[f64],
        torques_nm: &[f64],
    ) {
        let joints = self.body.joint_count();
        if [positions_rad, velocities_radps, torques_nm].map(<[f64]>::len) == [joints; 3] {
            self.play
                .note_command(positions_rad, velocities_radps, torques_nm);
        }
    }

    /// Takes note of which feet stand, or are to land, on a slope: there no two places are on one level.
    pub const fn note_slopes(&mut self, on_slope: [bool; 2]) {
        self.odometry.on_slope = on_slope;
    }

    /// Poses the links by the joints: the motors' angles without the gears' play.
    fn pose_links(&mut self, observation: &Observation) -> Result<(), robot::BodyError> {
        let motor_positions_rad = &observation.joint_positions_rad;
        self.body
            .pose_links(motor_positions_rad, &mut self.state.links)?;
        let joint_positions_rad = self.play.joint_positions_rad(
            &self.body,
            &self.state.links,
            observation,
            &self.state.odometry_from_torso_rotation,
        );
        self.body
            .pose_links(joint_positions_rad, &mut self.state.links)
    }

    /// The state of the last observation; at the origin before the first.
    pub const fn state(&self) -> &BodyState {
        &self.state
    }

    /// Whether the robot has stood still on both feet for a while.
    pub fn is_still(&self) -> bool {
        self.attitude.is_still(&self.config)
    }

    /// Until the robot stands still for the first time, or lifts a foot, it is where it was put: what moves is the joints'
    /// play, the ground under the soles settling, a torso that rocks until it finds its balance, maybe from foot to foot.
    fn watch_start(&mut self, time_ns: u64, legs: &LegPosture) {
        let tuning = &self.config.tuning.start;
        let longest_ns = (tuning.longest * 1e9) as u64;
        let both_feet = self.contacts.both_hold();
        let lifted = self.stood && !both_feet && legs.sole_above_other_m() > tuning.lifted;
        self.stood |= both_feet;
        let over = self
            .starting_since_ns
            .is_some_and(|since_ns| time_ns > since_ns && time_ns - since_ns > longest_ns);
        let levelled = self.attitude.is_still(&self.config)
            && !self.levelling.is_learning(self.config.level_time);
        if lifted || over || levelled {
            self.starting_since_ns = None;
        }
    }

    fn fill(&mut self, time_ns: u64, legs: &LegPosture) {
        let odometry_from_robot = self.odometry.update(legs, &self.contacts, &self.config);
        let rotation = legs.odometry_from_torso_rotation;
        let odometry_from_torso = odometry_from_torso(rotation, self.odometry.torso_m);
        self.state.time_ns = time_ns;
        self.state.odometry_from_torso_rotation = rotation;
        self.state.foot_loads_n = self.contacts.loads_n();
        self.state.support = self.contacts.support;
        self.state.stands_level = self.odometry.stands_level(&self.config);
        self.state.on_slope = Side::BOTH
            .into_iter()
            .any(|side| self.contacts.holds(side) && self.odometry.on_slope[side.index()]);
        self.state.odometry_from_robot = odometry_from_robot;
        self.state.robot_from_torso =
            Pose::wrap(odometry_from_robot.inner.inverse() * odometry_from_torso);
    }

    fn check(&self, observation: &Observation) -> Result<(), ObservationError> {
        let expected = self.body.joint_count();
        for (field, values) in [
            ("joint_positions", &observation.joint_positions_rad),
            ("joint_velocities", &observation.joint_velocities_radps),
        ] {
            let found = values.len();
            if found != expected {
                return Err(ObservationError::WrongLength {
                    field,
                    expected,
                    found,
                });
            }
        }
        for (field, values) in [
            (
                "joint_positions",
                observation.joint_positions_rad.as_slice(),
            ),
            (
                "joint_velocities",
                observation.joint_velocities_radps.as_slice(),
            ),
            (
                "angular_velocity",
                observation.angular_velocity_radps.as_slice(),
            ),
            ("specific_force", observation.specific_force_mps2.as_slice()),
            ("foot_forces", observation.foot_forces_n.as_flattened()),
        ] {
            if let Some(found) = values.iter().copied().find(|value| !value.is_finite()) {
                return Err(ObservationError::NotFinite { field, found });
            }
        }
        match self.before_ns {
            Some(before_ns) if observation.time_ns <= before_ns => {
                Err(ObservationError::TimeWentBack {
                    before_ns,
                    now_ns: observation.time_ns,
                })
            }
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests;
