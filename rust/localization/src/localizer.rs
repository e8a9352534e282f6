//! What every localizer does: carry odometry into the map frame, corrected by what it knows.

use geometry::{Map, Odometry, Pose, Robot};
use mapping::FloorView;
use segmentation::Planes;
use sensing::Scan;

use proprioception::BodyState;

/// Why a localizer gave no estimate.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LocalizerError {
    /// A localizer of the user's failed.
    #[error("{0}")]
    Failed(String),
}

/// Where the robot believes to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Nanoseconds since the start.
    pub time_ns: u64,
    /// The robot in the map.
    pub map_from_robot: Pose<Map, Robot>,
    /// The odometry frame in the map: what the localizer corrected so far.
    pub map_from_odometry: Pose<Map, Odometry>,
    /// Whether the localizer does not know where the robot is, so that nobody should act on the estimate.
    pub lost: bool,
}

/// One of the places where the robot may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Guess {
    /// The torso in the map, m.
    pub place_m: [f64; 3],
    /// Heading, rad.
    pub yaw_rad: f64,
    /// How much it counts: those of all sum to one.
    pub weight: f64,
}

/// Keeps the robot's pose in the map.
pub trait Localizer: Send + Sync {
    /// Called with each depth frame before it is segmented, for a localizer that reads the picture itself.
    fn see(&mut self, _scan: &Scan) -> Result<(), LocalizerError> {
        Ok(())
    }

    /// Called when a depth frame was segmented, before the map takes it in; `body` is the body state at the exposure.
    fn correct(
        &mut self,
        body: &BodyState,
        planes: &Planes,
        view: &FloorView,
    ) -> Result<(), LocalizerError>;

    /// The estimate at a control tick, from odometry and the corrections so far.
    fn estimate(&mut self, body: &BodyState) -> Result<Estimate, LocalizerError>;

    /// Whether it knows where the robot is only as long as the legs told the whole way: one that was carried off is lost to it.
    fn needs_unbroken_way(&self) -> bool {
        false
    }

    /// The places that are kept in mind, of a localizer that keeps several. Made anew at each call.
    fn guesses(&self) -> Vec<Guess> {
        Vec::new()
    }
}
