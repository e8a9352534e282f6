//! The lowest two levels: 4 x 4 x 4 voxels side by side, with a mask of one bit a voxel for what is asked most.

use super::config::Beam;

/// Voxels along a side.
pub(super) const EDGE: usize = 4;
const VOXELS: usize = EDGE * EDGE * EDGE;

/// Log-odds of its voxels. Voxels above each other are neighbours.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Brick {
    /// 0 where nothing is known.
    values: [f32; VOXELS],
    /// Voxels of which something is known, one bit each.
    pub(super) known: u64,
    /// The voxels that are rather occupied than not.
    pub(super) occupied: u64,
    /// As free as can be: a miss changes nothing.
    settled: u64,
}

/// Which bit and value a voxel has, by its place in the brick.
#[inline]
pub(super) const fn index(x: usize, y: usize, z: usize) -> usize {
    (y * EDGE + x) * EDGE + z
}

/// A cube of voxels of the brick, one bit each.
pub(super) fn cube([x, y, z]: [usize; 3], edge: usize) -> u64 {
    let mut mask = 0;
    for row in y..y + edge {
        for col in x..x + edge {
            mask |= ((1_u64 << edge) - 1) << index(col, row, z);
        }
    }
    mask
}

impl Brick {
    /// A brick of which nothing is known.
    pub(super) const fn unknown() -> Self {
        Self {
            values: [0.0; VOXELS],
            known: 0,
            occupied: 0,
            settled: 0,
        }
    }

    /// Gives some of its voxels a value.
    pub(super) fn fill(&mut self, voxels: u64, value: f32, beam: &Beam) {
        for (at, slot) in self.values.iter_mut().enumerate() {
            if voxels >> at & 1 == 1 {
                *slot = value;
            }
        }
        let mark = |mask: u64, holds: bool| if holds { mask | voxels } else { mask & !voxels };
        self.known |= voxels;
        self.occupied = mark(self.occupied, value >= 0.0);
        self.settled = mark(self.settled, value <= beam.lowest);
    }

    /// Equation (1) for the voxels that beams ended in and for those that they passed.
    pub(super) fn update(&mut self, hits: u64, misses: u64, beam: &Beam) {
        let (mut occupied, mut settled) = (0_u64, 0_u64);
        for (group, values) in self.values.chunks_exact_mut(EDGE).enumerate() {
            let at = group * EDGE;
            if ((hits | misses) >> at).trailing_zeros() >= EDGE as u32 {
                occupied |= self.occupied & 0xf << at;
                settled |= self.settled & 0xf << at;
                continue;
            }
            for (z, value) in values.iter_mut().enumerate() {
                let bit = at + z;
                if misses >> bit & 1 == 1 {
                    *value = beam.after_miss(*value);
                }
                if hits >> bit & 1 == 1 {
                    *value = beam.after_hit(*value);
                }
                occupied |= u64::from(*value >= 0.0) << bit;
                settled |= u64::from(*value <= beam.lowest) << bit;
            }
        }
        self.known |= hits | misses;
        self.occupied = occupied & self.known;
        self.settled = settled & self.known;
    }

    /// What is known of a voxel.
    #[inline]
    pub(super) fn value(&self, index: usize) -> Option<f32> {
        (self.known >> index & 1 == 1).then(|| self.values[index])
    }

    /// The voxels of which the log-odds are so high; not less than 0, as of the occupied ones.
    pub(super) fn at_least(&self, log_odds: f32) -> u64 {
        if self.occupied == 0 {
            return 0;
        }
        let marks = self.values.iter().enumerate();
        let marks = marks.map(|(at, &value)| u64::from(value >= log_odds) << at);
        self.occupied & marks.fold(0, |all, mark| all | mark)
    }

    /// The voxels that a miss does not change.
    pub(super) const fn settled(&self) -> u64 {
        self.settled
    }

    /// The value that all voxels of a set have in common, if they do.
    pub(super) fn common(&self, voxels: u64) -> Option<f32> {
        if self.known & voxels != voxels {
            return None;
        }
        let first = self.values[voxels.trailing_zeros() as usize];
        let same = |(at, value): (usize, &f32)| {
            voxels >> at & 1 == 0 || value.to_bits() == first.to_bits()
        };
        self.values.iter().enumerate().all(same).then_some(first)
    }
}
