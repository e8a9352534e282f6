//! Which voxels of a map are solid.

use super::super::octree::{Leaf, Octree};

/// Voxels along a side of a block: 64 voxels are the bits of one number.
pub(super) const BLOCK: usize = 4;
/// The number of a block without solid voxels.
const EMPTY: u32 = u32::MAX;

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
    /// Too much room.
    #[error("a map may span {most} voxels, got {found}", most = SolidVoxels::MOST)]
    TooLarge {
        /// Voxels that the boxes span.
        found: f64,
    },
    /// Too much room for distances.
    #[error("distances are kept in at most {most} voxels, got {found}", most = SolidVoxels::MOST_WITH_DISTANCES)]
    TooLargeForDistances {
        /// Voxels of the box.
        found: usize,
    },
    /// Too much that is solid.
    #[error("a map may have {most} solid voxels, got {found}", most = SolidVoxels::MOST_SOLID)]
    TooFull {
        /// Solid voxels.
        found: f64,
    },
}

/// The box around the solid voxels of a map; what is not solid is free, and so is everything outside. Voxel (i, j, k) of the map's frame
/// fills `i..i+1`, `j..j+1`, `k..k+1` times the resolution, as in OctoMap. Room is taken by blocks of 4 x 4 x 4 voxels, 4 bytes each, and 8
/// more where one holds something.
#[derive(Debug, Clone, PartialEq)]
pub struct SolidVoxels {
    /// Side of a voxel, m.
    pub resolution_m: f64,
    /// Voxel of the map's frame that is the first one here.
    pub(super) first: [i64; 3],
    pub(super) size: [usize; 3],
    /// Blocks along each axis.
    pub(super) blocks: [usize; 3],
    /// For each block the number of its bits; x runs fastest, then y, then z.
    numbers: Vec<u32>,
    /// The solid voxels of the blocks that hold any: bit `x + 4 y + 16 z`.
    bits: Vec<u64>,
}

/// A box from its lowest to its highest corner.
type Corners = [[f64; 3]; 2];

impl SolidVoxels {
    /// Voxels that the box around a map may have at most: a localizer needs half a gigabyte for so many.
    pub const MOST: f64 = 1e9;
    /// Voxels of the box in which distances may be found: each takes twenty bytes meanwhile.
    pub const MOST_WITH_DISTANCES: usize = 1 << 26;
    /// Solid voxels that a map may have at most: what is kept of each is not to take all memory either.
    pub const MOST_SOLID: f64 = (1_u64 << 26) as f64;

    /// The voxels of boxes, each from its lowest to its highest corner, m: leaves of an octree of any size, or blocks of a course. A voxel
    /// is solid where its centre lies in a box.
    pub fn of_boxes(boxes: &[Corners], resolution_m: f64) -> Result<Self, SolidError> {
        if !(resolution_m.is_finite() && resolution_m > 0.0) {
            return Err(SolidError::Resolution {
                found: resolution_m,
            });
        }
        if !(boxes.iter().flatten().flatten()).all(|value| value.is_finite()) {
            return Err(SolidError::Empty);
        }
        Self::of(&boxes.iter().copied(), resolution_m)
    }

    /// The occupied voxels of a tree.
    pub fn occupied(tree: &Octree) -> Result<Self, SolidError> {
        let resolution_m = tree.config.resolution;
        let cube = |leaf: Leaf| {
            let half_m = 0.5 * f64::from(leaf.edge()) * resolution_m;
            let centre_m = tree.centre_m(&leaf);
            [-half_m, half_m].map(|off_m| centre_m.map(|at_m| at_m + off_m))
        };
        let cubes = tree.leaves().filter(Leaf::is_occupied).map(cube);
        Self::of(&cubes, resolution_m)
    }

    fn of(
        boxes: &(impl Iterator<Item = Corners> + Clone),
        resolution_m: f64,
    ) -> Result<Self, SolidError> {
        // The centre of voxel i lies at i + 1/2.
        let voxel = |place_m: f64| (place_m / resolution_m - 0.5).ceil();
        let spans = || {
            (boxes.clone().map(|corners| corners.map(|c| c.map(voxel))))
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
        let volume = |[low, high]: Corners| (0..3).map(|a| high[a] - low[a]).product::<f64>();
        let solid = spans().map(volume).sum::<f64>().min(found);
        if solid > Self::MOST_SOLID {
            return Err(SolidError::TooFull { found: solid });
        }
        let size: [usize; 3] = std::array::from_fn(|a| (high[a] - low[a]) as usize);
        let blocks = size.map(|count| count.div_ceil(BLOCK));
        let mut made = Self {
            resolution_m,
            first: low.map(|value| value as i64),
            size,
            blocks,
            numbers: vec![EMPTY; blocks.iter().product()],
            bits: Vec::new(),
        };
        for [from, to] in spans() {
            let [begin, end] =
                [from, to].map(|at| std::array::from_fn::<_, 3, _>(|a| (at[a] - low[a]) as usize));
            for z in begin[2]..end[2] {
                for y in begin[1]..end[1] {
                    for x in begin[0]..end[0] {
                        made.fill([x, y, z]);
                    }
                }
            }
        }
        made.sort();
        Ok(made)
    }

    /// Numbers the bits in the order of their blocks, in whichever order they were filled.
    fn sort(&mut self) {
        let mut sorted = Vec::with_capacity(self.bits.len());
        for number in self.numbers.iter_mut().filter(|number| **number != EMPTY) {
            sorted.push(self.bits[*number as usize]);
            *number = sorted.len() as u32 - 1;
        }
        self.bits = sorted;
    }

    fn fill(&mut self, voxel: [usize; 3]) {
        let block = self.block(voxel.map(|at| at / BLOCK));
        if self.numbers[block] == EMPTY {
            self.numbers[block] = self.bits.len() as u32;
            self.bits.push(0);
        }
        self.bits[self.numbers[block] as usize] |= 1 << bit(voxel);
    }

    fn block(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.blocks[1] + y) * self.blocks[0] + x
    }

