//! The extended elevation map of Pfaff, Triebel and Burgard 2007 (004, Fig. 36.11c): where there is room for the robot between two things
//! above each other, the height is that of the lower one, so that the way below a bridge is free.

use settings::{Part, TableDescription, Tables, read, require, settings, within};

use super::{Elevation, ElevationConfig};
use crate::part::WorldModelPart;
use settings::{ConfigError, MakeError};

settings! {
    /// What the extended elevation map has beside `[navigation.elevation]`, which it reads, too.
    pub struct ExtendedElevationConfig("navigation.extended_elevation") {
        /// Room between two things above each other with which the lower one counts. Left out: the robot's own height.
        headroom: Option<f64> = None, "m", within(0.01, 100.0), "004, ref. 36.18";
    }
}

impl ExtendedElevationConfig {
    /// The room that counts, m, for a robot of this height.
    pub(crate) fn gap_m(&self, robot_height_m: Option<f64>) -> Result<f64, ConfigError> {
        let gap_m = self.headroom.or(robot_height_m);
        require(
            gap_m.is_some(),
            "navigation.extended_elevation.headroom",
            "given where there is no robot",
            "nothing",
        )?;
        Ok(gap_m.unwrap_or(f64::INFINITY))
    }
}

impl Elevation {
    /// The map for which what begins `headroom_m` or more above a surface is another thing, that does not count.
    pub fn extended(config: ElevationConfig, headroom_m: f64) -> Result<Self, ConfigError> {
        Self::with_gap(config, headroom_m as f32)
    }
}

fn make(tables: &Tables, robot_height_m: Option<f64>) -> Result<Elevation, MakeError> {
    let config: ExtendedElevationConfig = read(tables, "extended_elevation")?;
    settings::Table::check(&config)?;
    let gap_m = config.gap_m(robot_height_m)?;
    Ok(Elevation::extended(read(tables, "elevation")?, gap_m)?)
}

/// How it is listed and made.
pub(crate) const PART: WorldModelPart = Part {
    name: "extended_elevation",
    about: "elevation that keeps the way free below what hangs high enough",
    source: Some("Pfaff, Triebel and Burgard 2007 (004, Fig. 36.11c)"),
    tables: &[
        TableDescription::of::<ElevationConfig>(),
        TableDescription::of::<ExtendedElevationConfig>(),
    ],
    make: |needs| Ok(Box::new(make(needs.tables, needs.headroom_m)?)),
};
