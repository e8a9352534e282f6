//! The mean of all heights that were seen in each cell.

use geometry::{Cell, Grid};

/// What is known of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Mean {
    height_m: f64,
    points: u32,
    frames: u16,
    /// Number of the last frame that had a point here.
    latest: u64,
}

/// A running mean a cell. All points count alike, however old: nothing is ever forgotten but what leaves the window.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MeanHeights {
    cells: Grid<Mean>,
    frame: u64,
}

impl MeanHeights {
    /// Nothing seen in so many cells a side.
    pub(super) fn new(cells: usize) -> Self {
        Self {
            cells: Grid::filled(cells, cells, Mean::default()),
            frame: 0,
        }
    }

    /// Moves the window by whole cells.
    pub(super) fn shift(&mut self, cols: i32, rows: i32) {
        self.cells.shift(cols, rows, &Mean::default());
    }

    /// The points that follow are those of a new frame.
    pub(super) const fn start_frame(&mut self) {
        self.frame += 1;
    }

    /// Takes in a point of the frame; whether its cell is in the window.
    pub(super) fn add(&mut self, cell: Cell, height_m: f64) -> bool {
        let frame = self.frame;
        let Some(mean) = self.cells.get_mut(cell) else {
            return false;
        };
        mean.points = mean.points.saturating_add(1);
        mean.height_m += (height_m - mean.height_m) / f64::from(mean.points);
        if mean.latest != frame {
            mean.latest = frame;
            mean.frames = mean.frames.saturating_add(1);
        }
        true
    }

    /// Mean height of a cell, m; none where nothing was seen, and outside.
    pub(super) fn height(&self, cell: Cell) -> Option<f64> {
        let mean = self.cells.get(cell)?;
        (mean.points > 0).then_some(mean.height_m)
    }

    /// Frames that had points in a cell.
    pub(super) fn frames(&self, cell: Cell) -> u16 {
        self.cells.get(cell).map_or(0, |mean| mean.frames)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_cell_holds_the_arithmetic_mean_of_its_points(
            frames in prop::collection::vec(
                prop::collection::vec((0..6i32, 0..6i32, -0.5..0.8f64), 0..30), 1..8),
        ) {
            let mut means = MeanHeights::new(5);
            for frame in &frames {
                means.start_frame();
                for &(col, row, height_m) in frame {
                    prop_assert_eq!(means.add(Cell::new(col, row), height_m), col < 5 && row < 5);
                }
            }
            for cell in (0..36).map(|i| Cell::new(i % 6, i / 6)) {
                let here = |frame: &Vec<(i32, i32, f64)>| -> Vec<f64> {
                    frame.iter().filter(|p| (p.0, p.1) == (cell.col, cell.row)).map(|p| p.2).collect()
                };
                let all: Vec<f64> = frames.iter().flat_map(here).collect();
                let seen = frames.iter().filter(|frame| !here(frame).is_empty()).count();
                let inside = cell.col < 5 && cell.row < 5;
                let expected = (inside && !all.is_empty()).then(|| all.iter().sum::<f64>() / all.len() as f64);
                prop_assert_eq!(means.frames(cell), if inside { seen as u16 } else { 0 });
                match (means.height(cell), expected) {
                    (Some(found), Some(wanted)) => prop_assert!((found - wanted).abs() < 1e-12),
                    (found, wanted) => prop_assert_eq!(found, wanted),
                }
            }
        }

        #[test]
        fn shifting_moves_the_means_and_forgets_what_leaves(cols in -6..7i32, rows in -6..7i32) {
            let mut means = MeanHeights::new(5);
            means.start_frame();
            for i in 0..25 {
                let _ = means.add(Cell::new(i % 5, i / 5), f64::from(i));
            }
            let before = means.clone();
            means.shift(cols, rows);
            for i in 0..25 {
                let cell = Cell::new(i % 5, i / 5);
                let from = Cell::new(cell.col + cols, cell.row + rows);
                prop_assert_eq!(means.height(cell), before.height(from));
            }
        }
    }
}
