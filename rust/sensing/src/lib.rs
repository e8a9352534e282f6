//! What the robot senses, and nothing else: no pose, no truth.

mod camera;
mod frame_watch;
mod observation;
mod range_noise;
mod range_sensor;
mod scan;
mod scene_watch;
mod self_filter;
mod sense_fault;

pub use camera::Intrinsics;
pub use frame_watch::{FrameWatch, FrameWatchConfig};
pub use observation::{Frame, Observation, ObservationError, TICK_NS, TICK_S};
pub use range_noise::RangeNoise;
pub use range_sensor::{PinholeCamera, RangeSensor};
pub use scan::{Scan, ScanConfig, ScanError, ScanTuning};
pub use scene_watch::{SceneWatch, SceneWatchConfig};
pub use self_filter::{SelfFilter, SelfFilterConfig, SelfFilterTuning};
pub use sense_fault::SenseFault;
