//! The stabiliser's eye: centre of mass, its speed and the divergent component of motion from what the body senses.

use geometry::PlanarPose;
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector2, Vector3};
use robot::{Body, Side};

use crate::{config::GaitConfig, phase::FootPose, support::sole_corners};

/// What is known of the balance at a tick, in the plan frame.
#[derive(Debug, Clone)]
pub struct Balance {
    /// Natural frequency of the pendulum, sqrt(g / height), 1/s.
    pub(crate) omega: f64,
    blend: f64,
    /// Share of the weight that the feet must carry for their centre of pressure to count.
    least_share: f64,
    corners: [[Vector2<f64>; 4]; 2],
    arms: [Vector2<f64>; 2],
    started: bool,
    /// Orientation of the torso by the inertial measurement unit, heading by the standing foot.
    pub plan_from_torso: Isometry3<f64>,
    /// Centre of mass over the ground, m.
    pub com: Vector2<f64>,
    /// Speed of the centre of mass, m/s.
    pub velocity_mps: Vector2<f64>,
    /// Measured centre of pressure, m; `None` while the feet carry next to nothing.
    pub pressure: Option<Vector2<f64>>,
}

/// What one tick measures.
#[derive(Debug, Clone, Copy)]
pub struct Sensed<'a> {
    /// The attitude of the torso, roll and pitch against gravity.
    pub attitude: &'a UnitQuaternion<f64>,
    /// Poses of the soles in the torso.
    pub torso_from_sole: [Isometry3<f64>; 2],
    /// Centre of mass in the torso, m.
    pub com_in_torso: Vector3<f64>,
    /// Forces at the soles' corners, N.
    pub foot_forces_n: &'a [[f64; 4]; 2],
    /// Where the feet are planned to stand.
    pub feet: &'a [FootPose; 2],
    /// How much each foot is trusted to stand where it is planned; sums to 1.
    pub trust: [f64; 2],
    /// Weight of the robot, N.
    pub weight_n: f64,
    /// Time since the last tick, s.
    pub passed_s: f64,
}

impl Balance {
    /// A balance at rest over `com`, by this gait.
    pub fn new(body: &Body, config: &GaitConfig, omega: f64, com: Vector2<f64>) -> Self {
        Self {
            omega,
            blend: config.velocity_blend,
            least_share: config.tuning.ticks.pressure_load,
            corners: sole_corners(body),
            arms: [Vector2::zeros(); 2],
            started: false,
            plan_from_torso: Isometry3::identity(),
            com,
            velocity_mps: Vector2::zeros(),
            pressure: None,
        }
    }

    /// The divergent component of motion, c + c'/w.
    pub fn dcm(&self) -> Vector2<f64> {
        self.com + self.velocity_mps / self.omega
    }

    /// Takes in a tick's measurements. Position from the kinematics of the standing leg, turned by the measured roll and pitch;
    /// speed by a complementary filter: the pendulum's acceleration w^2 (c - p) over the measured centre of pressure p, corrected by
    /// the differences of position, each foot's own so that a landing is no jump.
    pub fn update(&mut self, sensed: &Sensed<'_>, commanded_zmp: &Vector2<f64>) {
        let mut com = Vector2::zeros();
        let mut speed = Vector2::zeros();
        let mut torso = Vector3::zeros();
        let support = usize::from(sensed.trust[1] > sensed.trust[0]);
        for index in [1 - support, support] {
            let foot = &sensed.feet[index];
            let torso_from_sole = &sensed.torso_from_sole[index];
            let rotation = heading_of(sensed.attitude, torso_from_sole, &foot.planar);
            let arm = rotation * (sensed.com_in_torso - torso_from_sole.translation.vector);
            let place = Vector3::new(foot.planar.x_m, foot.planar.y_m, foot.z_m);
            let trust = sensed.trust[index];
            torso += (place - rotation * torso_from_sole.translation.vector) * trust;
            com += (place + arm).xy() * trust;
            speed += (arm.xy() - self.arms[index]) * (trust / sensed.passed_s);
            self.arms[index] = arm.xy();
            self.plan_from_torso.rotation = rotation;
        }
        self.plan_from_torso.translation = Translation3::from(torso);
        self.pressure = self.center_of_pressure(sensed);
        if !self.started {
            self.started = true;
            self.com = com;
            self.velocity_mps = Vector2::zeros();
            return;
        }
        let zmp = self.pressure.unwrap_or(*commanded_zmp);
        let predicted =
            self.velocity_mps + (self.com - zmp) * (self.omega * self.omega * sensed.passed_s);
        self.com = com;
        self.velocity_mps = predicted + (speed - predicted) * self.blend;
    }

    fn center_of_pressure(&self, sensed: &Sensed<'_>) -> Option<Vector2<f64>> {
        let mut moment = Vector2::zeros();
        let mut load_n = 0.0;
        for side in Side::BOTH {
            let index = side.index();
            if sensed.trust[index] <= 0.0 {
                continue;
            }
            let foot = &sensed.feet[index].planar;
            for (corner, force) in self.corners[index].iter().zip(&sensed.foot_forces_n[index]) {
                let (x, y) = foot.apply(corner.x, corner.y);
                moment += Vector2::new(x, y) * *force;
                load_n += force;
            }
        }
        (load_n > self.least_share * sensed.weight_n).then(|| moment / load_n)
    }
}

/// The attitude, turned about the vertical so that the sole's heading is the planned one.
fn heading_of(
    attitude: &UnitQuaternion<f64>,
    torso_from_sole: &Isometry3<f64>,
    foot: &PlanarPose,
) -> UnitQuaternion<f64> {
    let toes = attitude * (torso_from_sole.rotation * Vector3::x());
    let turn = foot.yaw_rad - toes.y.atan2(toes.x);
    UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn) * attitude
}
