//! A dynamic three-dimensional grid: cells by their hashed place, and only those in which something is (004, ref. 36.21).

use std::collections::HashMap;

/// Place of a cell of the grid, in whole cells from the map's origin along x, y and z.
pub type GridKey = [i32; 3];

/// What is in the occupied cells of an unbounded grid. Looking a cell up, putting one in and taking one out take the same time however many
/// there are, amortised; the memory is in proportion to the occupied ones. Cells are gone through in the order in which they were put
/// in, never in that of the hashes.
#[derive(Debug, Clone, Default)]
pub struct SparseGrid<T> {
    places: HashMap<GridKey, u32>,
    cells: Vec<(GridKey, T)>,
}

impl<T> SparseGrid<T> {
    /// A grid in which nothing is.
    pub fn new() -> Self {
        Self {
            places: HashMap::new(),
            cells: Vec::new(),
        }
    }

    /// Cells in which something is.
    pub const fn len(&self) -> usize {
        self.cells.len()
    }

    /// Whether nothing is anywhere.
    pub const fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// Bytes that the grid has asked for, without what its cells point to.
    pub fn bytes(&self) -> usize {
        let slot = size_of::<(GridKey, u32)>() + 1;
        self.places.capacity() * slot + self.cells.capacity() * size_of::<(GridKey, T)>()
    }

    /// Where a cell is stored, until one is taken out.
    #[inline]
    pub fn position(&self, key: GridKey) -> Option<usize> {
        self.places.get(&key).map(|&at| at as usize)
    }

    /// What is in a cell.
    pub fn get(&self, key: GridKey) -> Option<&T> {
        self.position(key).map(|at| &self.cells[at].1)
    }

    /// Where a cell is stored in which something is, or is put.
    pub fn position_or_insert(&mut self, key: GridKey, fresh: impl FnOnce() -> T) -> usize {
        let next = self.cells.len() as u32;
        let at = *self.places.entry(key).or_insert(next);
        if at == next {
            self.cells.push((key, fresh()));
        }
        at as usize
    }

    /// The cell that is stored at a position.
    #[inline]
    pub fn at(&self, position: usize) -> (GridKey, &T) {
        let (key, cell) = &self.cells[position];
        (*key, cell)
    }

    /// The cell that is stored at a position, to be changed.
    #[inline]
    pub fn at_mut(&mut self, position: usize) -> (GridKey, &mut T) {
        let (key, cell) = &mut self.cells[position];
        (*key, cell)
    }

    /// All cells in which something is.
    pub fn iter(&self) -> impl Iterator<Item = (GridKey, &T)> {
        self.cells.iter().map(|(key, cell)| (*key, cell))
    }

    /// Keeps the cells of which this holds; the others are taken out.
    pub fn retain(&mut self, mut keep: impl FnMut(GridKey, &mut T) -> bool) {
        let before = self.cells.len();
        let places = &mut self.places;
        self.cells.retain_mut(|(key, cell)| {
            let kept = keep(*key, cell);
            if !kept {
                let _ = places.remove(key);
            }
            kept
        });
        if self.cells.len() < before {
            for (at, (key, _)) in self.cells.iter().enumerate() {
                let _ = places.insert(*key, at as u32);
            }
            if self.cells.len() < self.cells.capacity() / 4 {
                self.cells.shrink_to_fit();
                places.shrink_to_fit();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeMap;

    fn key() -> impl Strategy<Value = GridKey> {
        prop::array::uniform3(-4..4_i32)
    }

    proptest! {
        #[test]
        fn a_sparse_grid_holds_what_an_ordered_map_holds(
            steps in prop::collection::vec((key(), any::<u8>(), prop::bool::weighted(0.2)), 1..200),
        ) {
            let (mut grid, mut model) = (SparseGrid::new(), BTreeMap::new());
            for (key, value, take) in steps {
                if take {
                    grid.retain(|other, _| other != key);
                    let _ = model.remove(&key);
                } else {
                    let at = grid.position_or_insert(key, || value);
                    *grid.at_mut(at).1 = value;
                    let _ = model.insert(key, value);
                }
                prop_assert_eq!(grid.len(), model.len());
                prop_assert_eq!(grid.get(key), model.get(&key));
            }
            let held: BTreeMap<_, _> = grid.iter().map(|(key, &value)| (key, value)).collect();
            prop_assert_eq!(held, model);
        }
    }

    #[test]
    fn the_memory_is_in_proportion_to_the_occupied_cells_however_far_apart_they_are() {
        for (count, stride) in [(100, 1), (100, 100_000), (10_000, 1), (10_000, 200_000)] {
            let mut grid = SparseGrid::new();
            for at in 0..count {
                let _ = grid.position_or_insert([at * stride, -at, at % 7], || 0_u64);
            }
            // Vectors and tables double; a table is at most 7/8 full.
            let one = size_of::<(GridKey, u64)>() + size_of::<(GridKey, u32)>() + 1;
            assert!(grid.bytes() <= count as usize * one * 3, "{count} {stride}");
            grid.retain(|key, _| key[0] < 10 * stride);
            assert!(grid.len() == 10 && grid.bytes() < 50 * one);
        }
    }
}
