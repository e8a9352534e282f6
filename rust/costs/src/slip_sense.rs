//! How much the feet slip, told from joints and inertial unit alone: statistics of a second of walking, weighted by ridge regression.

use nalgebra::{DMatrix, DVector};
use settings::{ConfigError, POSITIVE, Table, settings};

settings! {
    /// How a robot learns to sense that it slips.
    pub struct SlipSenseConfig("costs.slip_sense") {
        /// Price of the squares of the weights, for each example.
        ridge: f64 = 0.01, "1", POSITIVE, "Hoerl and Kennard 1970, equation (2.1)";
    }
}

/// Joints of a leg.
const JOINTS: usize = 6;
/// Axes of the inertial unit.
const AXES: usize = 3;
/// Number of statistics: spread of turn rates, of forces and of their changes; of each pair of joints mean speed, spread of speed and angle.
pub const GAIT_STATISTICS: usize = 3 * AXES + 3 * JOINTS;

/// What a robot feels in a tick of walking.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GaitSample {
    /// Of the inertial unit, rad/s.
    pub angular_velocity_rps: [f64; AXES],
    /// Of the inertial unit, m/s².
    pub specific_force_mps2: [f64; AXES],
    /// Of the left leg's joints from the hip down, and of the right one's, rad/s.
    pub leg_velocities_rps: [[f64; JOINTS]; 2],
    /// Their angles, rad.
    pub leg_positions_rad: [[f64; JOINTS]; 2],
}

/// What a slip sense cannot be learned from.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SlipSenseError {
    /// Settings that cannot be used.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// Too few ticks or examples.
    #[error("{found} {what}, at least {least} are needed")]
    TooFew {
        /// Of what.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many are needed.
        least: usize,
    },
    /// A measurement that is no number.
    #[error("{what} {index} is not finite")]
    NotFinite {
        /// Of what.
        what: &'static str,
        /// Which.
        index: usize,
    },
}

/// Statistics of some ticks of walking, a second or more: what changes in a gait when soles slip.
pub fn gait_statistics(samples: &[GaitSample]) -> Result<[f64; GAIT_STATISTICS], SlipSenseError> {
    if samples.len() < AXES {
        return Err(SlipSenseError::TooFew {
            what: "ticks",
            found: samples.len(),
            least: AXES,
        });
    }
    let axis =
        |of: fn(&GaitSample) -> [f64; AXES], at: usize| samples.iter().map(move |one| of(one)[at]);
    let joint = |of: fn(&GaitSample) -> [[f64; JOINTS]; 2], leg: usize, at: usize| {
        samples.iter().map(move |one| of(one)[leg][at])
    };
    let turn = |at| spread(axis(|one| one.angular_velocity_rps, at));
    let force = |at| spread(axis(|one| one.specific_force_mps2, at));
    let jolt = |at| {
        let later = axis(|one| one.specific_force_mps2, at).skip(1);
        spread(
            later
                .zip(axis(|one| one.specific_force_mps2, at))
                .map(|(b, a)| b - a),
        )
    };
    let legs = |of: &dyn Fn(usize) -> f64| of(0) + of(1);
    let speed = |at| legs(&|leg| mean(joint(|one| one.leg_velocities_rps, leg, at).map(f64::abs)));
    let speeds = |at| legs(&|leg| spread(joint(|one| one.leg_velocities_rps, leg, at)));
    let angles = |at| legs(&|leg| spread(joint(|one| one.leg_positions_rad, leg, at)));
    let all = (0..AXES).map(turn);
    let all = all.chain((0..AXES).map(force)).chain((0..AXES).map(jolt));
    let all = all
        .chain((0..JOINTS).map(speed))
        .chain((0..JOINTS).map(speeds));
    let mut statistics = [0.0; GAIT_STATISTICS];
    for (one, value) in statistics
        .iter_mut()
        .zip(all.chain((0..JOINTS).map(angles)))
    {
        *one = value;
    }
    let wrong = statistics.iter().position(|one| !one.is_finite());
    wrong.map_or(Ok(statistics), |index| {
        Err(SlipSenseError::NotFinite {
            what: "statistic",
            index,
        })
    })
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), one| (sum + one, count + 1.0));
    sum / count
}

/// Standard deviation.
fn spread(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let mean_of = mean(values.clone());
    mean(values.map(|one| (one - mean_of) * (one - mean_of))).sqrt()
}

