//! One control tick's worth of readings.

use crate::Intrinsics;

/// The control tick, ns: robot and simulation hand over an observation at each.
pub const TICK_NS: u64 = 10_000_000;
/// The control tick, s.
pub const TICK_S: f64 = 0.01;

/// A depth image as the camera delivered it.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// When the picture was taken, nanoseconds since the start.
    pub exposure_ns: u64,
    /// When it reached the core, nanoseconds since the start.
    pub arrival_ns: u64,
    /// Width, pixels.
    pub width: usize,
    /// Height, pixels.
    pub height: usize,
    /// Depth along the optical axis, metres, row by row from the top; NaN where nothing was seen.
    pub depth_m: Vec<f32>,
}

/// Everything that is known at a control tick.
#[derive(Debug, Clone, PartialEq)]
pub struct Observation {
    /// Nanoseconds since the start.
    pub time_ns: u64,
    /// Measured joint angles, rad, joint order.
    pub joint_positions_rad: Vec<f64>,
    /// Measured joint speeds, rad/s, joint order.
    pub joint_velocities_radps: Vec<f64>,
    /// Angular velocity in the frame of the inertial measurement unit, rad/s.
    pub angular_velocity_radps: [f64; 3],
    /// Specific force in the frame of the inertial measurement unit, m/s^2: +g along z at rest and upright.
    pub specific_force_mps2: [f64; 3],
    /// Force on each corner of each sole, N: left and right; front left, front right, rear left, rear right.
    pub foot_forces_n: [[f64; 4]; 2],
    /// The depth image, at the ticks at which one arrives.
    pub depth: Option<Frame>,
}

/// Why an observation is refused. The state of the core is unchanged.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ObservationError {
    /// An array of the wrong length.
    #[error("{field} must have {expected} values, got {found}")]
    WrongLength {
        /// Which array.
        field: &'static str,
        /// The number of joints.
        expected: usize,
        /// The number given.
        found: usize,
    },
    /// A reading that is no number.
    #[error("{field} must be finite, got {found}")]
    NotFinite {
        /// Which reading.
        field: &'static str,
        /// What it was.
        found: f64,
    },
    /// Time that does not advance.
    #[error("time must advance: {now_ns} ns came after {before_ns} ns")]
    TimeWentBack {
        /// Time of the observation before.
        before_ns: u64,
        /// Time of this one.
        now_ns: u64,
    },
    /// A depth image of another size than the camera's.
    #[error(
        "a depth image must be {expected_height} x {expected_width}, got {height} x {width} with {values} values"
    )]
    WrongImage {
        /// The camera's height.
        expected_height: usize,
        /// The camera's width.
        expected_width: usize,
        /// The image's height.
        height: usize,
        /// The image's width.
        width: usize,
        /// The number of depths in it.
        values: usize,
    },
}

impl Observation {
    /// Checks lengths, numbers and time against a robot of `joints` joints, its camera, and the tick before.
    pub fn check(
        &self,
        joints: usize,
        camera: &Intrinsics,
        before_ns: Option<u64>,
    ) -> Result<(), ObservationError> {
        for (field, values) in [
            ("joint_positions", &self.joint_positions_rad),
            ("joint_velocities", &self.joint_velocities_radps),
        ] {
            if values.len() != joints {
                return Err(ObservationError::WrongLength {
                    field,
                    expected: joints,
                    found: values.len(),
                });
            }
        }
        let feet = self.foot_forces_n.as_flattened();
        for (field, values) in [
            ("joint_positions", self.joint_positions_rad.as_slice()),
            ("joint_velocities", self.joint_velocities_radps.as_slice()),
            ("angular_velocity", self.angular_velocity_radps.as_slice()),
            ("specific_force", self.specific_force_mps2.as_slice()),
            ("foot_forces", feet),
        ] {
            if let Some(found) = values.iter().copied().find(|value| !value.is_finite()) {
                return Err(ObservationError::NotFinite { field, found });
            }
        }
        if let Some(before_ns) = before_ns.filter(|&before_ns| self.time_ns <= before_ns) {
            return Err(ObservationError::TimeWentBack {
                before_ns,
                now_ns: self.time_ns,
            });
        }
        match &self.depth {
            Some(frame) => frame.check(camera),
            None => Ok(()),
        }
    }
}

impl Frame {
    fn check(&self, camera: &Intrinsics) -> Result<(), ObservationError> {
        let fits = self.width == camera.width
            && self.height == camera.height
            && self.depth_m.len() == self.width * self.height;
        if fits {
            return Ok(());
        }
        Err(ObservationError::WrongImage {
            expected_height: camera.height,
            expected_width: camera.width,
            height: self.height,
            width: self.width,
            values: self.depth_m.len(),
        })
    }
}
