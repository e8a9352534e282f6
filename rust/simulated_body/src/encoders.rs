//! The encoders: joint angles with an offset each, in steps of a quantum; velocities with noise.

use serde::Deserialize;
use settings::{POSITIVE, Table, settings};

use crate::error::check_length;
use crate::truth::needs;
use crate::{Normals, SimulatedBodyError, TrueState};

settings! {
    /// How encoders measure.
    pub struct EncodersTuning("senses.encoders") {
        /// Two readings this far apart give a joint's velocity.
        velocity_span: f64 = 0.02, "s", POSITIVE;
    }
}

/// What encoders there are.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EncodersConfig {
    /// Index of each joint's angle in `qpos`, by the robot's joint order.
    pub positions: Vec<usize>,
    /// Index of each joint's velocity in `qvel`.
    pub velocities: Vec<usize>,
    /// Step of the readings, rad; 0 for exact readings and velocities.
    pub quantum_rad: f64,
    /// Joints without an encoder, which the one of another joint speaks for.
    pub followers: Vec<SpokenFor>,
    /// Seed of the velocities' noise.
    pub seed: u64,
    /// How they measure.
    #[serde(default)]
    pub tuning: EncodersTuning,
}

/// A joint without an encoder, turned by the motor of one that has one.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpokenFor {
    /// Its place in the joint order.
    pub joint: usize,
    /// That of the joint with the encoder.
    pub by: usize,
    /// How far it turns for each radian of that joint.
    pub ratio: f64,
    /// Its angle where that joint's is zero, rad.
    pub offset_rad: f64,
}

/// The encoders of one robot.
#[derive(Debug, Clone)]
pub struct Encoders {
    config: EncodersConfig,
    velocity_noise_radps: f64,
    normals: Normals,
}

impl Encoders {
    /// Makes them.
    pub fn new(config: EncodersConfig) -> Result<Self, SimulatedBodyError> {
        config.tuning.check()?;
        check_length(
            "velocities",
            config.velocities.len(),
            config.positions.len(),
        )?;
        // Two readings differ by two independent rounding errors, each of sigma quantum / sqrt(12).
        let of_two = (2.0 / f64::from(12)).sqrt();
        Ok(Self {
            velocity_noise_radps: config.quantum_rad * of_two / config.tuning.velocity_span,
            normals: Normals::new(config.seed),
            config,
        })
    }

    /// How many joints there are.
    pub const fn joints(&self) -> usize {
        self.config.positions.len()
    }

    /// Whether the state has all that is read of it.
    pub(crate) fn fits(&self, state: &TrueState<'_>) -> Result<(), SimulatedBodyError> {
        let end = |indices: &[usize]| indices.iter().max().map_or(0, |last| last + 1);
        needs("qpos", state.qpos, end(&self.config.positions))?;
        needs("qvel", state.qvel, end(&self.config.velocities))
    }

