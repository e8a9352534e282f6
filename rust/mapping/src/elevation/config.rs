//! Parameters of the elevation grid, checked once.

use serde::{Deserialize, Serialize};
use settings::schemars::JsonSchema;
use settings::{NOT_NEGATIVE, POSITIVE, above_to, at_least, choices, settings, within};

use super::RangeNoise;
use super::edges::EdgeRule;
use super::rise::RiseRule;
use super::slope::{MOST_REACH, SlopeRule};
use crate::{FogConfig, surface::MatchingTuning};

/// How large the cells are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Default, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(crate = "settings::schemars")]
pub enum CellSizes {
    /// All alike, fixed to the map.
    #[default]
    Fixed,
    /// Small near the robot and larger further away, as the sensor's points lie on level ground; they move with the robot and are
    /// sampled anew whenever it does (004, Fig. 36.9).
    ByRange,
}

choices!(CellSizes);

settings! {
    /// The elevation grid of the handbook (004, section 36.3.1): a height a cell, kept by a Kalman filter. A key that
    /// `[navigation.averaging]` has as well means the same there and has the same default.
    pub struct ElevationConfig("navigation.elevation") {
        /// Side of a cell; with `cells = "by_range"` of one a metre away, and of what is shown of them.
        cell: f64 = 0.04, "m", within(0.001, 10.0);
        /// Cells along each side of the window.
        window: usize = 100, "1", within(4.0, FogConfig::MOST_CELLS as f64);
        /// How large the cells are.
        cells: CellSizes = CellSizes::Fixed, "-", settings::ANY, "004, Fig. 36.9";
        /// Grids of cells that are twice as large each: where the finer one has gaps since the sensor's points lie too far apart, the next
        /// one is asked. 1: the finest alone.
        pyramid: usize = 1, "1", within(1.0, 6.0), "004, section 36.3.1 (Montemerlo and Thrun 2004)";
        /// Standard deviation of a height that is measured at the sensor.
        sigma: f64 = 0.004, "m", POSITIVE, "004, Fig. 36.10";
        /// How much it grows with each metre of range.
        sigma_per_metre: f64 = 0.01, "1", NOT_NEGATIVE, "004, Fig. 36.10";
        /// A height further from the cell's than so many standard deviations of both is that of another surface.
        gate: f64 = 3.0, "1", POSITIVE;
        /// A cell that lies more than this above one beside it, and further than the `gate` allows for their noise, is an obstacle; what is
        /// lower can be climbed.
        rise: f64 = 0.05, "m", POSITIVE, "003, Table I: steps up to 50 mm";
        /// Points that are further away than this are left out.
        max_range: f64 = 4.0, "m" of camera, POSITIVE;
        /// Whether a height is taken back that sight lines pass below.
        clearing: bool = true, "-", settings::ANY, "004, section 36.3.1: visibility constraints";
        /// Gaps up to this wide between heights of one surface are filled, but for what is hidden from the sensor. 0: none are.
        fill: f64 = 0.08, "m", NOT_NEGATIVE, "004, section 36.3.1";
        /// Frames are shifted in height to fit the known heights by at most this.
        match_gate: f64 = 0.02, "m", NOT_NEGATIVE;
        /// Points that must fit the known heights before a frame is shifted, or used without a ground plane.
        min_pairs: usize = 150, "1", at_least(1.0);
        /// Unseen cells up to this far from the robot's middle are shown as floor at its height, since it stands there.
        footprint: f64 = 0.12, "m", NOT_NEGATIVE;
        /// Numbers that few will want to turn.
        tuning: ElevationTuning;
    }
}

