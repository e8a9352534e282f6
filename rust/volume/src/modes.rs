//! Which voxels a frame changes, and how often: the choices between what the papers write and what is faster.

use serde::{Deserialize, Serialize};

/// How often a frame may change a voxel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Default)]
#[serde(rename_all = "snake_case")]
pub enum Update {
    /// Once; a hit wins over rays that passed. Keeps floors alive that many flat rays skim.
    #[default]
    PerFrame,
    /// By every ray that touches it, as the paper writes.
    PerPoint,
}

/// How it is found which voxels a frame's rays pass, once for all of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Default)]
#[serde(rename_all = "snake_case")]
pub enum Clearing {
    /// Where a voxel is surely passed by one of many rays it is marked at once; rays are followed where that is not sure. The map
    /// is that of `EveryRay` to the last bit.
    #[default]
    Shared,
    /// Each by itself: what the others are compared with.
    EveryRay,
    /// No ray is followed: every voxel in view is looked up in the picture. One whose middle no ray goes by may be left out, but none
    /// is passed that `EveryRay` does not pass, and what is hit is the same. Frames that are no pictures are taken in as by `Shared`.
    Projected,
}
