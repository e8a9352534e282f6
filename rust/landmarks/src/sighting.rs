//! What a sensor says of a landmark, and what it would say: ranges and bearings.

use geometry::{PlanarPose, hypot, wrap_angle};
use nalgebra::{Matrix2, Matrix2x3, Matrix3, Vector2};

use crate::LandmarksConfig;

/// Where something is seen from a robot on a plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RangeBearing {
    /// Distance from the robot's origin, m.
    pub range_m: f64,
    /// Direction, counter-clockwise from straight ahead, rad.
    pub bearing_rad: f64,
}

/// A reading, and of what it is where the sensor can tell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LandmarkReading {
    /// Where it is seen.
    pub at: RangeBearing,
    /// Which landmark it is; none where nobody knows.
    pub name: Option<u32>,
}

/// What a landmark's reading is expected to be, and how it follows from both places: the linearized problem of 004, section 36.2.4.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExpectedReading {
    /// The reading.
    pub reading: RangeBearing,
    /// Change of range (m) and bearing (rad) with the robot's x (m), y (m) and heading (rad).
    pub by_pose: Matrix2x3<f64>,
    /// Change of range (m) and bearing (rad) with the landmark's x and y (m).
    pub by_landmark: Matrix2<f64>,
}

impl RangeBearing {
    /// Where the thing is in the frame that the pose is given in, m.
    pub fn place_m(&self, robot: &PlanarPose) -> Vector2<f64> {
        let (sin, cos) = libm::sincos(robot.yaw_rad + self.bearing_rad);
        Vector2::new(
            robot.x_m + self.range_m * cos,
            robot.y_m + self.range_m * sin,
        )
    }

    /// Change of that place with range and bearing.
    pub(crate) fn place_by_reading(&self, robot: &PlanarPose) -> Matrix2<f64> {
        let (sin, cos) = libm::sincos(robot.yaw_rad + self.bearing_rad);
        Matrix2::new(cos, -self.range_m * sin, sin, self.range_m * cos)
    }

    /// How this reading differs from another: range (m) and bearing (rad, the short way round).
    pub fn minus(&self, other: &Self) -> Vector2<f64> {
        Vector2::new(
            self.range_m - other.range_m,
            wrap_angle(self.bearing_rad - other.bearing_rad),
        )
    }

    /// Whether both are numbers and the range is above 0.
    pub fn is_sound(&self) -> bool {
        self.range_m > 0.0 && self.range_m.is_finite() && self.bearing_rad.is_finite()
    }
}

impl ExpectedReading {
    /// From a robot's pose to a landmark's place, m. None where the two are one: there is no bearing.
    pub fn of(robot: &PlanarPose, at_m: &Vector2<f64>) -> Option<Self> {
        let (x, y) = (at_m.x - robot.x_m, at_m.y - robot.y_m);
        let range_m = hypot(x, y);
        let square = range_m * range_m;
        (square > 0.0).then(|| {
            let (along, across) = (Vector2::new(x, y) / range_m, Vector2::new(-y, x) / square);
            Self {
                reading: RangeBearing {
                    range_m,
                    bearing_rad: wrap_angle(libm::atan2(y, x) - robot.yaw_rad),
                },
                by_pose: Matrix2x3::new(
                    -along.x, -along.y, 0.0, //
                    -across.x, -across.y, -1.0,
                ),
                by_landmark: Matrix2::new(along.x, along.y, across.x, across.y),
            }
        })
    }

    /// Covariance of the reading, of what is not known of pose (m, m, rad) and landmark (m), and the sensor's noise.
    pub fn covariance(
        &self,
        pose: &Matrix3<f64>,
        landmark: &Matrix2<f64>,
        config: &LandmarksConfig,
    ) -> Matrix2<f64> {
        self.by_pose * pose * self.by_pose.transpose()
            + self.by_landmark * landmark * self.by_landmark.transpose()
            + noise(config)
    }
}

/// Covariance of the sensor's own errors: range (m²) and bearing (rad²).
pub(crate) fn noise(config: &LandmarksConfig) -> Matrix2<f64> {
    let variances = [config.range_noise, config.bearing_noise].map(|sd| sd * sd);
    Matrix2::from_diagonal(&Vector2::from(variances))
}

/// Whether a place, m, is where the sensor would see a landmark.
pub(crate) fn in_view(robot: &PlanarPose, at_m: &Vector2<f64>, config: &LandmarksConfig) -> bool {
    ExpectedReading::of(robot, at_m).is_some_and(|expected| {
        let [near_m, far_m] = config.reach;
        let seen = expected.reading;
        (near_m..=far_m).contains(&seen.range_m) && seen.bearing_rad.abs() <= config.view
    })
}
