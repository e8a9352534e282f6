//! The cells of a block: 4 along each side, one bit each.

/// Cells along a side.
pub(super) const EDGE: usize = 4;

/// Which bit a cell has, by its place in the block; cells above each other are neighbours.
pub(super) const fn cell_in_block([col, row, layer]: [usize; 3]) -> usize {
    (row * EDGE + col) * EDGE + layer
}

/// The place in the block of a bit's cell.
pub(super) const fn place_in_block(cell: usize) -> [usize; 3] {
    [cell / EDGE % EDGE, cell / (EDGE * EDGE), cell % EDGE]
}
