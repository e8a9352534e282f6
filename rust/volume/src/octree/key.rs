//! Voxels by their keys, and where they lie.

/// Levels below the root: as in OctoMap, 2^16 voxels along each axis.
pub(super) const DEPTH: u32 = 16;
/// Voxels along each axis.
pub(super) const SPAN: i32 = 1 << DEPTH;
/// Key of the voxel whose lower corner is the origin of the map frame.
const CENTRE: f64 = 32768.0;

/// A voxel: its place along x, y and z, counted from the lowest corner of all that a tree can hold.
pub type Key = [u16; 3];

/// Which child of a node of a depth leads to a voxel: one bit an axis, x the lowest.
#[inline]
pub(super) fn child_of(key: Key, depth: u32) -> usize {
    let bit = |at: u16| usize::from(at >> (DEPTH - 1 - depth) & 1);
    bit(key[0]) | bit(key[1]) << 1 | bit(key[2]) << 2
}

/// The lowest voxel of a child of a node of a depth whose own lowest voxel is `corner`.
#[inline]
pub(super) fn child_corner(corner: Key, depth: u32, child: usize) -> Key {
    std::array::from_fn(|axis| {
        let bit = (child >> axis & 1) as u16;
        corner[axis] | bit << (DEPTH - 1 - depth)
    })
}

/// Voxels along a side of a node of a depth.
#[inline]
pub(super) const fn edge(depth: u32) -> u32 {
    1 << (DEPTH - depth)
}

/// How many levels from the root on the ways to two voxels share.
#[inline]
pub(super) fn shared_levels(a: Key, b: Key) -> u32 {
    ((a[0] ^ b[0]) | (a[1] ^ b[1]) | (a[2] ^ b[2])).leading_zeros()
}

/// A point of the map frame in voxels from the corner of all.
#[inline]
pub(super) fn in_voxels(point_m: [f64; 3], per_m: f64) -> [f64; 3] {
    let [x_m, y_m, z_m] = point_m;
    [
        x_m * per_m + CENTRE,
        y_m * per_m + CENTRE,
        z_m * per_m + CENTRE,
    ]
}

/// The voxel that holds a point given in voxels; none beyond what a tree can hold.
#[inline]
pub(super) fn key_at(point: [f64; 3]) -> Option<Key> {
    let inside = point.iter().all(|&at| at >= 0.0 && at < f64::from(SPAN));
    inside.then(|| point.map(|at| at as u16))
}

/// The centre of a cube of voxels in the map frame, m.
#[inline]
pub(super) fn centre_m(corner: Key, edge: u32, resolution_m: f64) -> [f64; 3] {
    corner.map(|at| (f64::from(at) + 0.5 * f64::from(edge) - CENTRE) * resolution_m)
}
