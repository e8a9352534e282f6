//! Parameters of the occupancy grid, checked once.

use settings::{POSITIVE, at_least, between, settings, within};

settings! {
    /// The occupancy grid of the plane that a sensor sweeps (004, section 36.2.1).
    pub struct OccupancyConfig("navigation.occupancy_2d") {
        /// Side of a cell.
        cell: f64 = 0.04, "m", within(0.001, 10.0), "004, equation 36.6: r";
        /// Probability that a cell is occupied of which nothing is known.
        prior: f64 = 0.5, "1", between(0.0, 1.0), "004, equation 36.6: p_prior";
        /// What a scan that ends in a cell says of it.
        occupied: f64 = 0.7, "1", within(0.0, 1.0), "004, equation 36.6: p_occ";
        /// What a scan that passes a cell says of it.
        free: f64 = 0.4, "1", within(0.0, 1.0), "004, equation 36.6: p_free";
        /// No cell is less probably occupied than this, so that what has come is learned soon.
        least: f64 = 0.02, "1", between(0.0, 1.0);
        /// No cell is more probably occupied than this, so that what is gone is unlearned soon.
        most: f64 = 0.97, "1", between(0.0, 1.0);
        /// Cells that are more probably occupied are obstacles.
        obstacle: f64 = 0.6, "1", between(0.0, 1.0);
        /// Beams see no further than this; of longer ones the part up to here counts, as free.
        max_range: f64 = 50.0, "m" of camera, POSITIVE;
        /// Most cells of a map that grows.
        most_cells: usize = 50_000_000, "1", at_least(16.0);
    }
    require (free) < (prior);
    require (prior) < (occupied);
    require (least) < (prior);
    require (prior) < (most);
    require (prior) <= (obstacle);
    require (obstacle) < (most);
}
