//! What the robot senses, and nothing else: no pose, no truth.

mod camera;
mod observation;
mod scan;
mod self_filter;

pub use camera::Intrinsics;
pub use observation::{Frame, Observation, ObservationError, TICK_NS, TICK_S};
pub use scan::{Scan, ScanConfig, ScanError, ScanTuning};
pub use self_filter::{SelfFilter, SelfFilterConfig, SelfFilterTuning};
