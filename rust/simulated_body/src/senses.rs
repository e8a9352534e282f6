//! All senses of the robot's own body, read at once.

use serde::Deserialize;

use crate::{
    Encoders, EncodersConfig, FootForces, FootForcesConfig, InertialConfig, InertialUnit,
    SimulatedBodyError, TrueState,
};

/// What senses there are.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodySensesConfig {
    /// The joints' encoders.
    pub encoders: EncodersConfig,
    /// Gyro and accelerometer.
    pub inertial: InertialConfig,
    /// The force sensors under the soles.
    pub feet: FootForcesConfig,
}

/// What the senses say at a control tick.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyReading {
    /// By the robot's joint order.
    pub joint_positions_rad: Vec<f64>,
    /// By the robot's joint order.
    pub joint_velocities_radps: Vec<f64>,
    /// Along the inertial unit's axes.
    pub angular_velocity_radps: [f64; 3],
    /// Along the inertial unit's axes.
    pub specific_force_mps2: [f64; 3],
    /// Left and right; front left, front right, rear left, rear right.
    pub foot_forces_n: [[f64; 4]; 2],
}

/// Encoders, inertial unit and soles. Each errs by a stream of its own: to make one exact leaves the others' numbers.
#[derive(Debug, Clone)]
pub struct BodySenses {
    encoders: Encoders,
    inertial: InertialUnit,
    feet: FootForces,
}

impl BodySenses {
    /// Makes them.
    pub fn new(config: BodySensesConfig) -> Result<Self, SimulatedBodyError> {
        Ok(Self {
            encoders: Encoders::new(config.encoders)?,
            inertial: InertialUnit::new(config.inertial)?,
            feet: FootForces::new(config.feet),
        })
    }

    /// Whether a state has all that is read of it. Ask before the first reading.
    pub fn fits(&self, state: &TrueState<'_>) -> Result<(), SimulatedBodyError> {
        self.encoders.fits(state)?;
        self.inertial.fits(state)?;
        self.feet.fits(state)
    }

    /// How many joints there are.
    pub const fn joints(&self) -> usize {
        self.encoders.joints()
    }

    /// Reads all of them.
    ///
    /// `lead_rad` is how far each motor leads its joint, None for the joints' own angles; `offsets_rad` what each encoder reads too much.
    pub fn read(
        &mut self,
        state: &TrueState<'_>,
        time_ns: u64,
        lead_rad: Option<&[f64]>,
        offsets_rad: &[f64],
    ) -> Result<BodyReading, SimulatedBodyError> {
        let (joint_positions_rad, joint_velocities_radps) =
            self.encoders.read(state, lead_rad, offsets_rad)?;
        let (angular_velocity_radps, specific_force_mps2) = self.inertial.read(state, time_ns);
        Ok(BodyReading {
            joint_positions_rad,
            joint_velocities_radps,
            angular_velocity_radps,
            specific_force_mps2,
            foot_forces_n: self.feet.read(state),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::tests::arrays;
    use crate::{EncodersTuning, InertialTuning, SensedSole};

    fn senses(quantum_rad: f64, imu_noise: f64) -> BodySenses {
        let sole = |link| SensedSole {
            forces: 0,
            link,
            centre_m: [0.0; 3],
            size_m: [0.1, 0.05],
        };
        BodySenses::new(BodySensesConfig {
            encoders: EncodersConfig {
                positions: vec![7, 8],
                velocities: vec![6, 7],
                quantum_rad,
                followers: vec![],
                seed: 1,
                tuning: EncodersTuning::default(),
            },
            inertial: InertialConfig {
                site: 0,
                link: 1,
                root: 1,
                at_rest_mps2: [0.0, 0.0, 9.81],
                bias: [0.0; 6],
                noise: [imu_noise; 6],
                seed: 2,
                tuning: InertialTuning::default(),
            },
            feet: FootForcesConfig {
                soles: [sole(0), sole(1)],
                noise: 0.02,
                noise_absolute_n: 0.1,
                seed: 3,
            },
        })
        .unwrap()
    }

    #[test]
    fn to_make_one_sense_exact_leaves_the_others_numbers() {
        let made = arrays();
        let read = |mut senses: BodySenses| senses.read(&made.state(), 0, None, &[0.0; 2]).unwrap();
        let (all, exact) = (read(senses(0.001, 0.1)), read(senses(0.0, 0.1)));
        assert_ne!(all.joint_velocities_radps, exact.joint_velocities_radps);
        assert_eq!(all.specific_force_mps2, exact.specific_force_mps2);
        assert_eq!(all.foot_forces_n, exact.foot_forces_n);
        assert_ne!(
            all.specific_force_mps2,
            read(senses(0.001, 0.0)).specific_force_mps2
        );
    }

    #[test]
    fn a_state_of_another_model_is_refused() {
        let mut made = arrays();
        assert_eq!(senses(0.0, 0.0).fits(&made.state()), Ok(()));
        made.cvel.truncate(6);
        assert!(senses(0.0, 0.0).fits(&made.state()).is_err());
    }
}
