//! Surfaces: the floor grid and the floor and obstacle grid.

mod config;
mod floor;
mod fog;
mod frame;
mod matching;
mod merging;
mod overhead;
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
pub use overhead::OverheadTuning;
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
    make: |needs| {
        let config: FogConfig = read(needs.tables, "fog")?;
        Ok(Box::new(Fog::new(config.for_robot(needs.headroom_m))?))
    },
};
