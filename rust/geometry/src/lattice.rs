//! Cells and metres meet here and nowhere else; grids hold one value a cell.
//!
//! A *cell* is integers, a *point* is metres, an *index* is an offset into storage. Rows run along +y, columns along +x.

use crate::CellArea;

/// A cell of a lattice. Any integer, also outside a grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Cell {
    /// Along +x.
    pub col: i32,
    /// Along +y.
    pub row: i32,
}

impl Cell {
    /// A cell from its column and row.
    pub const fn new(col: i32, row: i32) -> Self {
        Self { col, row }
    }
}

/// Square cells over the plane: the corner of cell (0, 0) lies at `origin_m`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Lattice {
    /// Lower-left corner of cell (0, 0), metres.
    pub origin_m: [f64; 2],
    /// Side of a cell, metres.
    pub cell_m: f64,
}

impl Lattice {
    /// The cell that contains the point: rounds down.
    pub fn cell_at(&self, x_m: f64, y_m: f64) -> Cell {
        Cell {
            col: floor((x_m - self.origin_m[0]) / self.cell_m),
            row: floor((y_m - self.origin_m[1]) / self.cell_m),
        }
    }

    /// Centre of a cell, metres.
    pub fn center_of(&self, cell: Cell) -> [f64; 2] {
        [
            self.origin_m[0] + (f64::from(cell.col) + 0.5) * self.cell_m,
            self.origin_m[1] + (f64::from(cell.row) + 0.5) * self.cell_m,
        ]
    }
}

/// Rounds down without the call that `f64::floor` is on the oldest processors; saturates.
fn floor(value: f64) -> i32 {
    let towards_zero = value as i32;
    towards_zero.saturating_sub(i32::from(value < f64::from(towards_zero)))
}

/// A value for every cell of a rectangle that starts at cell (0, 0); stored row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid<T> {
    cols: usize,
    rows: usize,
    values: Vec<T>,
}

impl<T: Clone> Grid<T> {
    /// A grid that holds `value` everywhere.
    pub fn filled(cols: usize, rows: usize, value: T) -> Self {
        Self {
            cols,
            rows,
            values: vec![value; cols * rows],
        }
    }

    /// Sets every cell to `value`.
    pub fn fill(&mut self, value: &T) {
        self.values.fill(value.clone());
    }
}

impl<T: Copy> Grid<T> {
    /// Moves the content so that what was at cell (c + cols, r + rows) is now at (c, r); what comes in is `value`.
    pub fn shift(&mut self, cols: i32, rows: i32, value: &T) {
        let [across, down] = [cols, rows].map(|by| by.unsigned_abs() as usize);
        if across >= self.cols || down >= self.rows {
            self.fill(value);
            return;
        }
        // As one line of values. What goes over the end of a row comes into the next one, where nothing else comes in.
        let count = self.values.len();
        let by = rows as isize * self.cols as isize + cols as isize;
        let moved = by.unsigned_abs();
        if by > 0 {
            self.values.copy_within(moved.., 0);
            self.values[count - moved..].fill(*value);
        } else {
            self.values.copy_within(..count - moved, moved);
            self.values[..moved].fill(*value);
        }
        let incoming = if cols > 0 {
            self.cols - across..self.cols
        } else {
            0..across
        };
        for line in self.values.chunks_exact_mut(self.cols) {
            line[incoming.clone()].fill(*value);
        }
    }
}

impl<T> Grid<T> {
    /// Number of columns.
    pub const fn cols(&self) -> usize {
        self.cols
    }

    /// Number of rows.
    pub const fn rows(&self) -> usize {
        self.rows
    }

    /// All cells of the grid.
    pub const fn area(&self) -> CellArea {
        CellArea {
            min: Cell::new(0, 0),
            max: Cell::new(self.cols as i32 - 1, self.rows as i32 - 1),
        }
    }

    /// Offset of a cell into [`Self::values`], `None` outside.
    pub const fn index(&self, cell: Cell) -> Option<usize> {
        if cell.col < 0
            || cell.row < 0
            || cell.col as usize >= self.cols
            || cell.row as usize >= self.rows
        {
            None
        } else {
            Some(cell.row as usize * self.cols + cell.col as usize)
        }
    }

    /// The value of a cell, `None` outside.
    pub fn get(&self, cell: Cell) -> Option<&T> {
        self.index(cell).map(|index| &self.values[index])
    }

    /// The value of a cell for writing, `None` outside.
    pub fn get_mut(&mut self, cell: Cell) -> Option<&mut T> {
        self.index(cell).map(|index| &mut self.values[index])
    }

    /// The values of a row in these columns, as far as the grid goes.
    pub fn row(&self, row: i32, columns: std::ops::Range<i32>) -> &[T] {
        let Some(first) = usize::try_from(row).ok().filter(|&row| row < self.rows) else {
            return &[];
        };
        let column = |column: i32| column.clamp(0, self.cols as i32) as usize;
        let (from, to) = (column(columns.start), column(columns.end));
        let line = &self.values[first * self.cols..(first + 1) * self.cols];
        line.get(from..to).unwrap_or(&[])
    }

    /// All values, row by row.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// All values for writing, row by row.
    pub fn values_mut(&mut self) -> &mut [T] {
        &mut self.values
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_cell_contains_its_own_center(
            col in -500..500i32, row in -500..500i32, x in -3.0..3.0f64, y in -3.0..3.0f64, cell_m in 0.01..0.5f64,
        ) {
            let lattice = Lattice { origin_m: [x, y], cell_m };
            let cell = Cell::new(col, row);
            let [cx, cy] = lattice.center_of(cell);
            prop_assert_eq!(lattice.cell_at(cx, cy), cell);
        }

        #[test]
        fn a_row_holds_the_cells_of_its_columns(row in -2..6i32, from in -3..8i32, to in -3..8i32) {
            let mut grid = Grid::filled(5, 3, 0);
            for (i, value) in grid.values_mut().iter_mut().enumerate() {
                *value = i as i32 + 1;
            }
            let expected: Vec<i32> = (from..to).filter_map(|col| grid.get(Cell::new(col, row)).copied()).collect();
            prop_assert_eq!(grid.row(row, from..to), expected);
        }

        #[test]
        fn shifting_moves_every_value_and_fills_the_rest(cols in -4..5i32, rows in -4..5i32) {
            let mut grid = Grid::filled(5, 3, 0);
            for (i, value) in grid.values_mut().iter_mut().enumerate() {
                *value = i as i32 + 1;
            }
            let before = grid.clone();
            grid.shift(cols, rows, &0);
            for cell in before.area().cells() {
                let expected = before.get(Cell::new(cell.col + cols, cell.row + rows)).copied().unwrap_or(0);
                prop_assert_eq!(grid.get(cell).copied(), Some(expected));
            }
        }
    }
}
