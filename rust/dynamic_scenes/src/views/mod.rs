//! What earlier and later views tell of a point: whether it was seen through, or seen there before.

mod config;
mod memory;
mod view;

pub use config::ViewsConfig;
pub use memory::{PointLooks, ViewMemory};
pub use view::{PictureShape, RangeView};
