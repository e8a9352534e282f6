//! Settings of the floor and obstacle grid that few will want to turn.

use settings::{NOT_NEGATIVE, above, above_to, settings, within};
use volume::OccupancyGrid;

use super::OverheadTuning;

settings! {
    /// Numbers behind the floor and obstacle grid.
    pub struct FogTuning("navigation.fog.tuning") {
        /// The robot may wander this far from the middle of the window, in cells or layers, before the window follows: a robot that
        /// sways over a border would move it to and fro.
        wander: f64 = 0.75, "1", within(0.5, 100.0);
        /// A point is moved onto the plane that it belongs to unless that makes its ray this many times as long or as short.
        snap_stretch: f64 = 2.0, "1", above(1.0), "000, section III.A, step 2";
        /// A cell is ahead by at most so many points of rough surfaces, or of smooth ones: what is there may be moved.
        rough_lead: u8 = 60, "1", within(1.0, 126.0);
        /// With `clearing = "projected"` a voxel that is likely to be occupied is asked so many lines of sight along columns, and as
        /// many along rows.
        looks: usize = OccupancyGrid::LOOKS, "1", within(1.0, 1000.0);
        /// With `clearing = "projected"` a voxel that is not likely to be occupied is asked so many lines of sight along columns, and as
        /// many along rows, where those nearby reach as deep. 0: only the one next to its middle, which is faster and frees less at the
        /// rims of shadows.
        looks_at_others: usize = OccupancyGrid::LOOKS_AT_OTHERS, "1", within(0.0, 1000.0);
        /// How a frame's height is fitted to the floor that is known.
        matching: MatchingTuning;
        /// How the heights of floors are kept.
        floors: FloorTuning;
        /// How slopes are told from level floors.
        slopes: FloorSlopeTuning;
        /// What is above the floor, up to the robot's head.
        overhead: OverheadTuning;
    }
}

settings! {
    /// How a frame's height is fitted to the floor that is known.
    pub struct MatchingTuning("navigation.fog.tuning.matching") {
        /// The shifts in height within the gate are sorted into so many bins.
        bins: usize = 40, "1", within(1.0, MatchingTuning::MOST_BINS as f64);
        /// The shift that most points agree on is looked for in so many bins beside each other.
        window: usize = 5, "1", within(1.0, MatchingTuning::MOST_BINS as f64);
        /// Points agree on a shift when theirs differs from it by no more than this share of the gate.
        agreement: f64 = 0.25, "1", above_to(0.0, 2.0);
    }
    require (window) <= (bins);
}

impl MatchingTuning {
    /// Room for the bins, which is kept on the stack.
    pub(super) const MOST_BINS: usize = 256;
}

settings! {
    /// How the heights of floors are kept.
    pub struct FloorTuning("navigation.fog.tuning.floors") {
        /// A floor was seen better from a distance that is less than this share of the distance from which it was seen before: a body
        /// sways by less.
        nearer: f32 = 0.9, "1", above_to(0.0, 1.0);
        /// A slope passes from one layer of voxels to the next, so that it may be found occupied this far above or below its height.
        slope_within: f64 = 0.015, "m", NOT_NEGATIVE;
    }
}

settings! {
    /// How slopes are told from level floors.
    pub struct FloorSlopeTuning("navigation.fog.tuning.slopes") {
        /// A frame that shows a cell as part of a slope counts for so many frames that show it level: the camera often makes level
        /// strips of a slope, and hardly ever a slope of a level floor.
        seen: u8 = 4, "1", within(1.0, 100.0);
        /// So many frames that show a cell level are enough to take back any slope.
        most_sure: u8 = 40, "1", within(1.0, 100.0);
        /// Floor that rises by less per metre is level ground seen a little wrong.
        least: f64 = 0.03, "1", NOT_NEGATIVE;
    }
}
