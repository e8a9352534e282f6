//! Which voxels a frame changes, and how often: the choices between what the papers write and what is faster.

use serde::{Deserialize, Serialize};
use settings::choices;
use settings::schemars::JsonSchema;

/// How often a frame may change a voxel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Default, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(crate = "settings::schemars")]
pub enum Update {
    /// A frame changes a voxel once; a hit wins over rays that passed. Keeps floors alive that many flat rays skim.
    #[default]
    PerFrame,
    /// Every ray that touches a voxel changes it, as the paper writes.
    PerPoint,
}

/// How it is found which voxels a frame's rays pass, once for all of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Default, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(crate = "settings::schemars")]
pub enum Clearing {
    /// A voxel that is surely passed by one of many rays is marked at once; rays are followed where that is not sure. The map
    /// is that of `EveryRay` to the last bit.
    #[default]
    Shared,
    /// Each ray is followed by itself: what the others are compared with.
    EveryRay,
    /// No ray is followed: every voxel in view is looked up in the picture. One that is passed beside the places that are looked at may
    /// be left out, but none is passed that `EveryRay` does not pass, and what is hit is the same. Frames that are no pictures are taken in as by `Shared`.
    Projected,
}

choices!(Update, Clearing);