/// Tells how fast loaded soles slip by the statistics of the gait (004, section 36.3.4, after reference 36.33). A robot's own: it is learned
/// where the slip is known, in simulation, and used where it is not.
#[derive(Debug, Clone)]
pub struct SlipSense {
    /// Mean of each statistic, and one over its standard deviation.
    scales: Vec<[f64; 2]>,
    weights: DVector<f64>,
    mean_mps: f64,
}

impl SlipSense {
    /// Learns from examples: statistics, and the mean speed of loaded soles, m/s.
    pub fn learn(
        config: &SlipSenseConfig,
        examples: &[([f64; GAIT_STATISTICS], f64)],
    ) -> Result<Self, SlipSenseError> {
        config.check()?;
        let count = examples.len();
        if count < 2 {
            return Err(SlipSenseError::TooFew {
                what: "examples",
                found: count,
                least: 2,
            });
        }
        let is_finite = |(of, slip): &([f64; GAIT_STATISTICS], f64)| {
            slip.is_finite() && of.iter().all(|one| one.is_finite())
        };
        if let Some(index) = examples.iter().position(|example| !is_finite(example)) {
            return Err(SlipSenseError::NotFinite {
                what: "example",
                index,
            });
        }
        let scale = |at: usize| {
            let values = examples.iter().map(|(of, _)| of[at]);
            let sigma = spread(values.clone());
            [mean(values), if sigma > 0.0 { 1.0 / sigma } else { 0.0 }]
        };
        let scales: Vec<_> = (0..GAIT_STATISTICS).map(scale).collect();
        let mean_mps = mean(examples.iter().map(|(_, slip)| *slip));
        let mut products = DMatrix::identity(GAIT_STATISTICS, GAIT_STATISTICS);
        products *= config.ridge * count as f64;
        let mut moments = DVector::zeros(GAIT_STATISTICS);
        for (of, slip) in examples {
            let of = scaled(&scales, of);
            products.ger(1.0, &of, &of, 1.0);
            moments.axpy(slip - mean_mps, &of, 1.0);
        }
        let weights = (products.cholesky()).map_or_else(
            || DVector::zeros(GAIT_STATISTICS),
            |products| products.solve(&moments),
        );
        Ok(Self {
            scales,
            weights,
            mean_mps,
        })
    }

    /// How fast loaded soles slip where these are the statistics, m/s.
    pub fn slip_mps(&self, statistics: &[f64; GAIT_STATISTICS]) -> f64 {
        let told = self.mean_mps + self.weights.dot(&scaled(&self.scales, statistics));
        told.max(0.0)
    }
}

