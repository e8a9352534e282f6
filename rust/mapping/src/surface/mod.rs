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

use crate::part::WorldModelPart;
pub use config::FogConfig;
pub use floor::FloorGrid;
pub use fog::Fog;
pub(crate) use frame::check_poses;
pub use frame::{LabelledFrame, LabelledPoint, Reading};
pub use matching::{Pair, height_shift};
pub use merging::{INVALID, merge_height};
use settings::{Part, TableDescription, read};
pub use tuning::{FloorSlopeTuning, FloorTuning, FogTuning, MatchingTuning};
pub(crate) use underfoot::Underfoot;
pub(crate) use window::Window;

/// How it is listed and made.
pub const PART: WorldModelPart = Part {
    name: "fog",
    about: "floor and obstacle grid over an 8-bit occupancy grid, moves with the robot",
    source: Some("Gutmann, Fukuchi and Fujita 2005 (000)"),
    tables: &[TableDescription::of::<FogConfig>()],
    make: |needs| Ok(Box::new(Fog::new(read(needs.tables, "fog")?)?)),
};
