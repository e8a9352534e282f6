//! Where the voxels of a grid lie, how many they are, and what is seen of them.

use geometry::Lattice;

/// Number of voxels along each axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Size {
    /// Along x.
    pub cols: usize,
    /// Along y.
    pub rows: usize,
    /// Along z, at most 64.
    pub layers: usize,
}

impl Size {
    /// Columns, rows and layers.
    pub(super) fn voxels(self) -> [i32; 3] {
        [self.cols, self.rows, self.layers].map(|n| n as i32)
    }
}

/// Where the voxels lie in the map frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// The cells seen from above.
    pub lattice: Lattice,
    /// Lower bound of layer 0, m.
    pub bottom_m: f64,
    /// Height of a layer, m.
    pub layer_m: f64,
}

impl Placement {
    /// A point of the map frame in voxels.
    pub(super) fn in_voxels(&self, point_m: [f64; 3]) -> [f64; 3] {
        let Lattice { origin_m, cell_m } = self.lattice;
        [
            (point_m[0] - origin_m[0]) / cell_m,
            (point_m[1] - origin_m[1]) / cell_m,
            (point_m[2] - self.bottom_m) / self.layer_m,
        ]
    }
}

/// One line of sight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Its end in the map frame, m.
    pub end_m: [f64; 3],
    /// Whether something was seen at its end; false: it was only seen to be free up to there.
    pub hit: bool,
}