fn scaled(scales: &[[f64; 2]], statistics: &[f64; GAIT_STATISTICS]) -> DVector<f64> {
    let all = scales.iter().zip(statistics);
    let all = all.map(|([mean, scale], value)| (value - mean) * scale);
    DVector::from_iterator(GAIT_STATISTICS, all)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::local_regression::{LocalRegression, LocalRegressionConfig};
    use crate::motion::{MotionConfig, MotionCost, SpeedOnCurve};
    use crate::shape::GroundShape;
    use crate::traversability::tests::limits;
    use geometry::{GRAVITY_MPS2, SplitMix64};

    fn around(random: &mut SplitMix64, middle: f64, half: f64) -> f64 {
        middle + half * (2.0 * random.uniform() - 1.0)
    }

    /// Half of the patches are slippery.
    fn friction(random: &mut SplitMix64) -> f64 {
        if random.uniform() < 0.5 {
            around(random, 0.1, 0.05)
        } else {
            around(random, 0.6, 0.3)
        }
    }

    /// How fast a sole slides in the mean of a step whose push-off asks for more friction than there is: what is missing accelerates it.
    fn simulated_slip_mps(friction: f64, speed_mps: f64, slope: f64) -> f64 {
        let motion = MotionCost::new(MotionConfig::default(), limits()).unwrap();
        let shape = GroundShape {
            slope,
            ..GroundShape::LEVEL
        };
        let going = SpeedOnCurve {
            speed_mps,
            curvature_per_m: 0.0,
        };
        let asked = motion.friction_asked(&shape, &going);
        let pushes_s = 0.25 * limits().step_time_s;
        0.5 * GRAVITY_MPS2 * (asked - friction).max(0.0) * pushes_s
    }

    /// Of walks over patches: shade, slope, and slip as a robot of that speed has it, m/s.
    fn walks(seed: u64, count: usize, speed_mps: f64) -> Vec<([f64; 2], f64)> {
        let mut random = SplitMix64::new(seed);
        (0..count)
            .map(|_| {
                let [friction, slope] = [friction(&mut random), 0.1 * random.uniform()];
                let shade = 0.1 + 0.9 * friction + around(&mut random, 0.0, 0.02);
                let slip = simulated_slip_mps(friction, speed_mps, slope);
                ([shade.clamp(0.0, 1.0), slope], slip)
            })
            .collect()
    }

    #[test]
    fn slip_told_from_shade_and_slope_is_off_by_half_of_a_constant_at_most_for_another_robot() {
        for seed in 0..20 {
            let [train, test] = [walks(seed, 60, 0.14), walks(seed + 1000, 60, 0.12)];
            let usual = mean(train.iter().map(|(_, slip)| *slip));
            let config = LocalRegressionConfig {
                noise: 0.02,
                ..LocalRegressionConfig::default()
            };
            let mut learned = LocalRegression::new(config, 2, usual).unwrap();
            for (inputs, slip) in &train {
                learned.learn(inputs, *slip).unwrap();
            }
            let rmse = |told: &dyn Fn(&[f64; 2]) -> f64| {
                let squares = test
                    .iter()
                    .map(|(inputs, slip)| (told(inputs) - slip).powi(2));
                mean(squares).sqrt()
            };
            let own = rmse(&|inputs| learned.predict(inputs).unwrap().value);
            let constant = rmse(&|_| usual);
            assert!(
                own <= 0.5 * constant,
                "seed {seed}: {own:.4} of {constant:.4}"
            );
        }
    }

    /// A gait of half a hertz whose swings of an ankle, and of the turn rate, grow with slip.
    fn gait(random: &mut SplitMix64, slip_mps: f64) -> Vec<GaitSample> {
        let phase = |tick: i32| f64::from(tick) * core::f64::consts::TAU / 100.0;
        (0..100)
            .map(|tick| {
                let wave = libm::sin(phase(tick));
                let mut noise = || around(random, 0.0, 0.02);
                let ankle = (0.2 + 3.0 * slip_mps) * wave + noise();
                GaitSample {
                    angular_velocity_rps: [noise(), noise(), 5.0 * slip_mps * wave + noise()],
                    specific_force_mps2: [noise(), noise(), GRAVITY_MPS2 + noise()],
                    leg_velocities_rps: [[noise(), noise(), noise(), noise(), ankle, noise()]; 2],
                    leg_positions_rad: [[noise(); JOINTS]; 2],
                }
            })
            .collect()
    }

    #[test]
    fn slip_is_told_from_the_statistics_of_a_gait_that_it_changes() {
        let mut random = SplitMix64::new(8);
        let mut walks = |count: usize| {
            let walk = |_| {
                let slip_mps = 0.05 * random.uniform();
                let samples = gait(&mut random, slip_mps);
                (gait_statistics(&samples).unwrap(), slip_mps)
            };
            (0..count).map(walk).collect::<Vec<_>>()
        };
        let sense = SlipSense::learn(&SlipSenseConfig::default(), &walks(80)).unwrap();
        let squares: Vec<f64> = walks(40)
            .iter()
            .map(|(of, slip)| (sense.slip_mps(of) - slip).powi(2))
            .collect();
        let rmse = (squares.iter().sum::<f64>() / 40.0).sqrt();
        assert!(rmse < 0.2 * 0.05 / 12_f64.sqrt(), "{rmse}");
    }

    #[test]
    fn bad_examples_are_refused_by_name() {
        let error = SlipSense::learn(&SlipSenseConfig::default(), &[]).unwrap_err();
        assert_eq!(error.to_string(), "0 examples, at least 2 are needed");
        let bad = [
            ([0.0; GAIT_STATISTICS], 0.0),
            ([0.0; GAIT_STATISTICS], f64::NAN),
        ];
        let error = SlipSense::learn(&SlipSenseConfig::default(), &bad).unwrap_err();
        assert_eq!(error.to_string(), "example 1 is not finite");
        let error = gait_statistics(&[]).unwrap_err();
        assert_eq!(error.to_string(), "0 ticks, at least 3 are needed");
    }
}
