//! What can be wrong with what a tree is given.

/// The tree is as it was.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum OctreeError {
    /// Where the beams start.
    #[error("the eye must be finite, and no further away than a map can reach")]
    Eye,
    /// Where a beam ends.
    #[error("point {index} must be finite, and no further away than a map can reach")]
    Point {
        /// Which one.
        index: usize,
    },
    /// All of what is given lies where the tree has no voxels.
    #[error(
        "point {index} at {place} m lies beyond the tree: with voxels of {side_m} m it reaches from {low} to {high} m along each axis; move the points, or take larger voxels"
    )]
    Reach {
        /// The first of the points.
        index: usize,
        /// Where it is.
        place: String,
        /// Side of a voxel.
        side_m: String,
        /// The lowest coordinate that a voxel holds.
        low: String,
        /// The end of the highest voxel.
        high: String,
    },
    /// A file that could not be opened or written.
    #[error("{path}: {reason}")]
    Access {
        /// Its path.
        path: String,
        /// Why, as the system says it.
        reason: String,
    },
    /// A file that holds no octree.
    #[error("{path}: byte {at}: {reason}")]
    Format {
        /// Its path, or what the bytes are from.
        path: String,
        /// Where the trouble begins.
        at: usize,
        /// What is wrong there.
        reason: String,
    },
}
