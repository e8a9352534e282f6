//! The walker: a command in, targets for all joints out, at every control tick.

use behaviour::{Command, Gaze, Stepping};
use nalgebra::Vector2;
use proprioception::BodyState;
use robot::{Body, Side};
use sensing::Observation;

use crate::ankles::Ankles;
use crate::arms::ArmsControl;
use crate::balance::{Balance, GRAVITY_MPS2, Sensed};
use crate::capture::Capture;
use crate::feet::FeetControl;
use crate::footsteps::FootstepPlanner;
use crate::gait::{FootPose, Gait, Phase, Reference};
use crate::gaze::Head;
use crate::landing::{Felt, Ground};
use crate::pelvis::Course;
use crate::posture::{Moment, Posture};
use crate::relief::{Relief, Slopes};
use crate::stance::Stance;
use crate::support::{Pressure, Soles};
use crate::task::{Frame, StepList};
use crate::{GaitConfig, JointTargets, WalkError};

/// The control tick, s; longer gaps count as two.
const TICK_S: f64 = 0.01;

/// Walks. One a robot; see the crate's page for the parts.
#[derive(Debug, Clone)]
pub struct Walker {
    body: Body,
    config: GaitConfig,
    weight_n: f64,
    head: Head,
    arms: ArmsControl,
    gait: Gait,
    list: StepList,
    balance: Balance,
    soles: Soles,
    feet_control: FeetControl,
    ankles: Ankles,
    capture: Capture,
    posture: Posture,
    com: Vector2<f64>,
    reference: Reference,
    pressure: Pressure,
    targets: JointTargets,
    last_ns: Option<u64>,
}

impl Walker {
    /// A walker for this body, standing as in the body's description; its gait is the description's `[gait]`.
    pub fn new(body: &Body) -> Result<Self, WalkError> {
        let stance = Stance::upright(body)?;
        let config = GaitConfig::read(&body.description().gait, &stance)?;
        let Stance {
            rest, feet, com, ..
        } = stance;
        let omega = (GRAVITY_MPS2 / com.z).sqrt();
        let planner = FootstepPlanner::new(&config, body);
        let gait = Gait::new(&config, planner.clone(), feet);
        let (joints, middle) = (rest.len(), gait.middle());
        Ok(Self {
            weight_n: body.mass_kg() * GRAVITY_MPS2,
            head: Head::new(body, config.gaze_speed)?,
            arms: ArmsControl::new(body, &rest, config.arms_time)?,
            balance: Balance::new(body, omega, config.velocity_blend, com.xy()),
            soles: Soles::new(body, config.sole_margin),
            feet_control: FeetControl::new(&config),
            ankles: Ankles::new(&config, body),
            capture: Capture::new(&config, planner),
            posture: Posture::new(body, &config)?,
            targets: JointTargets {
                positions_rad: rest,
                velocities_radps: vec![0.0; joints],
                torques_nm: vec![0.0; joints],
            },
            com: middle,
            pressure: Pressure {
                share: [0.5; 2],
                point: Side::BOTH.map(|side| gait.stance_point(side)),
                zmp: middle,
            },
            reference: Reference {
                zmp: middle,
                dcm: middle,
            },
            last_ns: None,
            list: StepList::default(),
            gait,
            config,
            body: body.clone(),
        })
    }

    /// The targets for this tick, on ground with these slopes. Allocates nothing.
    pub fn step(
        &mut self,
        command: &Command,
        observation: &Observation,
        state: &BodyState,
        slopes: Option<&dyn Slopes>,
    ) -> Result<&JointTargets, WalkError> {
        let passed_s = self.pass(observation.time_ns);
        self.sense(observation, state, passed_s);
        let error = self.balance.dcm() - self.reference.dcm;
        let omega = self.balance.omega();
        let rate = self
            .capture
            .adjust(&mut self.gait, &self.soles, &error, omega, passed_s);
        self.gait.catch_tipping(&error);
        let felt = self.feel(observation, state);
        let frame = self.frame(&felt);
        self.list.take(&command.motion, &mut self.gait, frame);
        let relief = Relief::new(slopes, frame.planar);
        let task = self.list.task(&command.motion, &self.gait, relief);
        self.gait
            .advance(passed_s * rate, task, &Ground::Felt(felt));
        let task = self.list.task(&command.motion, &self.gait, relief);
        self.reference = self.gait.reference(omega, task);
        self.com += (self.reference.dcm - self.com) * (omega * passed_s)
            + (self.balance.com - self.com) * (self.config.reference_pull * passed_s);
        self.pressure = self.pressed();
        self.feet_control.update(
            &self.gait.phase,
            &self.pressure.share,
            &state.foot_loads_n,
            self.weight_n,
            passed_s,
        );
        let (gait, control) = (&self.gait, &mut self.feet_control);
        let feet = Side::BOTH.map(|side| control.place(&gait.phase, gait.foot(side), side));
        let moment = Moment {
            body: &self.body,
            course: Course {
                gait: &self.gait,
                task,
                omega,
                com: self.com,
            },
            balance: &self.balance,
            ankles: &self.ankles,
            passed_s,
        };
        let targets = &mut self.targets;
        self.posture.pose(&moment, &feet, targets)?;
        let torques = &mut targets.torques_nm;
        self.posture
            .feed_forward(&moment, &state.links, &self.pressure, torques);
        self.head.turn(&command.gaze, passed_s, &mut self.targets);
        let standing = self.gait.is_standing();
        self.arms
            .turn(command.arms, standing, passed_s, &mut self.targets);
        Ok(&self.targets)
    }

