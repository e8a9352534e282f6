//! What earlier and later views tell of a point: whether it was seen through, or seen there before.

mod memory;
mod view;

pub use memory::{PointLooks, ViewMemory, ViewsConfig};
pub use view::{PictureShape, RangeView};
