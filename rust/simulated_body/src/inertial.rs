//! The inertial unit: gyro and accelerometer at a place of the robot.

use nalgebra::{Matrix3, Vector3};
use serde::Deserialize;
use settings::{POSITIVE, Table, settings, within};

use crate::truth::{needs, row};
use crate::{Normals, SimulatedBodyError, TrueState};

settings! {
    /// What the inertial unit takes for a motion.
    pub struct InertialTuning("senses.inertial") {
        /// After a longer gap the velocity before it says nothing about the acceleration.
        longest_tick: f64 = 0.05, "s", POSITIVE;
        /// A larger turn within a tick is a kidnap, not a motion.
        largest_turn: f64 = 0.5, "rad", within(0.0, 3.0);
    }
}

/// Where the unit sits, and its errors.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InertialConfig {
    /// Number of the site where it sits; its axes are the site's.
    pub site: usize,
    /// Number of the link that the site is on.
    pub link: usize,
    /// Number of the link that is the root of that link's tree.
    pub root: usize,
    /// What a body at rest feels, m/s², in the world: against gravity.
    pub at_rest_mps2: [f64; 3],
    /// What gyro (rad/s) and accelerometer (m/s²) read too much, each axis.
    pub bias: [f64; 6],
    /// Standard deviation of each sample of gyro and accelerometer; 0 for exact ones.
    pub noise: [f64; 6],
    /// Seed of the noise.
    pub seed: u64,
    /// What it takes for a motion.
    #[serde(default)]
    pub tuning: InertialTuning,
}

/// Gyro and accelerometer.
///
/// Both integrate over the tick, as units with an anti-aliasing filter do: a sample is the mean angular velocity and the mean specific
/// force since the one before, not the peak of an impact. Samples at an instant would beat with the servos, which jump at every tick,
/// and the integral of the gyro would drift with every step.
#[derive(Debug, Clone)]
pub struct InertialUnit {
    config: InertialConfig,
    normals: Normals,
    exact: bool,
    last: Option<UnitMotion>,
}

/// The unit's true motion at a time.
#[derive(Debug, Clone, Copy)]
struct UnitMotion {
    time_ns: u64,
    velocity_mps: Vector3<f64>,
    world_from_unit: Matrix3<f64>,
}

impl InertialUnit {
    /// Makes it.
    pub fn new(config: InertialConfig) -> Result<Self, SimulatedBodyError> {
        config.tuning.check()?;
        Ok(Self {
            normals: Normals::new(config.seed),
            exact: config.noise.iter().all(|&sigma| sigma == 0.0),
            last: None,
            config,
        })
    }

    /// Whether the state has all that is read of it.
    pub(crate) fn fits(&self, state: &TrueState<'_>) -> Result<(), SimulatedBodyError> {
        let config = &self.config;
        needs("site_xpos", state.site_xpos, 3 * (config.site + 1))?;
        needs("site_xmat", state.site_xmat, 9 * (config.site + 1))?;
        needs("cvel", state.cvel, 6 * (config.link + 1))?;
        needs("subtree_com", state.subtree_com, 3 * (config.root + 1))
    }

    /// Reads it: angular velocity (rad/s) and specific force (m/s²) along its axes.
    pub fn read(&mut self, state: &TrueState<'_>, time_ns: u64) -> ([f64; 3], [f64; 3]) {
        let world_from_unit = Matrix3::from_row_slice(&row::<9>(state.site_xmat, self.config.site));
        let (turning_radps, velocity_mps) = self.motion(state);
        let mut felt_mps2 = Vector3::from(self.config.at_rest_mps2);
        let mut mean_radps = None;
        if let Some(last) = self.last {
            let passed_s = (i128::from(time_ns) - i128::from(last.time_ns)) as f64 * 1e-9;
            if passed_s > 0.0 && passed_s <= self.config.tuning.longest_tick {
                felt_mps2 += (velocity_mps - last.velocity_mps) / passed_s;
                let turn_rad =
                    rotation_vector(&(last.world_from_unit.transpose() * world_from_unit));
                if turn_rad.amax() < self.config.tuning.largest_turn {
                    mean_radps = Some(turn_rad / passed_s);
                }
            }
        }
        let unit_from_world = world_from_unit.transpose();
        let turning_radps = mean_radps.unwrap_or_else(|| unit_from_world * turning_radps);
        let force_mps2 = unit_from_world * felt_mps2;
        self.last = Some(UnitMotion {
            time_ns,
            velocity_mps,
            world_from_unit,
        });
        self.err(turning_radps, force_mps2)
    }

    /// Angular velocity and velocity at the site in the world: those of its link, moved there from the centre of mass of the tree.
    fn motion(&self, state: &TrueState<'_>) -> (Vector3<f64>, Vector3<f64>) {
        let config = &self.config;
        let [wx, wy, wz, vx, vy, vz] = row::<6>(state.cvel, config.link);
        let turning_radps = Vector3::new(wx, wy, wz);
        let place_m = Vector3::from(row::<3>(state.site_xpos, config.site));
        let lever_m = place_m - Vector3::from(row::<3>(state.subtree_com, config.root));
        let velocity_mps = Vector3::new(vx, vy, vz) - lever_m.cross(&turning_radps);
        (turning_radps, velocity_mps)
    }

    /// Adds bias and noise.
    fn err(
        &mut self,
        turning_radps: Vector3<f64>,
        force_mps2: Vector3<f64>,
    ) -> ([f64; 3], [f64; 3]) {
        let mut sample: [[f64; 3]; 2] = [turning_radps.into(), force_mps2.into()];
        let errors = self.config.bias.iter().zip(&self.config.noise);
        for (value, (bias, sigma)) in sample.as_flattened_mut().iter_mut().zip(errors) {
            *value += bias;
            if !self.exact {
                *value += sigma * self.normals.draw();
            }
        }
        let [turning_radps, force_mps2] = sample;
        (turning_radps, force_mps2)
    }
}

