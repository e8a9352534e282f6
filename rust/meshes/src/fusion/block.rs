//! A block of voxels: signed distances to the nearest surface.

/// Voxels along each side of a block.
pub(super) const EDGE: i32 = 8;
const VOXELS: usize = (EDGE * EDGE * EDGE) as usize;

/// What is known at a voxel's middle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Distance {
    /// To the surface, m: positive before it, negative behind it.
    pub(super) mean_m: f32,
    /// Inverse variance, 1/m²; 0 where nothing is known.
    pub(super) weight: f32,
    /// Frames that saw it, saturating.
    pub(super) frames: u16,
}

impl Distance {
    const UNKNOWN: Self = Self {
        mean_m: f32::NAN,
        weight: 0.0,
        frames: 0,
    };

    /// Takes in a measurement. What is known never counts for more than so many of it, unless it was surer before already; `forgets`: not
    /// even then.
    pub(super) fn fuse(&mut self, measured_m: f32, weight: f32, most: f32, forgets: bool) {
        if self.weight == 0.0 {
            *self = Self {
                mean_m: measured_m,
                weight,
                frames: self.frames.saturating_add(1),
            };
            return;
        }
        let known = if forgets {
            self.weight.min(most * weight)
        } else {
            self.weight
        };
        let sum = known + weight;
        self.mean_m += (measured_m - self.mean_m) * (weight / sum);
        self.weight = if forgets {
            sum
        } else {
            known.max(sum.min(most * weight))
        };
        self.frames = self.frames.saturating_add(1);
    }
}

/// A cube of voxels.
#[derive(Debug, Clone)]
pub(super) struct DistanceBlock {
    pub(super) voxels: Box<[Distance]>,
    /// Seen in this frame near the surface, a bit each.
    fresh: [u64; VOXELS / u64::BITS as usize],
}

impl DistanceBlock {
    pub(super) fn unknown() -> Self {
        Self {
            voxels: vec![Distance::UNKNOWN; VOXELS].into(),
            fresh: [0; _],
        }
    }

    /// Where a voxel is stored, by its place in the block.
    #[inline]
    pub(super) const fn index([x, y, z]: [i32; 3]) -> usize {
        ((z * EDGE + y) * EDGE + x) as usize
    }

    /// The place in the block of the voxel that is stored at an index.
    #[inline]
    pub(super) const fn place(index: usize) -> [i32; 3] {
        let index = index as i32;
        [index % EDGE, index / EDGE % EDGE, index / (EDGE * EDGE)]
    }

    pub(super) const fn begin_frame(&mut self) {
        self.fresh = [0; _];
    }

    #[inline]
    pub(super) const fn mark(&mut self, index: usize) {
        self.fresh[index / 64] |= 1 << (index % 64);
    }

    #[inline]
    pub(super) const fn is_fresh(&self, index: usize) -> bool {
        self.fresh[index / 64] >> (index % 64) & 1 != 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_known_moves_to_what_is_measured_and_forgets_at_once_where_that_is_asked() {
        let mut sure = Distance::UNKNOWN;
        for _ in 0..100 {
            sure.fuse(-0.02, 1e4, 10.0, false);
        }
        assert_eq!((sure.mean_m, sure.weight, sure.frames), (-0.02, 1e5, 100));
        let mut slow = sure;
        slow.fuse(0.04, 1e3, 10.0, false);
        assert!(slow.mean_m < -0.019 && slow.weight == 1e5);
        let mut fast = sure;
        for _ in 0..3 {
            fast.fuse(0.04, 1e3, 2.0, true);
        }
        assert!(fast.mean_m > 0.0);
    }

    #[test]
    fn a_voxel_is_stored_where_its_place_says() {
        for index in 0..VOXELS {
            assert_eq!(DistanceBlock::index(DistanceBlock::place(index)), index);
        }
    }
}