    /// Reads them: angles (rad) and velocities (rad/s) by the robot's joint order.
    ///
    /// `lead_rad` is how far each motor, where the encoder sits, leads its joint; `offsets_rad` what each encoder reads too much.
    pub fn read(
        &mut self,
        state: &TrueState<'_>,
        lead_rad: Option<&[f64]>,
        offsets_rad: &[f64],
    ) -> Result<(Vec<f64>, Vec<f64>), SimulatedBodyError> {
        check_length("offsets", offsets_rad.len(), self.joints())?;
        let config = &self.config;
        let mut angles: Vec<f64> = config.positions.iter().map(|&at| state.qpos[at]).collect();
        if let Some(lead_rad) = lead_rad {
            check_length("lead", lead_rad.len(), angles.len())?;
            for (angle, lead) in angles.iter_mut().zip(lead_rad) {
                *angle += lead;
            }
        }
        for (angle, offset) in angles.iter_mut().zip(offsets_rad) {
            *angle += offset;
        }
        let velocity = |&at: &usize| state.qvel[at];
        let mut velocities: Vec<f64> = config.velocities.iter().map(velocity).collect();
        if config.quantum_rad > 0.0 {
            for angle in &mut angles {
                *angle = (*angle / config.quantum_rad).round_ties_even() * config.quantum_rad;
            }
            for velocity in &mut velocities {
                *velocity += self.velocity_noise_radps * self.normals.draw();
            }
        }
        for tie in &config.followers {
            angles[tie.joint] = tie.offset_rad + tie.ratio * angles[tie.by];
            velocities[tie.joint] = tie.ratio * velocities[tie.by];
        }
        Ok((angles, velocities))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::truth::tests::{Arrays, arrays};

    const QUANTUM_RAD: f64 = 0.001_534;

    fn encoders(quantum_rad: f64, followers: Vec<SpokenFor>) -> Encoders {
        Encoders::new(EncodersConfig {
            positions: vec![8, 7],
            velocities: vec![7, 6],
            quantum_rad,
            followers,
            seed: 5,
            tuning: EncodersTuning::default(),
        })
        .unwrap()
    }

    fn at(one: f64, two: f64) -> Arrays {
        let mut made = arrays();
        (made.qpos[7], made.qpos[8]) = (one, two);
        made
    }

    proptest! {
        #[test]
        fn an_encoder_reads_its_joint_and_offset_to_half_a_quantum(angle in -2.0..2.0, offset in -0.1..0.1) {
            let (readings, _) = encoders(QUANTUM_RAD, vec![]).read(&at(0.0, angle).state(), None, &[offset, 0.0]).unwrap();
            prop_assert!((readings[0] - angle - offset).abs() <= QUANTUM_RAD / 2.0 + 1e-12);
            let steps = readings[0] / QUANTUM_RAD;
            prop_assert!((steps - steps.round()).abs() < 1e-6);
            prop_assert_eq!(readings[1], 0.0);
        }
    }

    #[test]
    fn ideal_encoders_are_exact() {
        let mut made = at(0.123_456_7, -0.765_432_1);
        (made.qvel[6], made.qvel[7]) = (1.5, -2.5);
        let read = encoders(0.0, vec![]).read(&made.state(), None, &[0.0; 2]);
        assert_eq!(read, Ok((vec![-0.765_432_1, 0.123_456_7], vec![-2.5, 1.5])));
    }

    #[test]
    fn encoders_sit_at_the_motors() {
        let lead = Some([0.5, 0.25].as_slice());
        let (readings, _) = encoders(0.0, vec![])
            .read(&at(0.0, 1.0).state(), lead, &[0.0; 2])
            .unwrap();
        assert_eq!(readings, vec![1.5, 0.25]);
    }

    #[test]
    fn a_joint_without_an_encoder_reads_what_its_leader_reads() {
        let mut made = at(0.302, 0.3);
        made.qvel[7] = 1.0;
        let alike = SpokenFor {
            joint: 1,
            by: 0,
            ratio: 1.0,
            offset_rad: 0.0,
        };
        let (readings, velocities) = encoders(QUANTUM_RAD, vec![alike])
            .read(&made.state(), Some(&[0.5; 2]), &[0.01, 0.2])
            .unwrap();
        assert_eq!(readings[0], readings[1]);
        assert!((readings[0] - 0.81).abs() < QUANTUM_RAD);
        assert_eq!(velocities[0], velocities[1]);
        let geared = SpokenFor {
            ratio: -0.5,
            offset_rad: 0.1,
            ..alike
        };
        let (readings, velocities) = encoders(0.0, vec![geared])
            .read(&made.state(), None, &[0.0; 2])
            .unwrap();
        assert!((readings[1] - (0.1 - 0.5 * readings[0])).abs() < 1e-12);
        assert_eq!(velocities[1], -0.5 * velocities[0]);
    }

    #[test]
    fn velocities_have_the_noise_of_two_readings() {
        let mut made = at(0.0, 0.0);
        made.qvel[7] = 1.0;
        let mut noisy = encoders(QUANTUM_RAD, vec![]);
        let found: Vec<f64> = (0..5000)
            .map(|_| noisy.read(&made.state(), None, &[0.0; 2]).unwrap().1[0] - 1.0)
            .collect();
        let mean = found.iter().sum::<f64>() / found.len() as f64;
        let sigma = (found.iter().map(|value| value * value).sum::<f64>() / 5000.0).sqrt();
        assert!(mean.abs() < 0.003, "{mean}");
        let expected = QUANTUM_RAD * (2.0_f64 / 12.0).sqrt() / 0.02;
        assert!((sigma / expected - 1.0).abs() < 0.05, "{sigma}");
    }

    #[test]
    fn a_model_that_has_not_all_of_the_joints_is_refused() {
        let mut made = arrays();
        made.qpos.truncate(8);
        let said = encoders(0.0, vec![]).fits(&made.state()).unwrap_err();
        assert_eq!(said.to_string(), "qpos has 8 numbers, 9 are needed");
        let offsets = encoders(0.0, vec![]).read(&arrays().state(), None, &[0.0]);
        assert_eq!(
            offsets.unwrap_err().to_string(),
            "offsets has 1 values, the robot has 2 joints"
        );
    }
}
