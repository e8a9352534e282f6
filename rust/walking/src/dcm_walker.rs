//! The walker of the name `dcm`: a command in, targets for all joints out, at every control tick.

use behaviour::Command;
use geometry::GRAVITY_MPS2;
use nalgebra::Vector2;
use proprioception::BodyState;
use robot::{Body, Side};
use sensing::{Observation, TICK_S};

use crate::ankles::Ankles;
use crate::arms::ArmsControl;
use crate::balance::{Balance, Sensed};
use crate::capture::Capture;
use crate::catching::Catching;
use crate::config::GaitConfig;
use crate::descent::Descent;
use crate::drives::Drives;
use crate::error::WalkError;
use crate::feet::FeetControl;
use crate::felt::{Felt, KnownGround};
use crate::footsteps::FootstepPlanner;
use crate::gait::Gait;
use crate::gaze::HeadControl;
use crate::landing_search::Falling;
use crate::met::Met;
use crate::pelvis::Course;
use crate::phase::GaitReference;
use crate::posture::{Posture, PostureMoment};
use crate::relief::Relief;
use crate::stance::UprightStance;
use crate::step_list::{ListFrame, StepList};
use crate::support::{Pressure, Soles};
use crate::targets::JointTargets;
use crate::walker::WalkerSenses;

mod telling;

pub(crate) use telling::PART;

/// Walks. One a robot; see the crate's page for the parts.
#[derive(Debug, Clone)]
pub struct DcmWalker {
    pub(crate) body: Body,
    config: GaitConfig,
    weight_n: f64,
    head: HeadControl,
    arms: ArmsControl,
    drives: Drives,
    pub(crate) gait: Gait,
    pub(crate) list: StepList,
    pub(crate) balance: Balance,
    soles: Soles,
    feet_control: FeetControl,
    ankles: Ankles,
    capture: Capture,
    catching: Catching,
    posture: Posture,
    com: Vector2<f64>,
    reference: GaitReference,
    pub(crate) pressure: Pressure,
    pub(crate) targets: JointTargets,
    last_ns: Option<u64>,
    met: Option<Met>,
}

impl DcmWalker {
    /// A walker for this body, standing as in the body's description; its gait is the description's `[gait]`.
    pub fn new(body: &Body) -> Result<Self, WalkError> {
        let (config, stance) = GaitConfig::read(body)?;
        let UprightStance {
            rest, feet, com, ..
        } = stance;
        let omega = (GRAVITY_MPS2 / com.z).sqrt();
        let planner = FootstepPlanner::new(&config, body);
        let mut gait = Gait::new(&config, planner.clone(), feet);
        gait.descent = Some(Descent::read(body, &config, &rest)?);
        let (joints, middle) = (rest.len(), gait.middle());
        Ok(Self {
            weight_n: body.mass_kg() * GRAVITY_MPS2,
            head: HeadControl::new(body, config.gaze_speed)?,
            arms: ArmsControl::new(body, &rest, config.arms_time)?,
            drives: Drives::new(body),
            balance: Balance::new(body, &config, omega, com.xy()),
            soles: Soles::new(body, config.sole_margin),
            feet_control: FeetControl::new(&config),
            ankles: Ankles::new(&config, body),
            capture: Capture::new(&config, planner.clone()),
            catching: Catching::new(&config, planner),
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
            reference: GaitReference {
                zmp: middle,
                dcm: middle,
            },
            last_ns: None,
            met: None,
            list: StepList::default(),
            gait,
            config,
            body: body.clone(),
        })
    }

