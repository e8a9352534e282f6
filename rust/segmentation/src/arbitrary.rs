//! What property tests draw.

use proptest::prelude::*;

use testkit::synthetic::Block;

/// Up to three boxes in front of the robot, on the ground or above it, into each other as they come.
pub(crate) fn blocks() -> impl Strategy<Value = Vec<Block>> {
    let corner = (0.25..1.2f64, -0.6..0.6f64, 0.0..0.3f64);
    let size = (0.05..0.4f64, 0.05..0.4f64, 0.01..0.5f64);
    let block = (corner, size).prop_map(|((x, y, z), (dx, dy, dz))| Block {
        low_m: [x, y, z],
        high_m: [x + dx, y + dy, z + dz],
    });
    prop::collection::vec(block, 0..4)
}
