//! Orientation of the inertial measurement unit: the gyroscope integrated, roll and pitch drawn to the accelerometer,
//! the gyroscope's bias learned while the robot stands still.
//!
//! A gyroscope sampled at 100 Hz misses part of each footfall, the same part at every stride: while walking it drifts in
//! roll and pitch as it does not at rest. That drift is a bias of its own, forgotten when the robot stands.
//!
//! The explicit complementary filter of Mahony, Hamel and Pflimlin (2008, IEEE Trans. Automatic Control 53), with a scalar
//! Kalman gain for the bias at rest. The correction never turns about the vertical: yaw is the gyroscope's alone.

use geometry::GRAVITY_MPS2;
use nalgebra::{UnitQuaternion, Vector3};

use crate::config::ProprioceptionConfig;

/// One tick's readings of the inertial measurement unit, in its own frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ImuSample {
    /// Angular velocity, rad/s.
    pub(crate) angular_velocity_radps: Vector3<f64>,
    /// Specific force, m/s^2.
    pub(crate) specific_force_mps2: Vector3<f64>,
    /// Acceleration of the trunk by leg odometry, in the odometry frame, m/s^2: what of the force is not gravity's.
    pub(crate) acceleration_mps2: Vector3<f64>,
}

/// Orientation and bias of the gyroscope.
#[derive(Debug, Clone, Default)]
pub(crate) struct AttitudeFilter {
    /// Orientation of the unit against the odometry frame.
    pub(crate) odometry_from_imu: UnitQuaternion<f64>,
    /// What the gyroscope reads at rest, rad/s.
    pub(crate) bias_radps: Vector3<f64>,
    bias_variance: f64,
    stride_bias_radps: Vector3<f64>,
    slow_rate_radps: Vector3<f64>,
    quiet_s: f64,
    pending: RestMean,
    samples: u32,
}

/// Mean reading since the last lesson. Waits, so that the ticks in which a motion begins are never taken for rest.
#[derive(Debug, Clone, Copy, Default)]
struct RestMean {
    sum_radps: Vector3<f64>,
    count: f64,
    duration_s: f64,
}

impl AttitudeFilter {
    pub(crate) fn new(config: &ProprioceptionConfig) -> Self {
        Self {
            bias_variance: config.gyro_bias * config.gyro_bias,
            ..Self::default()
        }
    }

