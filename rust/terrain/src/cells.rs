//! Cells by their indices in a grid that is stored row by row.

/// The cells of a square around one, itself among them, up to so many cells away.
pub(crate) fn around(
    index: usize,
    cells: usize,
    [cols, rows]: [usize; 2],
) -> impl Iterator<Item = usize> {
    let (col, row) = (index % cols, index / cols);
    let across = col.saturating_sub(cells)..(col + cells + 1).min(cols);
    let rows = row.saturating_sub(cells)..(row + cells + 1).min(rows);
    rows.flat_map(move |row| across.clone().map(move |col| row * cols + col))
}

/// The cells that share a side with one, of so many.
pub(crate) fn beside(cell: usize, cols: usize, count: usize) -> impl Iterator<Item = usize> {
    let col = cell % cols;
    [
        (col > 0, cell.wrapping_sub(1)),
        (col + 1 < cols, cell + 1),
        (cell >= cols, cell.wrapping_sub(cols)),
        (cell + cols < count, cell + cols),
    ]
    .into_iter()
    .filter_map(|(inside, next)| inside.then_some(next))
}
