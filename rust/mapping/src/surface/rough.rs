//! Cells that are too rough to step on, though some frames take what is there for a floor.

use geometry::{Cell, CellArea, Grid, Lattice};

use super::LabelledPoint;

/// Points that a cell is ahead by at most: what is there may be moved.
const LEAD: i8 = 60;

/// For each cell, how many more points of rough surfaces than of smooth ones fell into it.
#[derive(Debug, Clone)]
pub(crate) struct Rough {
    lead: Grid<i8>,
    /// Whether any rough point ever came: most robots walk for hours without.
    any: bool,
}

impl Rough {
    /// Nothing is rough.
    pub(crate) fn new(cells: usize) -> Self {
        Self {
            lead: Grid::filled(cells, cells, 0),
            any: false,
        }
    }

    /// Moves the window by whole cells.
    pub(crate) fn shift(&mut self, cols: i32, rows: i32) {
        self.lead.shift(cols, rows, &0);
    }

    /// Whether most of what was seen of a cell was rough.
    pub(crate) fn is_rough(&self, cell: Cell) -> bool {
        self.any && self.lead.get(cell).is_some_and(|&lead| lead > 0)
    }

    /// Takes in the points of a frame; the cells that may have become rough or ceased to be.
    pub(crate) fn take(&mut self, points: &[LabelledPoint], lattice: &Lattice) -> CellArea {
        let mut area = CellArea::EMPTY;
        self.any |= points.iter().any(|point| point.rough == Some(true));
        if !self.any {
            return area;
        }
        for point in points {
            let Some(rough) = point.rough else { continue };
            let [x, y, _] = point.position_m;
            let cell = lattice.cell_at(x, y);
            if let Some(lead) = self.lead.get_mut(cell) {
                *lead = (*lead + if rough { 1 } else { -1 }).clamp(-LEAD, LEAD);
                area.include(cell);
            }
        }
        area
    }
}
