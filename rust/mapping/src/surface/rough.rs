//! Cells that are too rough to step on, though some frames take what is there for a floor.

use geometry::{Cell, CellArea, Grid};

use super::LabelledFrame;

/// For each cell, how many more points of rough surfaces than of smooth ones fell into it.
#[derive(Debug, Clone)]
pub(crate) struct Rough {
    lead: Grid<i8>,
    /// Whether any rough point ever came: most robots walk for hours without.
    any: bool,
    /// Points that a cell is ahead by at most.
    most: i8,
}

impl Rough {
    /// Nothing is rough. A cell is ahead by at most `lead` points.
    pub(crate) fn new(cells: usize, lead: u8) -> Self {
        Self {
            lead: Grid::filled(cells, cells, 0),
            any: false,
            most: lead as i8,
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
    pub(crate) fn take(&mut self, frame: &LabelledFrame) -> CellArea {
        let mut area = CellArea::EMPTY;
        self.any |= frame.points.iter().any(|point| point.rough == Some(true));
        if !self.any {
            return area;
        }
        let cols = self.lead.cols();
        let most = self.most;
        let leads = self.lead.values_mut();
        let mut last = None;
        for (point, index) in frame.located() {
            if let (Some(rough), Some(index)) = (point.rough, index) {
                let lead = &mut leads[index];
                *lead = (*lead + if rough { 1 } else { -1 }).clamp(-most, most);
                if last.replace(index) != Some(index) {
                    area.include(Cell::new((index % cols) as i32, (index / cols) as i32));
                }
            }
        }
        area
    }
}