    /// Whether it stands still on both soles.
    pub fn standing(&self) -> bool {
        self.gait.is_standing()
    }

    /// Distance between the soles' centres when it stands, m.
    pub const fn stance_width_m(&self) -> f64 {
        self.config.stance_width
    }

    /// Landings so far.
    pub const fn steps_taken(&self) -> u64 {
        self.gait.steps_taken
    }

    /// How the listed footsteps go.
    pub fn stepping(&self) -> Stepping {
        self.gait.stepping()
    }

    /// The foot that stands while the other moves; `None` while both carry.
    pub const fn support(&self) -> Option<Side> {
        match &self.gait.phase {
            Phase::Single { swing, .. } => Some(swing.side.other()),
            Phase::Standing | Phase::Double { .. } => None,
        }
    }

    /// Whether the list that was given last is behind the robot: all its steps landed, or it was given up.
    pub fn list_is_over(&self) -> bool {
        self.list.is_over(&self.gait)
    }

    /// Whether each foot stands, or is to land, on a slope.
    pub fn on_slope(&self) -> [bool; 2] {
        let mut feet = self.gait.feet;
        if let Phase::Single { swing, .. } = &self.gait.phase {
            feet[swing.side.index()] = swing.to;
        }
        feet.map(|foot| foot.gradient != Vector2::zeros())
    }

    /// Where a foot stands, or left, in the walker's own frame, which drifts against the world's.
    pub const fn foot_in_plan(&self, side: Side) -> &FootPose {
        &self.gait.feet[side.index()]
    }

    /// What the feet do, for the recording.
    pub const fn phase(&self) -> &Phase {
        &self.gait.phase
    }

    /// Where the robot should be, where it is, and how it pushes, for the recording.
    pub const fn balance(&self) -> (&Reference, &Balance, &Pressure) {
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
        passed_s.clamp(0.1 * TICK_S, 2.0 * TICK_S)
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
            weight_n: self.weight_n,
            passed_s,
        };
        self.balance.update(&sensed, &self.pressure.zmp);
        self.ankles.update(
            &self.gait.phase,
            &self.gait.feet,
            &self.pressure,
            &observation.foot_forces_n,
            passed_s,
        );
    }

    /// What the feet feel.
    fn feel(&self, observation: &Observation, state: &BodyState) -> Felt {
        let plan_from_sole = Side::BOTH.map(|side| {
            self.balance.plan_from_torso * self.body.torso_from_sole(&state.links, side)
        });
        Felt {
            loads_n: state.foot_loads_n,
            soles_m: plan_from_sole.map(|pose| pose.translation.vector),
            short_m: self.posture.short_m(),
            pressed_m: Side::BOTH
                .map(|side| self.soles.pressed_m(side, &observation.foot_forces_n)),
        }
    }

    /// The robot's frame in the plan: midway between the soles as they are.
    fn frame(&self, felt: &Felt) -> Frame {
        let mut planar = Gait::center_of(&self.gait.feet);
        let middle = 0.5 * (felt.soles_m[0] + felt.soles_m[1]);
        (planar.x_m, planar.y_m) = (middle.x, middle.y);
        Frame {
            planar,
            ground_m: self.gait.ground_m(),
        }
    }

    /// DCM feedback: p = p_ref + k (xi - xi_ref), within the soles that stand.
    fn pressed(&self) -> Pressure {
        let error = self.balance.dcm() - self.reference.dcm;
        let wanted = self.reference.zmp + error * self.config.dcm_gain;
        let (gait, soles) = (&self.gait, &self.soles);
        if let Some(stance) = self.support() {
            soles.on_one(&gait.feet, stance, &wanted)
        } else {
            let carry = Side::BOTH.map(|side| gait.support_point(&gait.feet, side));
            soles.on_both(&gait.feet, &carry, &wanted)
        }
    }
}

#[cfg(test)]
#[path = "walker_tests.rs"]
mod tests;

#[cfg(test)]
#[path = "climbing_tests.rs"]
mod climbing_tests;

#[cfg(test)]
#[path = "slope_tests.rs"]
mod slope_tests;

#[cfg(test)]
#[path = "list_tests.rs"]
mod list_tests;
