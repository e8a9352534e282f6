//! Surfaces: the floor grid and the floor and obstacle grid.

mod config;
mod floor;
mod fog;
mod frame;
mod matching;
mod merging;
mod rough;
mod shadow;
mod stood;
mod tilts;
mod window;

pub use config::FogConfig;
pub(crate) use config::require_usable_side;
pub use floor::FloorGrid;
pub use fog::Fog;
pub(crate) use frame::check_poses;
pub use frame::{LabelledFrame, LabelledPoint, Reading};
pub use matching::{Pair, height_shift};
pub use merging::{INVALID, merge_height};
pub(crate) use stood::Stood;
pub(crate) use window::Window;