    /// The targets for this tick. Allocates nothing.
    fn targets(
        &mut self,
        command: &Command,
        senses: &WalkerSenses<'_>,
    ) -> Result<&JointTargets, WalkError> {
        let WalkerSenses {
            observation,
            state,
            slopes,
            ..
        } = *senses;
        let passed_s = self.pass(observation.time_ns);
        self.sense(observation, state, passed_s);
        let error = self.balance.dcm() - self.reference.dcm;
        let omega = self.balance.omega;
        self.put_down_in_time(&error, observation);
        let felt = self.feel(observation, state);
        let frame = self.frame(&felt);
        self.list.take(&command.motion, &mut self.gait, frame);
        self.gait.carries_first = command.carries_first;
        let relief = Relief::new(slopes, frame.planar, &self.config.tuning.relief);
        let task = self.list.task(&command.motion, &self.gait, relief);
        let (balance, reference) = (&self.balance, &self.reference);
        let falling = Falling::new(balance, reference, &felt, &self.soles, task, passed_s);
        let (gait, soles) = (&mut self.gait, &self.soles);
        let caught = self.catching.step(gait, &falling);
        let rate =
            caught.unwrap_or_else(|| self.capture.adjust(gait, soles, &error, omega, passed_s));
        self.gait
            .advance(passed_s * rate, task, &KnownGround::Felt(felt));
        self.met = self.gait.take_met().map(|met| met.seen_from(&frame.planar));
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
        let moment = PostureMoment {
            body: &self.body,
            course: Course {
                gait: &self.gait,
                task,
                omega,
                com: self.com,
            },
            balance: &self.balance,
            roll_rad: self.catching.roll_rad(),
            ankles: &self.ankles,
            passed_s,
        };
        let targets = &mut self.targets;
        self.posture.pose(&moment, &feet, targets)?;
        let torques = &mut targets.torques_nm;
        self.posture
            .feed_forward(&moment, &state.links, &self.pressure, torques);
        self.head_and_arms(command, passed_s);
        Ok(&self.targets)
    }

    fn head_and_arms(&mut self, command: &Command, passed_s: f64) {
        self.head.turn(&command.gaze, passed_s, &mut self.targets);
        let standing = self.gait.is_standing();
        self.arms
            .turn(command.arms, standing, passed_s, &mut self.targets);
        self.drives.turn(&mut self.targets);
    }

    fn pass(&mut self, now_ns: u64) -> f64 {
        let passed_s = match self.last_ns {
            Some(last_ns) if now_ns > last_ns => (now_ns - last_ns) as f64 * 1e-9,
            _ => TICK_S,
        };
        self.last_ns = Some(now_ns);
        let tuning = &self.config.tuning.ticks;
        passed_s.clamp(tuning.shortest * TICK_S, tuning.longest * TICK_S)
    }

    fn sense(&mut self, observation: &Observation, state: &BodyState, passed_s: f64) {
        let [left, right] = state.foot_loads_n.map(|load| load.max(0.0));
        let least_n = self.config.tuning.ticks.least_load;
        let trust = match self.support() {
            Some(Side::Left) => [1.0, 0.0],
            Some(Side::Right) => [0.0, 1.0],
            None if left + right > least_n => [left / (left + right), right / (left + right)],
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
        let pressed_m =
            Side::BOTH.map(|side| self.soles.pressed_m(side, &observation.foot_forces_n));
        let touched_m = [0, 1].map(|foot: usize| {
            let [x_m, y_m] = pressed_m[foot].into();
            (plan_from_sole[foot] * nalgebra::Point3::new(x_m, y_m, 0.0)).coords
        });
        Felt {
            loads_n: state.foot_loads_n,
            soles_m: plan_from_sole.map(|pose| pose.translation.vector),
            short_m: self.posture.short_m(),
            pressed_m,
            touched_m,
        }
    }

    /// The robot's frame in the plan: midway between the soles as they are.
    fn frame(&self, felt: &Felt) -> ListFrame {
        let mut planar = Gait::center_of(&self.gait.feet);
        let middle = 0.5 * (felt.soles_m[0] + felt.soles_m[1]);
        (planar.x_m, planar.y_m) = (middle.x, middle.y);
        ListFrame {
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
#[path = "dcm_walker_tests.rs"]
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

#[cfg(test)]
#[path = "mixed_list_tests.rs"]
mod mixed_list_tests;