    /// Voxels along x, y and z.
    pub fn size(&self) -> [usize; 3] {
        self.size
    }

    /// Voxels of the box, solid or not.
    pub(super) fn count(&self) -> usize {
        self.size.iter().product()
    }

    /// Lowest corner of a voxel of the grid, m.
    pub fn corner_m(&self, voxel: [usize; 3]) -> [f64; 3] {
        std::array::from_fn(|a| (self.first[a] + voxel[a] as i64) as f64 * self.resolution_m)
    }

    /// Whether a voxel of the grid is solid; free outside.
    pub fn is_solid(&self, voxel: [i64; 3]) -> bool {
        self.number(voxel).is_some()
    }

    /// The solid voxels in the order of their blocks.
    pub fn solid(&self) -> impl Iterator<Item = [usize; 3]> + '_ {
        let [cols, rows, _] = self.blocks;
        let filled = self.numbers.iter().enumerate();
        filled
            .filter(|&(_, &number)| number != EMPTY)
            .flat_map(move |(block, &number)| {
                let corner = [block % cols, block / cols % rows, block / cols / rows];
                let bits = self.bits[number as usize];
                (0..64)
                    .filter(move |at| bits >> at & 1 == 1)
                    .map(move |at| {
                        let inside = [at % BLOCK, at / BLOCK % BLOCK, at / BLOCK / BLOCK];
                        std::array::from_fn(|a| corner[a] * BLOCK + inside[a])
                    })
            })
    }

    /// The bits of a block, 0 where nothing in it is solid.
    #[inline]
    pub(super) fn bits_of(&self, block: [usize; 3]) -> u64 {
        let number = self.numbers[self.block(block)];
        self.bits.get(number as usize).copied().unwrap_or(0)
    }

    /// A solid voxel's block, by its number, and its bit in it.
    #[inline]
    pub(super) fn number(&self, voxel: [i64; 3]) -> Option<(usize, u32)> {
        if !(0..3).all(|a| voxel[a] >= 0 && voxel[a] < self.size[a] as i64) {
            return None;
        }
        let voxel = voxel.map(|at| at as usize);
        let number = self.numbers[self.block(voxel.map(|at| at / BLOCK))] as usize;
        let at = bit(voxel);
        let solid = self.bits.get(number)? >> at & 1 == 1;
        solid.then_some((number, at))
    }

    /// For each block that holds something how many solid voxels are in those before it.
    pub(super) fn counts_before(&self) -> Vec<u32> {
        let mut before = 0;
        let counted = self.bits.iter().map(|bits| {
            let first = before;
            before += bits.count_ones();
            first
        });
        counted.collect()
    }

    /// How many of a block's solid voxels have a lower bit.
    #[inline]
    pub(super) fn before(&self, (number, at): (usize, u32)) -> u32 {
        (self.bits[number] & ((1 << at) - 1)).count_ones()
    }

    /// Whether each block holds something; x runs fastest, then y, then z.
    pub(super) fn filled_blocks(&self) -> Vec<bool> {
        self.numbers.iter().map(|&number| number != EMPTY).collect()
    }

    /// Whether each voxel of the box is solid; x runs fastest, then y, then z.
    pub(super) fn dense(&self) -> Vec<bool> {
        let mut solid = vec![false; self.count()];
        for [x, y, z] in self.solid() {
            solid[(z * self.size[1] + y) * self.size[0] + x] = true;
        }
        solid
    }
}

/// Which voxel of its block a voxel is.
#[inline]
pub(super) const fn bit([x, y, z]: [usize; 3]) -> u32 {
    (x % BLOCK + BLOCK * (y % BLOCK) + BLOCK * BLOCK * (z % BLOCK)) as u32
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
            prop_assert!(voxels.dense().iter().all(|&solid| solid));
            prop_assert_eq!(voxels.solid().count(), voxels.count());
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