settings! {
    /// Numbers behind the elevation grid.
    pub struct ElevationTuning("navigation.elevation.tuning") {
        /// The robot may wander this many cells from the middle of the window before the window follows.
        wander: f64 = 0.75, "1", within(0.5, 100.0);
        /// With `cells = "by_range"`, how far from the robot's middle cells begin.
        nearest: f64 = 0.1, "m", within(0.01, 10.0);
        /// Frames in a row that must contradict a height before it is given up for a lower one, or for none.
        patience: u8 = 3, "1", at_least(1.0);
        /// Of a cell's points in a frame, the share that lies on the highest surface in it at least, and two of them: fewer are mismatches.
        surface_share: f64 = 0.05, "1", above_to(0.0, 1.0);
        /// Surfaces that lie less than this apart are one: a cell between two that lie further apart has the height of the upper one.
        edge: f64 = 0.012, "m", NOT_NEGATIVE;
        /// Of the height between two surfaces, the share by which each may be uneven from cell to cell.
        uneven: f64 = 0.15, "1", within(0.0, 0.5);
        /// How slopes are told from steps.
        slopes: EvenSlopeTuning;
        /// Points in the area of a coarse cell, a finer cell in it, with which the finer ones are dense enough.
        dense: f64 = 2.0, "1", POSITIVE;
        /// How a frame's height is fitted to the heights that are known.
        matching: MatchingTuning;
    }
}

settings! {
    /// How slopes are told from steps.
    pub struct EvenSlopeTuning("navigation.elevation.tuning.slopes") {
        /// How far to each side the ground must rise evenly to be a slope.
        reach: f64 = 0.12, "m", within(0.001, 100.0);
        /// Of the mean difference from cell to cell, the share by which each may differ from it.
        uneven: f64 = 0.6, "1", NOT_NEGATIVE;
        /// What each may differ by in any case.
        noise: f64 = 0.001, "m", NOT_NEGATIVE;
        /// Heights that are known less well do not tell.
        sure: f64 = 0.01, "m", POSITIVE;
        /// Ground that rises by less per metre is level.
        least: f64 = 0.04, "1", NOT_NEGATIVE;
    }
}

impl ElevationConfig {
    /// When ground counts as a slope.
    pub(crate) fn slope_rule(&self) -> SlopeRule {
        let slopes = &self.tuning.slopes;
        let cells = (slopes.reach / self.cell + 0.5) as usize;
        SlopeRule {
            reach: cells.clamp(1, MOST_REACH) as i32,
            uneven: slopes.uneven as f32,
            noise_m: slopes.noise as f32,
            least: slopes.least as f32,
        }
    }

    /// How a cell between two surfaces is told.
    pub(crate) const fn edge_rule(&self) -> EdgeRule {
        EdgeRule {
            least_m: self.tuning.edge as f32,
            uneven: self.tuning.uneven as f32,
            reach: 3,
        }
    }

    /// What is an obstacle beside what.
    pub(crate) const fn rise_rule(&self) -> RiseRule {
        RiseRule {
            most_m: self.rise as f32,
            gate: self.gate as f32,
        }
    }

    /// How sure a measured height is.
    pub fn noise(&self) -> RangeNoise {
        RangeNoise {
            sigma_m: self.sigma as f32,
            per_metre: self.sigma_per_metre as f32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::AveragingConfig;
    use settings::Table;

    #[test]
    fn the_defaults_are_allowed_and_a_bad_value_is_refused_by_its_key() {
        let base = ElevationConfig::default;
        assert_eq!(base().check(), Ok(()));
        let refused = |config: ElevationConfig| config.check().unwrap_err().to_string();
        let bad = ElevationConfig {
            sigma: 0.0,
            ..base()
        };
        assert!(refused(bad).starts_with("navigation.elevation.sigma must be"));
        let bad = ElevationConfig {
            pyramid: 0,
            ..base()
        };
        assert!(refused(bad).starts_with("navigation.elevation.pyramid must be"));
    }

    #[test]
    fn what_averaging_has_as_well_is_the_same_by_default() {
        let (ours, theirs) = (ElevationConfig::parameters(), AveragingConfig::parameters());
        let mut shared = 0;
        for one in &theirs {
            let key = one.key.replacen("averaging", "elevation", 1);
            let same = ours.iter().find(|other| other.key == key);
            if let Some(other) = same.filter(|_| key != "navigation.elevation.cells") {
                assert_eq!(
                    (&one.default, &one.bounds),
                    (&other.default, &other.bounds),
                    "{key}"
                );
                shared += 1;
            }
        }
        assert!(shared >= 6, "{shared}");
    }
}
