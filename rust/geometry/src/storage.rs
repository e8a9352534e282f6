//! Cells by where grids store them: loops over many cells need no column, row and bounds for each.

use std::ops::Range;

use crate::CellArea;

/// Where the cells of an area are stored that lie in grids of so many columns and rows: a run for each row.
pub fn runs(area: CellArea, size: [usize; 2]) -> impl Iterator<Item = Range<usize>> {
    let [cols, rows] = size;
    let within = |low: i32, high: i32, count: usize| {
        let end = (i64::from(high) + 1).clamp(0, count as i64) as usize;
        (low.max(0) as usize).min(end)..end
    };
    let across = within(area.min.col, area.max.col, cols);
    let down = within(area.min.row, area.max.row, rows);
    down.map(move |row| row * cols + across.start..row * cols + across.end)
}

/// Cells in a row that lie side by side in another row, too: which, and where the first of them lies there. `there`: where a cell lies in the
/// other row, if it does.
pub fn in_step(
    cells: Range<usize>,
    there: impl Fn(usize) -> Option<usize>,
) -> impl Iterator<Item = (Range<usize>, usize)> {
    let (mut at, end) = (cells.start, cells.end);
    std::iter::from_fn(move || {
        while at < end {
            let begin = at;
            at += 1;
            if let Some(first) = there(begin) {
                while at < end && there(at) == Some(first + at - begin) {
                    at += 1;
                }
                return Some((begin..at, first));
            }
        }
        None
    })
}

#[cfg(test)]
mod tests {
    use crate::{Cell, Grid};
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn runs_hold_the_cells_of_the_area_in_the_grid(
            [min_col, min_row, max_col, max_row] in prop::array::uniform4(-3..9_i32),
        ) {
            let area = CellArea {
                min: Cell::new(min_col, min_row),
                max: Cell::new(max_col, max_row),
            };
            let grid = Grid::filled(6, 5, ());
            let expected: Vec<_> = area.cells().filter_map(|cell| grid.index(cell)).collect();
            let found: Vec<_> = runs(area, [6, 5]).flatten().collect();
            prop_assert_eq!(found, expected);
        }
    }

    #[test]
    fn no_cells_have_no_runs() {
        assert_eq!(runs(CellArea::EMPTY, [6, 5]).count(), 0);
    }

    #[test]
    fn what_lies_side_by_side_in_both_rows_is_one_piece() {
        let there = |cell: usize| [None, Some(4), Some(5), Some(5), None, Some(9)][cell];
        let pieces: Vec<_> = in_step(0..6, there).collect();
        assert_eq!(pieces, [(1..3, 4), (3..4, 5), (5..6, 9)]);
    }
}
