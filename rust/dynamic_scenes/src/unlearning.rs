//! How long an occupancy grid takes to unlearn (004, section 36.4): "as many observations as the robot received with the same area being occupied".

use plan_view::{OccupancyConfig, log_odds};

/// How many scans must pass a cell, after so many that ended in it, until it is again less probably occupied than a cell of which nothing is known.
///
/// Each look adds its log odds over the prior's (004, equation 36.4): `a` where the cell is seen occupied, `-b` where it is seen free. After N occupied
/// looks there are `min(N a, c)`, with the limit `c` of `most`, and the first free look that brings the sum below 0 is number `floor(min(N a, c) / b) + 1`.
/// Without a limit that grows with N, by a / b; with one it ends at `floor(c / b) + 1`, however long the cell was occupied.
pub fn free_looks_to_unlearn(config: &OccupancyConfig, occupied_looks: u32) -> u32 {
    let prior = log_odds(config.prior);
    let gained = f64::from(occupied_looks) * (log_odds(config.occupied) - prior);
    let learned = gained.min(log_odds(config.most) - prior);
    (learned / (prior - log_odds(config.free))).floor() as u32 + 1
}
