//! Parameters of the slice of a depth image that is taken for a laser's scan, checked once.

use settings::{NOT_NEGATIVE, POSITIVE, above_to, at_least, settings, within};

use crate::FogConfig;

settings! {
    /// How depth images become scans of a laser for `[navigation.occupancy_2d]`: what stands between floor and head is an obstacle.
    pub struct DepthSliceConfig("navigation.depth_slice") {
        /// Cells along each side of the window.
        window: usize = 100, "1", within(4.0, FogConfig::MOST_CELLS as f64);
        /// Surfaces that lie this far above or below the robot's ground are obstacles: a plane has no steps.
        low: f64 = 0.02, "m", POSITIVE;
        /// Points of which no surface is known are less sure: they are obstacles from this height or depth on.
        stray: f64 = 0.05, "m", POSITIVE;
        /// What hangs higher above the robot's ground is passed below. Left out: the robot's own height.
        high: Option<f64> = None, "m", within(0.01, 100.0);
        /// Angle between the beams of the scan that is made.
        beam: f64 = 0.0175, "rad", within(0.001, 0.5);
        /// Points further away than this are left out.
        max_range: f64 = 4.0, "m" of camera, POSITIVE;
        /// Points in a cell of which a frame needs so many to hold it for occupied; fewer are mismatches.
        least_points: usize = 2, "1", at_least(1.0);
        /// Floor that is seen in a beam is free between two of its points that lie no further apart than this, the nearest and farthest among them.
        gap: f64 = 0.25, "m", POSITIVE;
        /// Unseen cells up to this far from the robot's middle are shown as floor, since it stands there.
        footprint: f64 = 0.12, "m", NOT_NEGATIVE;
        /// The robot may wander this many cells from the middle of the window before the window follows.
        wander: f64 = 0.75, "1", within(0.5, 100.0);
        /// A cell is floor that is less probably occupied than this.
        floor: f64 = 0.45, "1", above_to(0.0, 1.0);
    }
    require (low) <= (stray);
}
