//! What is known of each voxel, column by column: codes of probabilities, and masks that are kept in step with them.

use geometry::Grid;

use super::{ProbabilityTable, Size};

/// The layers of a cell lie side by side in storage: a line of sight that looks down stays within a cache line for long,
/// and the highest occupied layer is one instruction on the cell's mask.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Voxels {
    layers: usize,
    table: ProbabilityTable,
    /// So many columns for each cell.
    codes: Grid<u8>,
    /// One bit a layer: whether its probability exceeds `p_occ`.
    occupied: Grid<u64>,
    /// One bit a layer: whether it is as free as can be, so that another miss changes nothing.
    settled: Grid<u64>,
    /// One bit a layer: whether it is rather occupied than not.
    likely: Grid<u64>,
}

/// Layers of a cell, one bit each.
#[derive(Debug, Clone, Copy)]
pub(super) struct Column {
    /// The layers of which nothing is to be found out.
    pub(super) known: u64,
    /// The layers that are rather occupied than not.
    pub(super) likely: u64,
}

impl Voxels {
    /// Voxels of which nothing is known: 0.5 everywhere, equation (4).
    pub(super) fn new(size: Size, table: ProbabilityTable) -> Self {
        let Size { cols, rows, layers } = size;
        Self {
            layers,
            codes: Grid::filled(cols * layers, rows, table.unknown()),
            occupied: Grid::filled(cols, rows, 0),
            settled: Grid::filled(cols, rows, 0),
            likely: Grid::filled(cols, rows, 0),
            table,
        }
    }

    /// Probability that a voxel is occupied.
    pub(super) fn probability(&self, cell: usize, layer: usize) -> f64 {
        self.table
            .decode(self.codes.values()[cell * self.layers + layer])
    }

    /// Occupied layers of a cell, one bit each.
    pub(super) fn occupied(&self, cell: usize) -> u64 {
        self.occupied.values()[cell]
    }

    /// For every cell the layers that a miss does not change, one bit each.
    pub(super) fn settled(&self) -> &[u64] {
        self.settled.values()
    }

    /// What a search for misses needs to know of a cell.
    #[inline]
    pub(super) fn column(&self, cell: usize) -> Column {
        Column {
            known: self.settled.values()[cell],
            likely: self.likely.values()[cell],
        }
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
            layers & !self.settled.values()[cell],
            ProbabilityTable::after_miss,
        );
    }

    #[inline]
    fn update(&mut self, cell: usize, layers: u64, after: impl Fn(&ProbabilityTable, u8) -> u8) {
        let column = &mut self.codes.values_mut()[cell * self.layers..][..self.layers];
        let (mut occupied, mut settled, mut likely) = (0, 0, 0);
        for layer in bits(layers) {
            let code = after(&self.table, column[layer]);
            column[layer] = code;
            occupied |= u64::from(self.table.is_occupied(code)) << layer;
            settled |= u64::from(self.table.after_miss(code) == code) << layer;
            likely |= u64::from(code > self.table.unknown()) << layer;
        }
        for (grid, new) in [
            (&mut self.occupied, occupied),
            (&mut self.settled, settled),
            (&mut self.likely, likely),
        ] {
            let mask = &mut grid.values_mut()[cell];
            *mask = *mask & !layers | new;
        }
    }

    /// What was at cell (c + cols, r + rows) is now at (c, r).
    pub(super) fn shift(&mut self, cols: i32, rows: i32) {
        let (depth, unknown) = (self.layers as i32, self.table.unknown());
        self.codes.shift(cols.saturating_mul(depth), rows, &unknown);
        self.occupied.shift(cols, rows, &0);
        self.settled.shift(cols, rows, &0);
        self.likely.shift(cols, rows, &0);
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
        for column in self.codes.values_mut().chunks_exact_mut(depth) {
            if by > 0 {
                column.copy_within(depth - kept.., 0);
                column[kept..].fill(unknown);
            } else {
                column.copy_within(..kept, depth - kept);
                column[..depth - kept].fill(unknown);
            }
        }
        for grid in [&mut self.occupied, &mut self.settled, &mut self.likely] {
            for mask in grid.values_mut() {
                *mask = shifted(*mask);
            }
        }
    }
}

/// Positions of the set bits.
#[inline]
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
        Shift(i32, i32),
        ShiftLayers(i32),
    }

    fn change() -> impl Strategy<Value = Change> {
        let layers = || any::<u64>().prop_map(|mask| mask >> (64 - LAYERS));
        prop_oneof![
            3 => (0..4_usize, layers()).prop_map(|(cell, layers)| Change::Hit(cell, layers)),
            8 => (0..4_usize, layers()).prop_map(|(cell, layers)| Change::Miss(cell, layers)),
            2 => (-2..3, -2..3).prop_map(|(cols, rows)| Change::Shift(cols, rows)),
            1 => (-30..30).prop_map(Change::ShiftLayers),
        ]
    }

    proptest! {
        #[test]
        fn masks_say_what_the_codes_say_and_no_update_is_lost(
            changes in proptest::collection::vec(change(), 0..80),
        ) {
            let table = ProbabilityTable::new(0.7, 0.7, 0.05, 0.95);
            let size = Size { cols: 2, rows: 2, layers: LAYERS };
            let mut voxels = Voxels::new(size, table.clone());
            for change in changes {
                let mut codes = voxels.codes.values().to_vec();
                match change {
                    Change::Hit(cell, layers) => {
                        voxels.hit(cell, layers);
                        for layer in bits(layers) {
                            let code = &mut codes[cell * LAYERS + layer];
                            *code = table.after_hit(*code);
                        }
                        prop_assert_eq!(voxels.codes.values(), &codes);
                    }
                    Change::Miss(cell, layers) => {
                        voxels.miss(cell, layers);
                        for layer in bits(layers) {
                            let code = &mut codes[cell * LAYERS + layer];
                            *code = table.after_miss(*code);
                        }
                        prop_assert_eq!(voxels.codes.values(), &codes);
                    }
                    Change::Shift(cols, rows) => voxels.shift(cols, rows),
                    Change::ShiftLayers(by) => voxels.shift_layers(by),
                }
                for cell in 0..4 {
                    for layer in 0..64 {
                        let code = voxels.codes.values().get(cell * LAYERS + layer).filter(|_| layer < LAYERS);
                        let [occupied, settled, likely] = [&voxels.occupied, &voxels.settled, &voxels.likely]
                            .map(|masks| masks.values()[cell] >> layer & 1 == 1);
                        prop_assert_eq!(occupied, code.is_some_and(|&code| table.is_occupied(code)));
                        prop_assert_eq!(likely, code.is_some_and(|&code| code > table.unknown()));
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