    /// Turns the odometry frame itself about the vertical, rad.
    pub(crate) fn turn_odometry(&mut self, yaw_rad: f64) {
        self.odometry_from_imu =
            UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw_rad) * self.odometry_from_imu;
    }

    /// Whether the robot has stood still for a while.
    pub(crate) fn is_still(&self, config: &ProprioceptionConfig) -> bool {
        self.quiet_s >= config.still_time
    }

    /// Takes in one sample, `passed_s` after the one before; `both_feet` says that both soles carry the robot.
    pub(crate) fn update(
        &mut self,
        sample: &ImuSample,
        passed_s: f64,
        both_feet: bool,
        config: &ProprioceptionConfig,
    ) {
        self.watch_stillness(sample, passed_s, both_feet, config);
        let still = self.is_still(config);
        if still {
            self.learn_bias(sample, passed_s, config);
        } else {
            self.pending = RestMean::default();
        }
        if self.samples == 0 {
            self.odometry_from_imu =
                UnitQuaternion::rotation_between(&sample.specific_force_mps2, &Vector3::z())
                    .unwrap_or_default();
        }
        self.samples = self.samples.saturating_add(1);
        let bias_radps = self.bias_radps + self.stride_bias_radps;
        let turned = (sample.angular_velocity_radps - bias_radps) * passed_s;
        self.odometry_from_imu *= UnitQuaternion::from_scaled_axis(turned);
        let time_s = if still {
            config.tilt_time_still
        } else {
            config.tilt_time
        };
        let error = self.tilt_error(sample, f64::from(self.samples) * passed_s > time_s, config);
        // A running mean at first, so that the first sample's noise does not stay for the whole time constant.
        let share = (passed_s / time_s)
            .max(1.0 / f64::from(self.samples))
            .min(1.0);
        if still {
            self.stride_bias_radps = Vector3::zeros();
        } else {
            self.stride_bias_radps -= error * (config.stride_bias_gain * passed_s);
        }
        self.odometry_from_imu *= UnitQuaternion::from_scaled_axis(error * share);
        self.odometry_from_imu.renormalize_fast();
    }

    /// Rotation vector, in the unit's frame, that takes the estimated vertical towards the measured one. Linear in the
    /// specific force, so that the accelerations of a stride, which sum to nothing, tilt nothing; within a stride, the trunk's
    /// acceleration by the legs is taken out, which leaves nothing of it but what they get wrong of its speed; not
    /// until the attitude `is_known`, on which the speed depends. A force that is far from gravity's strength is a blow and says
    /// nothing.
    fn tilt_error(
        &self,
        sample: &ImuSample,
        is_known: bool,
        config: &ProprioceptionConfig,
    ) -> Vector3<f64> {
        let force = sample.specific_force_mps2;
        if (force.norm() - GRAVITY_MPS2).abs() > config.gravity_gate {
            return Vector3::zeros();
        }
        let up_estimated = self.odometry_from_imu.inverse() * Vector3::z();
        let acceleration = if is_known {
            self.odometry_from_imu.inverse() * sample.acceleration_mps2
        } else {
            Vector3::zeros()
        };
        ((force - acceleration) / GRAVITY_MPS2).cross(&up_estimated)
    }

    fn watch_stillness(
        &mut self,
        sample: &ImuSample,
        passed_s: f64,
        both_feet: bool,
        config: &ProprioceptionConfig,
    ) {
        let rate = sample.angular_velocity_radps - self.bias_radps;
        self.slow_rate_radps += (rate - self.slow_rate_radps) * config.still_share(passed_s);
        let quiet = both_feet
            && self.slow_rate_radps.amax() < config.still_rate
            && rate.amax() < config.tuning.stillness.outlier * config.still_noise;
        self.quiet_s = if quiet { self.quiet_s + passed_s } else { 0.0 };
    }

    fn learn_bias(&mut self, sample: &ImuSample, passed_s: f64, config: &ProprioceptionConfig) {
        self.pending.sum_radps += sample.angular_velocity_radps;
        self.pending.count += 1.0;
        self.pending.duration_s += passed_s;
        if self.pending.duration_s < config.still_time {
            return;
        }
        let RestMean {
            sum_radps,
            count,
            duration_s,
        } = std::mem::take(&mut self.pending);
        self.bias_variance += config.gyro_bias_drift * config.gyro_bias_drift * duration_s;
        let noise = config.still_noise * config.still_noise / count;
        let gain = self.bias_variance / (self.bias_variance + noise);
        self.bias_radps += (sum_radps / count - self.bias_radps) * gain;
        self.bias_variance *= 1.0 - gain;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TICK_S: f64 = 0.01;

    fn sample(rate: Vector3<f64>, odometry_from_imu: UnitQuaternion<f64>) -> ImuSample {
        ImuSample {
            angular_velocity_radps: rate,
            specific_force_mps2: odometry_from_imu.inverse() * Vector3::z() * GRAVITY_MPS2,
            acceleration_mps2: Vector3::zeros(),
        }
    }

    fn tilt_between(filter: &AttitudeFilter, truth: UnitQuaternion<f64>) -> f64 {
        let estimated = filter.odometry_from_imu.inverse() * Vector3::z();
        estimated.angle(&(truth.inverse() * Vector3::z()))
    }

    proptest! {
        #[test]
        fn roll_and_pitch_converge_to_the_accelerometer(roll in -0.5..0.5f64, pitch in -0.5..0.5f64) {
            let config = ProprioceptionConfig::default();
            let mut filter = AttitudeFilter::new(&config);
            for _ in 0..10 {
                filter.update(&sample(Vector3::zeros(), UnitQuaternion::identity()), TICK_S, false, &config);
            }
            let truth = UnitQuaternion::from_euler_angles(roll, pitch, 0.0);
            for _ in 0..6000 {
                filter.update(&sample(Vector3::zeros(), truth), TICK_S, false, &config);
            }
            prop_assert!(tilt_between(&filter, truth) < 2e-3);
        }

        #[test]
        fn a_turn_about_any_axis_is_followed(x in -1.0..1.0f64, y in -1.0..1.0f64, z in -1.0..1.0f64) {
            let config = ProprioceptionConfig::default();
            let rate = Vector3::new(x, y, z) * 0.5;
            let mut filter = AttitudeFilter::new(&config);
            let mut truth = UnitQuaternion::identity();
            filter.update(&sample(rate, truth), 0.0, false, &config);
            for _ in 0..200 {
                truth *= UnitQuaternion::from_scaled_axis(rate * TICK_S);
                filter.update(&sample(rate, truth), TICK_S, false, &config);
            }
            prop_assert!(filter.odometry_from_imu.angle_to(&truth) < 1e-3);
        }

        #[test]
        fn the_bias_is_learned_at_rest_in_all_axes(x in -0.002..0.002f64, y in -0.002..0.002f64, z in -0.002..0.002f64) {
            let config = ProprioceptionConfig::default();
            let bias = Vector3::new(x, y, z);
            let mut filter = AttitudeFilter::new(&config);
            for _ in 0..300 {
                filter.update(&sample(bias, UnitQuaternion::identity()), TICK_S, true, &config);
            }
            prop_assert!((filter.bias_radps - bias).norm() < 0.15 * bias.norm() + 1e-6);
        }
    }

    #[test]
    fn nothing_is_learned_about_yaw_while_a_foot_is_in_the_air() {
        let config = ProprioceptionConfig::default();
        let mut filter = AttitudeFilter::new(&config);
        let reading = sample(Vector3::new(0.0, 0.0, 0.001), UnitQuaternion::identity());
        for _ in 0..500 {
            filter.update(&reading, TICK_S, false, &config);
        }
        assert_eq!(filter.bias_radps.z, 0.0);
    }

    #[test]
    fn an_acceleration_that_the_legs_feel_does_not_tilt_the_estimate() {
        let config = ProprioceptionConfig::default();
        let mut filter = AttitudeFilter::new(&config);
        let level = sample(Vector3::zeros(), UnitQuaternion::identity());
        for _ in 0..400 {
            filter.update(&level, TICK_S, true, &config);
        }
        let acceleration = Vector3::new(1.5, -0.5, 0.0);
        let stride = ImuSample {
            specific_force_mps2: level.specific_force_mps2 + acceleration,
            acceleration_mps2: acceleration,
            ..level
        };
        for _ in 0..30 {
            filter.update(&stride, TICK_S, false, &config);
        }
        assert!(tilt_between(&filter, UnitQuaternion::identity()) < 1e-9);
    }

    #[test]
    fn a_blow_does_not_tilt_the_estimate() {
        let config = ProprioceptionConfig::default();
        let mut filter = AttitudeFilter::new(&config);
        let level = sample(Vector3::zeros(), UnitQuaternion::identity());
        for _ in 0..100 {
            filter.update(&level, TICK_S, true, &config);
        }
        let blow = ImuSample {
            angular_velocity_radps: Vector3::zeros(),
            specific_force_mps2: Vector3::new(16.0, 0.0, GRAVITY_MPS2),
            acceleration_mps2: Vector3::zeros(),
        };
        for _ in 0..10 {
            filter.update(&blow, TICK_S, true, &config);
        }
        assert!(tilt_between(&filter, UnitQuaternion::identity()) < 1e-9);
    }
}
