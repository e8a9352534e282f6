//! Which voxels of a map are solid.

use super::super::octree::{Leaf, Octree};

/// Why boxes make no grid.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum SolidError {
    /// A side of the voxels that cannot be.
    #[error("a voxel's side must be finite and > 0, got {found}")]
    Resolution {
        /// What it was, m.
        found: f64,
    },
    /// A corner that is no number, or none of the boxes fills a voxel.
    #[error("a map must have solid voxels at finite places")]
    Empty,
    /// Too much room for a dense grid.
    #[error("a map may span {most} voxels, got {found}", most = SolidVoxels::MOST)]
    TooLarge {
        /// Voxels that the boxes span.
        found: f64,
    },
}

/// A dense grid of solid voxels; what is not solid is free, and so is everything outside. Voxel (i, j, k) of the map's frame fills
/// `i..i+1`, `j..j+1`, `k..k+1` times the resolution, as in OctoMap.
#[derive(Debug, Clone, PartialEq)]
pub struct SolidVoxels {
    /// Side of a voxel, m.
    pub resolution_m: f64,
    /// Voxel of the map's frame that is the first one here.
    pub(super) first: [i64; 3],
    pub(super) size: [usize; 3],
    /// X runs fastest, then y, then z.
    pub(super) solid: Vec<bool>,
}

impl SolidVoxels {
    /// Voxels that a dense grid may have at most: a range field keeps eight bytes of each, and a stranger's map is not to take all memory.
    pub const MOST: f64 = (1_u64 << 26) as f64;

    /// The voxels of boxes, each from its lowest to its highest corner, m: leaves of an octree of any size, or blocks of a course. A voxel
    /// is solid where its centre lies in a box.
    pub fn of_boxes(boxes: &[[[f64; 3]; 2]], resolution_m: f64) -> Result<Self, SolidError> {
        if !(resolution_m.is_finite() && resolution_m > 0.0) {
            return Err(SolidError::Resolution {
                found: resolution_m,
            });
        }
        if !(boxes.iter().flatten().flatten()).all(|value| value.is_finite()) {
            return Err(SolidError::Empty);
        }
        // The centre of voxel i lies at i + 1/2.
        let voxel = |place_m: f64| (place_m / resolution_m - 0.5).ceil();
        let spans = || {
            (boxes.iter().map(|corners| corners.map(|c| c.map(voxel))))
                .filter(|[low, high]| (0..3).all(|a| low[a] < high[a]))
        };
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for [from, to] in spans() {
            for a in 0..3 {
                low[a] = low[a].min(from[a]);
                high[a] = high[a].max(to[a]);
            }
        }
        if low[0] >= high[0] {
            return Err(SolidError::Empty);
        }
        let found = (0..3).map(|a| high[a] - low[a]).product();
        if found > Self::MOST {
            return Err(SolidError::TooLarge { found });
        }
        let size = std::array::from_fn(|a| (high[a] - low[a]) as usize);
        let mut solid = vec![false; size.iter().product()];
        for [from, to] in spans() {
            let [begin, end] =
                [from, to].map(|at| std::array::from_fn::<_, 3, _>(|a| (at[a] - low[a]) as usize));
            for z in begin[2]..end[2] {
                for y in begin[1]..end[1] {
                    let row = (z * size[1] + y) * size[0];
                    solid[row + begin[0]..row + end[0]].fill(true);
                }
            }
        }
        Ok(Self {
            resolution_m,
            first: low.map(|value| value as i64),
            size,
            solid,
        })
    }

    /// The occupied voxels of a tree.
    pub fn occupied(tree: &Octree) -> Result<Self, SolidError> {
        let resolution_m = tree.config.resolution;
        let cube = |leaf: Leaf| {
            let half_m = 0.5 * f64::from(leaf.edge()) * resolution_m;
            let centre_m = tree.centre_m(&leaf);
            [-half_m, half_m].map(|off_m| centre_m.map(|at_m| at_m + off_m))
        };
        let cubes: Vec<_> = (tree.leaves().filter(Leaf::is_occupied))
            .map(cube)
            .collect();
        Self::of_boxes(&cubes, resolution_m)
    }

    /// Voxels along x, y and z.
    pub fn size(&self) -> [usize; 3] {
        self.size
    }

    /// Lowest corner of a voxel of the grid, m.
    pub fn corner_m(&self, voxel: [usize; 3]) -> [f64; 3] {
        std::array::from_fn(|a| (self.first[a] + voxel[a] as i64) as f64 * self.resolution_m)
    }

    /// Whether a voxel of the grid is solid; free outside.
    pub fn is_solid(&self, voxel: [i64; 3]) -> bool {
        (0..3).all(|a| voxel[a] >= 0 && voxel[a] < self.size[a] as i64)
            && self.solid[self.index(voxel.map(|v| v as usize))]
    }

    pub(super) fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.size[1] + y) * self.size[0] + x
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn corner() -> impl Strategy<Value = [f64; 3]> {
        prop::array::uniform3(-1.0..1.0f64)
    }

    proptest! {
        #[test]
        fn a_voxel_is_solid_where_its_centre_lies_in_a_box(
            corners in prop::collection::vec((corner(), prop::array::uniform3(0.05..0.5f64)), 1..5),
        ) {
            let boxes: Vec<_> = corners.iter().map(|&(low, side)| [low, std::array::from_fn(|a| low[a] + side[a])]).collect();
            let voxels = SolidVoxels::of_boxes(&boxes, 0.04).unwrap();
            let [cols, rows, layers] = voxels.size();
            for (x, y, z) in (0..cols).flat_map(|x| (0..rows).flat_map(move |y| (0..layers).map(move |z| (x, y, z)))) {
                let centre = voxels.corner_m([x, y, z]).map(|low| low + 0.02);
                let inside = boxes.iter().any(|[low, high]| (0..3).all(|a| low[a] <= centre[a] && centre[a] < high[a]));
                prop_assert_eq!(voxels.is_solid([x as i64, y as i64, z as i64]), inside);
            }
        }

        #[test]
        fn leaves_of_an_octree_keep_their_size(first in prop::array::uniform3(-300..300i32), side in 0..5u32) {
            let side = 1 << side;
            let low = first.map(|v| f64::from(v) * 0.04);
            let high = first.map(|v| f64::from(v + side) * 0.04);
            let voxels = SolidVoxels::of_boxes(&[[low, high]], 0.04).unwrap();
            prop_assert_eq!(voxels.size(), [side as usize; 3]);
            prop_assert!(voxels.solid.iter().all(|&solid| solid));
        }
    }

    #[test]
    fn what_makes_no_grid_is_refused() {
        let unit = [[0.0; 3], [1.0; 3]];
        let refused = |boxes: &[[[f64; 3]; 2]], m| SolidVoxels::of_boxes(boxes, m).unwrap_err();
        for resolution_m in [0.0, -0.1, f64::NAN, f64::INFINITY] {
            let error = refused(&[unit], resolution_m);
            assert!(matches!(error, SolidError::Resolution { .. }));
        }
        assert_eq!(refused(&[], 0.04), SolidError::Empty);
        assert_eq!(refused(&[[[0.0; 3], [0.01; 3]]], 0.04), SolidError::Empty);
        assert_eq!(
            refused(&[[[f64::NAN; 3], [1.0; 3]]], 0.04),
            SolidError::Empty
        );
        let far = [[1e6; 3], [1e6 + 1.0; 3]];
        assert!(matches!(
            refused(&[unit, far], 0.04),
            SolidError::TooLarge { .. }
        ));
    }
}
