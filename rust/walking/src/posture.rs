//! From centre of mass and feet to joint angles, and the torques that hold them.

use geometry::GRAVITY_MPS2;
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use robot::{Body, LinkPoses, MOST_LEG_JOINTS, Side};

use crate::ankles::Ankles;
use crate::balance::Balance;
use crate::config::GaitConfig;
use crate::error::WalkError;
use crate::gait::Gait;
use crate::heel::{Heel, LevelSole};
use crate::leg::{LegAngles, LegSolver};
use crate::pelvis::{Course, Pelvis};
use crate::phase::{FootPose, GaitPhase};
use crate::shared_hip::SharedHip;
use crate::support::Pressure;
use crate::targets::JointTargets;
use crate::trunk::Trunk;
use crate::tuning::PostureTuning;

/// What a posture is for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PostureMoment<'a> {
    /// The body.
    pub(crate) body: &'a Body,
    /// The steps, and where they lead the centre of mass.
    pub(crate) course: Course<'a>,
    /// The measured balance.
    pub(crate) balance: &'a Balance,
    /// How far the torso is to roll to its right, rad.
    pub(crate) roll_rad: f64,
    /// How the soles are turned.
    pub(crate) ankles: &'a Ankles,
    /// Time since the last tick, s.
    pub(crate) passed_s: f64,
}

/// The legs and what they carry.
#[derive(Debug, Clone)]
pub(crate) struct Posture {
    legs: [LegSolver; 2],
    shared_hip: Option<SharedHip>,
    mass_kg: f64,
    pelvis: Pelvis,
    heel: Heel,
    swing_tilt: f64,
    tuning: PostureTuning,
    yaw_rad: f64,
    tilt_weight: [f64; 2],
    short_m: [f64; 2],
    /// The legs' angles of the last tick, rad: where the next ones are looked for.
    near_rad: [[f64; MOST_LEG_JOINTS]; 2],
    poses: LinkPoses,
}

impl Posture {
    /// For this body and gait; fails where a leg does not fit the inverse kinematics.
    pub(crate) fn new(body: &Body, config: &GaitConfig) -> Result<Self, WalkError> {
        let tuning = &config.tuning;
        let half_sole_m = 0.5 * body.description().legs.left.sole.length;
        let leg = |side| LegSolver::new(body, side, config.max_extension, &tuning.leg);
        let legs = [leg(Side::Left)?, leg(Side::Right)?];
        Ok(Self {
            shared_hip: SharedHip::read(body, &legs, &tuning.shared_hip)?,
            near_rad: [0, 1].map(|index: usize| *legs[index].rest_rad()),
            legs,
            mass_kg: body.mass_kg(),
            pelvis: Pelvis::new(config, half_sole_m),
            heel: Heel::new(config, half_sole_m),
            swing_tilt: config.swing_tilt,
            tuning: tuning.posture.clone(),
            yaw_rad: 0.0,
            tilt_weight: [0.0; 2],
            short_m: [0.0; 2],
            poses: LinkPoses::default(),
        })
    }

    /// Writes the legs' angles and speeds that put the centre of mass over its reference and the soles at `feet`, torso upright along the
    /// feet's mean heading. The torso follows from the centre of mass of the last tick's targets.
    pub(crate) fn pose(
        &mut self,
        moment: &PostureMoment<'_>,
        feet: &[FootPose; 2],
        targets: &mut JointTargets,
    ) -> Result<(), WalkError> {
        let PostureMoment { body, passed_s, .. } = *moment;
        let goal = Gait::center_of(feet).yaw_rad;
        let turn = geometry::angle_between(self.yaw_rad, goal);
        let share = (self.tuning.turn_rate * passed_s).min(1.0);
        self.yaw_rad = geometry::wrap_angle(self.yaw_rad + turn * share);
        body.pose_links(&targets.positions_rad, &mut self.poses)?;
        let about = body.center_of_mass_in_torso(&self.poses);
        let trunk = Trunk {
            heading: UnitQuaternion::from_axis_angle(&Vector3::z_axis(), self.yaw_rad),
            com: about.coords,
            hips: [0, 1].map(|index| *self.legs[index].hip()),
            roll_rad: moment.roll_rad,
        };
        let course = &moment.course;
        let (height, lean_rad) = self
            .pelvis
            .place(course, &self.legs, &trunk, feet, passed_s);
        let rotation = trunk.rotation(lean_rad);
        let over = course.com - (rotation * about.coords).xy();
        let place = Translation3::new(over.x, over.y, height);
        let plan_from_torso = Isometry3::from_parts(place, rotation);
        let torso_from_plan = plan_from_torso.inverse();
        let mut soles = Side::BOTH.map(|side| {
            let lean = self.lean(moment, &plan_from_torso, side);
            let sole = feet[side.index()].plan_from_sole();
            torso_from_plan * lean * sole * moment.ankles.level_from_sole(side)
        });
        if let Some(side) = Heel::behind(course.gait, &self.legs) {
            let index = side.index();
            let level = LevelSole {
                side,
                torso_from_sole: soles[index],
                front_m: feet[index].bearing.to_m,
            };
            let (leg, joints) = (&self.legs[index], &targets.positions_rad);
            soles[index] = self.heel.lifted(body, leg, &level, joints)?;
        }
        let solutions = self.solve(&soles, &about);
        self.short_m = [0, 1].map(|index| solutions[index].short_m);
        self.near_rad = [0, 1].map(|index| solutions[index].angles_rad);
        for (leg, solution) in self.legs.iter().zip(&solutions) {
            for (&joint, &angle) in leg.joints().iter().zip(&solution.angles_rad) {
                let before = targets.positions_rad[joint];
                targets.velocities_radps[joint] = (angle - before) / passed_s;
                targets.positions_rad[joint] = angle;
            }
        }
        Ok(())
    }

