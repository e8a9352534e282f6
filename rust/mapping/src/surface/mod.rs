//! Surfaces: the floor grid and the floor and obstacle grid.

mod config;
mod floor;
mod fog;
mod frame;
mod matching;
mod merging;
mod rough;
mod shadow;
mod tilts;
mod tuning;
mod underfoot;
mod window;

pub use config::FogConfig;
pub use floor::FloorGrid;
pub use fog::Fog;
pub(crate) use frame::check_poses;
pub use frame::{LabelledFrame, LabelledPoint, Reading};
pub use matching::{Pair, height_shift};
pub use merging::{INVALID, merge_height};
pub use tuning::{FloorTuning, FogTuning, MatchingTuning, SlopeTuning};
pub(crate) use underfoot::Underfoot;
pub(crate) use window::Window;
