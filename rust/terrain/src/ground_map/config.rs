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
        /// Obstacles, and floor of one level, of no more cells than this, with no other within two cells, are false matches of the camera.
        specks: usize = 2, "1", within(0.0, 100.0);
        /// What was not seen is missing in the midst of a level where so many of the cells around it are floor of one level.
        surrounded: usize = 5, "1", within(1.0, 8.0);
        /// Beside an edge, cells up to so far away that are as high as no edge explains tell that not all edges are known.
        unexplained_cells: f64 = 1.5, "1", within(0.0, 10.0);
        /// An edge explains the height of cells whose middle is no more than so many cells away: the map and the edges were seen from many places.
        explained_cells: f64 = 1.0, "1", within(0.0, 10.0);
        /// An edge matters to cells of the map whose middle is no more than so many cells away: one that it runs through, and those beside it.
        edge_cells: f64 = 2.0, "1", within(0.0, 10.0);
        /// Beside an edge the map's heights may be off by so much: what is no further from a stair's height is as high as that.
        blended: f64 = 0.012, "m", within(0.0, 0.1);
    }
}
