//! A Kalman filter of a place that moves evenly, but for accelerations that are noise.

use nalgebra::{Matrix2, Matrix2x4, Matrix4, Vector2, Vector4};

/// Where something will be: Gaussian.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PredictedPlace {
    /// Mean, m in the map frame.
    pub at_m: [f64; 2],
    /// Covariance, m^2.
    pub covariance_m2: Matrix2<f64>,
}

/// Place and velocity over the ground, m and m/s in the map frame: x, y, their rates.
#[derive(Debug, Clone, PartialEq)]
pub struct TrackFilter {
    time_s: f64,
    state: Vector4<f64>,
    covariance: Matrix4<f64>,
    /// Standard deviation of accelerations that last a second, m/s^2.
    acceleration: f64,
}

impl TrackFilter {
    /// From a place, m, and standard deviations of place, m, and of the velocity, m/s, which is taken for none.
    pub fn new(
        time_s: f64,
        at_m: [f64; 2],
        sigma_m: f64,
        speed_mps: f64,
        acceleration: f64,
    ) -> Self {
        let [place, rate] = [sigma_m * sigma_m, speed_mps * speed_mps];
        Self {
            time_s,
            state: Vector4::new(at_m[0], at_m[1], 0.0, 0.0),
            covariance: Matrix4::from_diagonal(&Vector4::new(place, place, rate, rate)),
            acceleration,
        }
    }

    /// When its state holds, s.
    pub const fn time_s(&self) -> f64 {
        self.time_s
    }

    /// Velocity, m/s, and its covariance.
    pub fn velocity_mps(&self) -> ([f64; 2], Matrix2<f64>) {
        let rate = self.covariance.fixed_view::<2, 2>(2, 2).into_owned();
        ([self.state[2], self.state[3]], rate)
    }

    /// Goes on to a later time.
    pub fn predict(&mut self, time_s: f64) {
        let ahead_s = (time_s - self.time_s).max(0.0);
        let mut carried = Matrix4::identity();
        (carried[(0, 2)], carried[(1, 3)]) = (ahead_s, ahead_s);
        // White acceleration: its integral over the time that passes.
        let density = self.acceleration * self.acceleration;
        let mut noise = Matrix4::zeros();
        for axis in 0..2 {
            noise[(axis, axis)] = density * ahead_s.powi(3) / f64::from(3);
            noise[(axis, axis + 2)] = density * ahead_s * ahead_s / 2.0;
            noise[(axis + 2, axis)] = noise[(axis, axis + 2)];
            noise[(axis + 2, axis + 2)] = density * ahead_s;
        }
        self.state = carried * self.state;
        self.covariance = carried * self.covariance * carried.transpose() + noise;
        self.time_s = time_s.max(self.time_s);
    }

    /// Where it is so long after its own time.
    pub fn predicted(&self, ahead_s: f64) -> PredictedPlace {
        let mut later = self.clone();
        later.predict(self.time_s + ahead_s);
        PredictedPlace {
            at_m: [later.state[0], later.state[1]],
            covariance_m2: later.covariance.fixed_view::<2, 2>(0, 0).into_owned(),
        }
    }

    /// Squared Mahalanobis distance of a place, m, measured with this standard deviation, and the logarithm of the determinant of what it is measured by:
    /// minus twice the log likelihood, but for a constant.
    pub fn distance2(&self, at_m: [f64; 2], sigma_m: f64) -> Option<(f64, f64)> {
        let expected = self.covariance.fixed_view::<2, 2>(0, 0) + variance(sigma_m);
        let off = Vector2::new(at_m[0] - self.state[0], at_m[1] - self.state[1]);
        let inverse = expected.try_inverse()?;
        Some((off.dot(&(inverse * off)), libm::log(expected.determinant())))
    }

    /// Takes in a place, m, measured with this standard deviation, at its own time.
    pub fn update(&mut self, at_m: [f64; 2], sigma_m: f64) {
        let measured = Matrix2x4::<f64>::identity();
        let expected: Matrix2<f64> = self.covariance.fixed_view::<2, 2>(0, 0) + variance(sigma_m);
        let Some(inverse) = expected.try_inverse() else {
            return;
        };
        let gain = self.covariance * measured.transpose() * inverse;
        let off = Vector2::new(at_m[0] - self.state[0], at_m[1] - self.state[1]);
        self.state += gain * off;
        // Joseph's form stays symmetric and positive.
        let kept = Matrix4::identity() - gain * measured;
        self.covariance =
            kept * self.covariance * kept.transpose() + gain * variance(sigma_m) * gain.transpose();
    }
}

fn variance(sigma_m: f64) -> Matrix2<f64> {
    Matrix2::from_diagonal_element(sigma_m * sigma_m)
}
