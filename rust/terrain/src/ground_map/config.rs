//! How the ground around the robot is read.

use settings::{above_to, settings, within};

settings! {
    /// The ground around the robot, fine enough for a sole.
    pub struct GroundMapConfig("navigation.footsteps.ground") {
        /// Side of its cells, or as near to it as divides a cell of the map.
        cell: f64 = 0.01, "m", above_to(0.0, 0.1);
        /// It goes so far from the robot.
        reach: f64 = 2.0, "m", above_to(0.0, 10.0);
        /// Standard deviation of the map's heights.
        sigma: f64 = 0.003, "m", within(0.0, 0.1);
        /// Heights that differ by no more are one level, from cell to cell of the map.
        level: f64 = 0.01, "m", above_to(0.0, 0.1);
    }
}