    /// How far each leg was from reaching where its foot was put at the last tick, m: the hips are on their way down.
    pub(crate) const fn short_m(&self) -> [f64; 2] {
        self.short_m
    }

    /// Both legs' angles; where they share a motor, the torso turns about `about` until they agree.
    fn solve(
        &mut self,
        torso_from_sole: &[Isometry3<f64>; 2],
        about: &Point3<f64>,
    ) -> [LegAngles; 2] {
        let Some(shared_hip) = &self.shared_hip else {
            return [0, 1].map(|index| {
                self.legs[index].solve(&torso_from_sole[index], &self.near_rad[index])
            });
        };
        let agreement = shared_hip.agree(&self.legs, torso_from_sole, about, &self.near_rad);
        self.yaw_rad = geometry::wrap_angle(self.yaw_rad + agreement.turn_rad);
        agreement.legs
    }

    /// How the plan appears to a leg whose foot is in the air, as seen from the reference's torso: leaning by the measured tilt,
    /// so that the foot meets the ground at its time. Fades in after lifting and out after landing.
    fn lean(
        &mut self,
        moment: &PostureMoment<'_>,
        plan_from_torso: &Isometry3<f64>,
        side: Side,
    ) -> Isometry3<f64> {
        let gait = moment.course.gait;
        let goal = match &gait.phase {
            GaitPhase::Single { swing, .. } if swing.side == side => self.swing_tilt,
            _ => 0.0,
        };
        let most = self.tuning.tilt_fade * moment.passed_s;
        let weight = &mut self.tilt_weight[side.index()];
        *weight += (goal - *weight).clamp(-most, most);
        if *weight <= 0.0 {
            return Isometry3::identity();
        }
        let measured = moment.balance.plan_from_torso.rotation;
        let error = (measured * plan_from_torso.rotation.inverse()).scaled_axis();
        let size = error.norm();
        let used = (size - self.tuning.tilt_deadband).max(0.0) / size.max(1e-9) * *weight;
        let turn = UnitQuaternion::from_scaled_axis(-error * used);
        let pivot = gait.feet[side.other().index()]
            .plan_from_sole()
            .translation
            .vector;
        Isometry3::from_parts(Translation3::from(pivot - turn * pivot), turn)
    }

    /// Writes the torques that hold the measured posture against gravity while the feet push as in `pressure`: the weight of
    /// what each joint carries beyond itself, and J^T f of the force under each sole. The horizontal force is the pendulum's,
    /// m w^2 (c - p).
    pub(crate) fn feed_forward(
        &self,
        moment: &PostureMoment<'_>,
        links: &LinkPoses,
        pressure: &Pressure,
        torques_nm: &mut [f64],
    ) {
        let PostureMoment {
            body,
            course: Course { gait, .. },
            balance,
            ..
        } = *moment;
        torques_nm.fill(0.0);
        let torso_from_plan = balance.plan_from_torso.rotation.inverse();
        let gravity = torso_from_plan * Vector3::new(0.0, 0.0, -GRAVITY_MPS2);
        body.add_gravity(links, &gravity, torques_nm);
        let omega2 = balance.omega * balance.omega;
        let pull = (balance.com - pressure.zmp) * (self.mass_kg * omega2);
        let force = torso_from_plan * Vector3::new(pull.x, pull.y, self.mass_kg * GRAVITY_MPS2);
        for side in Side::BOTH {
            let index = side.index();
            let point = pressure.point[index];
            let (x, y) = gait.feet[index].planar.inverse().apply(point.x, point.y);
            let at = body.torso_from_sole(links, side) * Point3::new(x, y, 0.0);
            let push = force * pressure.share[index];
            body.add_force(links, body.sole_link(side), &at, &push, torques_nm);
        }
        for torque in torques_nm.iter_mut() {
            *torque = -*torque;
        }
        for follower in &body.followers {
            torques_nm[follower.leader] += torques_nm[follower.joint] * follower.ratio;
            torques_nm[follower.joint] = 0.0;
        }
    }
}
