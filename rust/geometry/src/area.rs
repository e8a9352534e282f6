//! Rectangles of cells.

use crate::Cell;

/// A rectangle of cells, both ends included; empty where `min > max`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CellArea {
    /// Smallest column and row.
    pub min: Cell,
    /// Largest column and row.
    pub max: Cell,
}

impl CellArea {
    /// No cell.
    pub const EMPTY: Self = Self {
        min: Cell::new(i32::MAX, i32::MAX),
        max: Cell::new(i32::MIN, i32::MIN),
    };

    /// One cell.
    pub const fn of(cell: Cell) -> Self {
        Self {
            min: cell,
            max: cell,
        }
    }

    /// With so many more cells on each side; nothing stays nothing.
    #[must_use]
    pub const fn grown(self, cells: i32) -> Self {
        if self.is_empty() {
            return self;
        }
        Self {
            min: Cell::new(self.min.col - cells, self.min.row - cells),
            max: Cell::new(self.max.col + cells, self.max.row + cells),
        }
    }

    /// The cells along its four sides, so many deep.
    pub const fn rim(self, cells: i32) -> [Self; 4] {
        let Self { min, max } = self;
        let inside = cells - 1;
        [
            Self {
                min,
                max: Cell::new(max.col, min.row + inside),
            },
            Self {
                min: Cell::new(min.col, max.row - inside),
                max,
            },
            Self {
                min,
                max: Cell::new(min.col + inside, max.row),
            },
            Self {
                min: Cell::new(max.col - inside, min.row),
                max,
            },
        ]
    }

    /// What it shares with `other`.
    #[must_use]
    pub fn within(self, other: Self) -> Self {
        Self {
            min: Cell::new(
                self.min.col.max(other.min.col),
                self.min.row.max(other.min.row),
            ),
            max: Cell::new(
                self.max.col.min(other.max.col),
                self.max.row.min(other.max.row),
            ),
        }
    }

    /// Whether it holds no cell.
    pub const fn is_empty(&self) -> bool {
        self.min.col > self.max.col || self.min.row > self.max.row
    }

    /// Grows to hold `cell`.
    pub fn include(&mut self, cell: Cell) {
        self.min = Cell::new(self.min.col.min(cell.col), self.min.row.min(cell.row));
        self.max = Cell::new(self.max.col.max(cell.col), self.max.row.max(cell.row));
    }

    /// Grows to hold `other`.
    pub fn join(&mut self, other: Self) {
        if !other.is_empty() {
            self.include(other.min);
            self.include(other.max);
        }
    }

    /// Whether it holds `cell`.
    pub const fn contains(&self, cell: Cell) -> bool {
        cell.col >= self.min.col
            && cell.col <= self.max.col
            && cell.row >= self.min.row
            && cell.row <= self.max.row
    }

    /// Its cells, row by row.
    pub fn cells(self) -> impl Iterator<Item = Cell> {
        (self.min.row..=self.max.row)
            .flat_map(move |row| (self.min.col..=self.max.col).map(move |col| Cell { col, row }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_rim_of_an_area_is_what_growing_from_outside_reaches(
            [col, row, cols, rows] in prop::array::uniform4(0..7i32), deep in 1..4i32,
        ) {
            let area = CellArea { min: Cell::new(col, row), max: Cell::new(col + cols, row + rows) };
            let rim = area.rim(deep);
            for cell in area.grown(2).cells() {
                // A cell reaches out of the area when the cells around it do.
                let around = CellArea::of(cell).grown(deep);
                let reaches_out = around.within(area) != around;
                let in_rim = rim.iter().any(|side| side.contains(cell));
                prop_assert_eq!(in_rim && area.contains(cell), reaches_out && area.contains(cell));
            }
        }
    }

    #[test]
    fn nothing_grown_stays_nothing() {
        assert!(CellArea::EMPTY.grown(1).is_empty());
    }

    #[test]
    fn joined_areas_hold_both_and_an_empty_one_adds_nothing() {
        let area = |a: [i32; 4]| CellArea {
            min: Cell::new(a[0], a[1]),
            max: Cell::new(a[2], a[3]),
        };
        let mut joined = CellArea::EMPTY;
        joined.join(CellArea::EMPTY);
        assert!(joined.is_empty());
        joined.join(area([2, 3, 4, 5]));
        joined.join(CellArea::EMPTY);
        assert_eq!(joined, area([2, 3, 4, 5]));
        joined.join(area([0, 4, 3, 9]));
        assert_eq!(joined, area([0, 3, 4, 9]));
    }

    #[test]
    fn an_area_holds_what_it_was_given_and_no_less() {
        let mut area = CellArea::EMPTY;
        assert!(area.is_empty());
        area.include(Cell::new(3, -1));
        area.include(Cell::new(1, 4));
        assert!(area.contains(Cell::new(2, 0)) && !area.contains(Cell::new(0, 0)));
        assert_eq!(area.cells().count(), 3 * 6);
    }
}
