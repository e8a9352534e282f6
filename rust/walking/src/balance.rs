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
    /// Planned headings of the feet at the last tick, rad.
    yaws_rad: [f64; 2],
    turned: f64,
    started: bool,
    /// Orientation of the torso by the inertial measurement unit, heading by the standing foot.
    pub plan_from_torso: Isometry3<f64>,
    /// Centre of mass over the ground, m.
    pub com: Vector2<f64>,
    /// Speed of the centre of mass, m/s.
    pub velocity_mps: Vector2<f64>,
    /// Measured centre of pressure, m; `None` while the feet carry next to nothing.
    pub pressure: Option<Vector2<f64>>,
    /// Share of the weight that the feet carry.
    pub(crate) carried: f64,
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
            yaws_rad: [0.0; 2],
            turned: config.tuning.balance.turned,
            started: false,
            plan_from_torso: Isometry3::identity(),
            com,
            velocity_mps: Vector2::zeros(),
            pressure: None,
            carried: 1.0,
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
            let before = self.before(index, foot.planar.yaw_rad);
            speed += (arm.xy() - before) * (trust / sensed.passed_s);
            self.arms[index] = arm.xy();
            self.plan_from_torso.rotation = rotation;
        }
        self.plan_from_torso.translation = Translation3::from(torso);
        self.pressure = self.center_of_pressure(sensed);
        self.carried = sensed.foot_forces_n.iter().flatten().sum::<f64>() / sensed.weight_n;
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

    /// Where the centre of mass was from a foot at the last tick, had the foot been planned to be turned as it is now, m. A foot that
    /// lands turned turns with it all that is known by its heading, and that is no motion of the body.
    fn before(&mut self, index: usize, yaw_rad: f64) -> Vector2<f64> {
        let turn_rad = self.turned * geometry::angle_between(self.yaws_rad[index], yaw_rad);
        self.yaws_rad[index] = yaw_rad;
        let (x_m, y_m) =
            PlanarPose::new(0.0, 0.0, turn_rad).apply(self.arms[index].x, self.arms[index].y);
        Vector2::new(x_m, y_m)
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
    let turn = foot.yaw_rad - libm::atan2(toes.y, toes.x);
    UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn) * attitude
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_biped::{biped, config, foot_at};

    /// Speed of the centre of mass, m/s, that stays where it is over the left foot, which is planned to be turned from one tick to the next.
    fn speed_mps(turned: f64, turn_rad: f64) -> f64 {
        let mut config = config();
        config.tuning.balance.turned = turned;
        let mut balance = Balance::new(&biped(), &config, 6.0, Vector2::zeros());
        let level = UnitQuaternion::identity();
        for yaw_rad in [0.0, turn_rad] {
            let left = FootPose {
                planar: PlanarPose::new(0.0, 0.0425, yaw_rad),
                ..FootPose::default()
            };
            let sole = |y: f64| Isometry3::from_parts(Translation3::new(0.0, y, -0.3), level);
            balance.update(
                &Sensed {
                    attitude: &level,
                    torso_from_sole: [sole(0.0425), sole(-0.0425)],
                    com_in_torso: Vector3::new(0.0, 0.0, 0.0),
                    foot_forces_n: &[[0.0; 4]; 2],
                    feet: &[left, foot_at(0.0, -0.0425)],
                    trust: [1.0, 0.0],
                    weight_n: 70.0,
                    passed_s: 0.01,
                },
                &Vector2::zeros(),
            );
        }
        // Without what the pendulum makes of where the centre of mass is then.
        (balance.velocity_mps / balance.blend - balance.com * (36.0 * 0.01)).norm()
    }

    #[test]
    fn a_foot_that_lands_turned_is_no_jump_of_the_centre_of_mass_where_that_is_taken_out() {
        assert!(speed_mps(1.0, 0.25) < 0.02, "{}", speed_mps(1.0, 0.25));
        assert!(speed_mps(0.0, 0.25) > 0.5);
        assert!((speed_mps(0.0, 0.0) - speed_mps(1.0, 0.0)).abs() < 1e-12);
    }
}
