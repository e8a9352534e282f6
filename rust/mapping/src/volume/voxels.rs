//! What is known of each voxel, column by column: codes of probabilities, and masks that are kept in step with them.

use super::ProbabilityTable;

/// The layers of a cell lie side by side in storage: a line of sight that looks down stays within a cache line for long,
/// and the highest occupied layer is one instruction on the cell's mask.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Voxels {
    layers: usize,
    table: ProbabilityTable,
    codes: Vec<u8>,
    /// One bit a layer: whether its probability exceeds `p_occ`.
    occupied: Vec<u64>,
    /// One bit a layer: whether it is as free as can be, so that another miss changes nothing.
    settled: Vec<u64>,
}

impl Voxels {
    /// Of which nothing is known: 0.5 everywhere, equation (4).
    pub(super) fn new(cells: usize, layers: usize, table: ProbabilityTable) -> Self {
        Self {
            layers,
            codes: vec![table.unknown(); cells * layers],
            occupied: vec![0; cells],
            settled: vec![0; cells],
            table,
        }
    }

    /// Probability that a voxel is occupied.
    pub(super) fn probability(&self, cell: usize, layer: usize) -> f64 {
        self.table.decode(self.codes[cell * self.layers + layer])
    }

    /// Occupied layers of a cell, one bit each.
    pub(super) fn occupied(&self, cell: usize) -> u64 {
        self.occupied[cell]
    }

    /// For every cell the layers that a miss does not change, one bit each.
    pub(super) fn settled(&self) -> &[u64] {
        &self.settled
    }

    /// Takes in a measurement at layers of a cell.
    #[inline]
    pub(super) fn hit(&mut self, cell: usize, layers: u64) {
        self.update(cell, layers, ProbabilityTable::after_hit);
    }

    /// Takes in rays that passed through layers of a cell.
    #[inline]
    pub(super) fn miss(&mut self, cell: usize, layers: u64) {
        self.update(
            cell,
            layers & !self.settled[cell],
            ProbabilityTable::after_miss,
        );
    }

    #[inline]
    fn update(&mut self, cell: usize, layers: u64, after: impl Fn(&ProbabilityTable, u8) -> u8) {
        let column = &mut self.codes[cell * self.layers..][..self.layers];
        let (mut occupied, mut settled) = (0, 0);
        for layer in bits(layers) {
            let code = after(&self.table, column[layer]);
            column[layer] = code;
            occupied |= u64::from(self.table.is_occupied(code)) << layer;
            settled |= u64::from(self.table.after_miss(code) == code) << layer;
        }
        self.occupied[cell] = self.occupied[cell] & !layers | occupied;
        self.settled[cell] = self.settled[cell] & !layers | settled;
    }

    /// What was in a cell is now in another one.
    pub(super) fn copy(&mut self, from: usize, to: usize) {
        let depth = self.layers;
        self.codes
            .copy_within(from * depth..(from + 1) * depth, to * depth);
        self.occupied[to] = self.occupied[from];
        self.settled[to] = self.settled[from];
    }

    /// Nothing is known of a cell.
    pub(super) fn forget(&mut self, cell: usize) {
        let unknown = self.table.unknown();
        self.codes[cell * self.layers..][..self.layers].fill(unknown);
        self.occupied[cell] = 0;
        self.settled[cell] = 0;
    }

    /// What was in layer `l + by` is now in layer `l`.
    pub(super) fn shift_layers(&mut self, by: i32) {
        let (depth, unknown) = (self.layers, self.table.unknown());
        let moved = by.unsigned_abs();
        let kept = depth.saturating_sub(moved as usize);
        let all = u64::MAX >> (64 - depth);
        let shifted = |mask: u64| {
            let shifted = if by > 0 {
                mask.checked_shr(moved)
            } else {
                mask.checked_shl(moved)
            };
            shifted.unwrap_or(0) & all
        };
        for column in self.codes.chunks_exact_mut(depth) {
            if by > 0 {
                column.copy_within(depth - kept.., 0);
                column[kept..].fill(unknown);
            } else {
                column.copy_within(..kept, depth - kept);
                column[..depth - kept].fill(unknown);
            }
        }
        for mask in self.occupied.iter_mut().chain(&mut self.settled) {
            *mask = shifted(*mask);
        }
    }
}

/// Positions of the set bits.
pub(super) fn bits(mut mask: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = (mask != 0).then(|| mask.trailing_zeros() as usize)?;
        mask &= mask - 1;
        Some(bit)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const LAYERS: usize = 24;

    #[derive(Debug, Clone)]
    enum Change {
        Hit(usize, u64),
        Miss(usize, u64),
        Copy(usize, usize),
        Forget(usize),
        ShiftLayers(i32),
    }

    fn change() -> impl Strategy<Value = Change> {
        let layers = || any::<u64>().prop_map(|mask| mask >> (64 - LAYERS));
        prop_oneof![
            3 => (0..4_usize, layers()).prop_map(|(cell, layers)| Change::Hit(cell, layers)),
            8 => (0..4_usize, layers()).prop_map(|(cell, layers)| Change::Miss(cell, layers)),
            1 => (0..4_usize, 0..4_usize).prop_map(|(from, to)| Change::Copy(from, to)),
            1 => (0..4_usize).prop_map(Change::Forget),
            1 => (-30..30).prop_map(Change::ShiftLayers),
        ]
    }

    proptest! {
        #[test]
        fn masks_say_what_the_codes_say_and_no_update_is_lost(
            changes in proptest::collection::vec(change(), 0..80),
        ) {
            let table = ProbabilityTable::new(0.7, 0.7, 0.05, 0.95);
            let mut voxels = Voxels::new(4, LAYERS, table.clone());
            for change in changes {
                let mut codes = voxels.codes.clone();
                match change {
                    Change::Hit(cell, layers) => {
                        voxels.hit(cell, layers);
                        for layer in bits(layers) {
                            let code = &mut codes[cell * LAYERS + layer];
                            *code = table.after_hit(*code);
                        }
                        prop_assert_eq!(&voxels.codes, &codes);
                    }
                    Change::Miss(cell, layers) => {
                        voxels.miss(cell, layers);
                        for layer in bits(layers) {
                            let code = &mut codes[cell * LAYERS + layer];
                            *code = table.after_miss(*code);
                        }
                        prop_assert_eq!(&voxels.codes, &codes);
                    }
                    Change::Copy(from, to) => voxels.copy(from, to),
                    Change::Forget(cell) => voxels.forget(cell),
                    Change::ShiftLayers(by) => voxels.shift_layers(by),
                }
                for cell in 0..4 {
                    for layer in 0..64 {
                        let code = voxels.codes.get(cell * LAYERS + layer).filter(|_| layer < LAYERS);
                        let [occupied, settled] = [&voxels.occupied, &voxels.settled]
                            .map(|masks| masks[cell] >> layer & 1 == 1);
                        prop_assert_eq!(occupied, code.is_some_and(|&code| table.is_occupied(code)));
                        prop_assert_eq!(
                            settled,
                            code.is_some_and(|&code| table.after_miss(code) == code)
                        );
                    }
                }
            }
        }
    }
}
