//! What counts as support.

use settings::{SHARE, above_to, settings, within};

settings! {
    /// Where a sole finds support on a height map.
    pub struct FootholdConfig("navigation.footsteps.foothold") {
        /// Ground that lies no further from the plane on which the sole rests bears it, and no other does.
        level: f64 = 0.006, "m", above_to(0.0, 1.0);
        /// Where its height is less sure than that, so many standard deviations count instead.
        sigmas: f64 = 2.0, "1", within(0.0, 10.0);
        /// Least part of the sole, and of its breadth, that bears: the rest may hang over an edge.
        least_bearing: f64 = 0.75, "1", SHARE;
        /// It bears at least so far before and behind its middle.
        middle: f64 = 0.02, "m", within(0.0, 1.0);
        /// Nothing that is higher than what bears stands nearer to the sole: edges are known to a cell.
        higher_margin: f64 = 0.01, "m", within(0.0, 1.0);
        /// Ground so near to a sole belongs to its surroundings: how much of that is closed to the next step counts.
        margin: f64 = 0.04, "m", within(0.0, 1.0);
        /// Steepest ground that a sole stands on.
        most_tilt: f64 = 0.16, "rad", within(0.0, 1.0);
    }
}