/// The axis times the angle (rad) of a rotation by less than half a turn.
fn rotation_vector(rotation: &Matrix3<f64>) -> Vector3<f64> {
    let half = |a: (usize, usize), b: (usize, usize)| (rotation[a] - rotation[b]) / 2.0;
    let axis = Vector3::new(
        half((2, 1), (1, 2)),
        half((0, 2), (2, 0)),
        half((1, 0), (0, 1)),
    );
    let sine = axis.norm();
    if sine < 1e-12 {
        return axis;
    }
    axis * (libm::atan2(sine, (rotation.trace() - 1.0) / 2.0) / sine)
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use nalgebra::Rotation3;
    use proptest::prelude::*;

    use super::*;
    use crate::truth::tests::{Arrays, arrays};

    const TICK_NS: u64 = 10_000_000;

    fn unit(bias: [f64; 6], noise: [f64; 6], seed: u64) -> InertialUnit {
        InertialUnit::new(InertialConfig {
            site: 0,
            link: 1,
            root: 1,
            at_rest_mps2: [0.0, 0.0, 9.81],
            bias,
            noise,
            seed,
            tuning: InertialTuning::default(),
        })
        .unwrap()
    }

    fn turned(rotation: &Rotation3<f64>) -> Arrays {
        let mut made = arrays();
        made.site_xmat = rotation.matrix().transpose().as_slice().to_vec();
        made
    }

    #[test]
    fn at_rest_the_accelerometer_reads_gravity_upward_in_its_own_frame() {
        let quarter = Rotation3::from_axis_angle(&Vector3::x_axis(), std::f64::consts::FRAC_PI_2);
        let (turning, force) = unit([0.0; 6], [0.0; 6], 0).read(&turned(&quarter).state(), 0);
        assert_eq!(turning, [0.0; 3]);
        // The unit is turned by 90 degrees about x: its y points up.
        assert_relative_eq!(
            Vector3::from(force),
            Vector3::new(0.0, 9.81, 0.0),
            epsilon = 1e-9
        );
    }

    #[test]
    fn a_gain_of_speed_is_felt_and_a_pause_is_not() {
        let mut made = arrays();
        let mut still = unit([0.0; 6], [0.0; 6], 0);
        let _ = still.read(&made.state(), 0);
        made.cvel[9] = 0.5;
        let (_, force) = still.clone().read(&made.state(), TICK_NS);
        assert_relative_eq!(
            Vector3::from(force),
            Vector3::new(50.0, 0.0, 9.81),
            epsilon = 1e-9
        );
        let (_, force) = still.read(&made.state(), 100 * TICK_NS);
        assert_eq!(force, [0.0, 0.0, 9.81]);
    }

    #[test]
    fn the_lever_from_the_centre_of_mass_is_felt() {
        let mut made = arrays();
        made.cvel[8] = 3.0;
        made.site_xpos[0] = 0.2;
        let (turning, velocity) = unit([0.0; 6], [0.0; 6], 0).motion(&made.state());
        assert_eq!(turning, Vector3::new(0.0, 0.0, 3.0));
        assert_relative_eq!(velocity, Vector3::new(0.0, 0.6, 0.0), epsilon = 1e-12);
    }

    proptest! {
        #[test]
        fn the_gyro_misses_nothing_between_two_readings(x in -0.2..0.2, y in -0.2..0.2, z in -0.2..0.2) {
            let turn = Vector3::new(x, y, z);
            let mut gyro = unit([0.0; 6], [0.0; 6], 0);
            let _ = gyro.read(&arrays().state(), 0);
            let (turning, _) = gyro.read(&turned(&Rotation3::new(turn)).state(), TICK_NS);
            prop_assert!((Vector3::from(turning) * 0.01 - turn).amax() < 1e-9);
        }
    }

    #[test]
    fn a_kidnap_is_no_turn() {
        let mut gyro = unit([0.0; 6], [0.0; 6], 0);
        let _ = gyro.read(&arrays().state(), 0);
        let carried = turned(&Rotation3::new(Vector3::new(0.0, 0.0, 1.0)));
        let (turning, _) = gyro.read(&carried.state(), TICK_NS);
        assert_eq!(turning, [0.0; 3]);
    }

    #[test]
    fn biases_stay_and_noise_is_new() {
        let noise = [0.002, 0.002, 0.002, 0.15, 0.15, 0.15];
        let bias = [0.001, -0.001, 0.0, 0.1, 0.0, -0.1];
        let mut noisy = unit(bias, noise, 7);
        let samples: Vec<[f64; 6]> = (0..4000)
            .map(|tick| {
                let (turning, force) = noisy.read(&arrays().state(), tick * TICK_NS);
                let mut sample = [0.0; 6];
                sample[..3].copy_from_slice(&turning);
                sample[3..].copy_from_slice(&force);
                sample[5] -= 9.81;
                sample
            })
            .collect();
        for axis in 0..6 {
            let mean = samples.iter().map(|sample| sample[axis]).sum::<f64>() / 4000.0;
            let spread = samples.iter().map(|sample| (sample[axis] - mean).powi(2));
            let sigma = (spread.sum::<f64>() / 4000.0).sqrt();
            assert!((mean - bias[axis]).abs() < 4.0 * noise[axis] / 4000_f64.sqrt());
            assert_relative_eq!(sigma, noise[axis], max_relative = 0.05);
        }
    }
}
