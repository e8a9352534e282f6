//! What is shown of what is known: floor, obstacle or unknown, and slopes.

use geometry::{Cell, CellArea, runs};

use super::edges::upper_surface;
use super::{Elevation, cell_of};
use crate::Surface;

impl Elevation {
    /// Height of a cell and how many frames saw it: measured, filled, or that of a coarser grid.
    fn height(&self, index: usize) -> Option<(f32, u16)> {
        if let Some(known) = self.cells.values()[index].known() {
            return Some((known.estimate.height_m, known.frames));
        }
        let filled = self.filled.values()[index];
        if !filled.height_m.is_nan() {
            return Some((filled.height_m, filled.frames));
        }
        let centre_m = self
            .window
            .lattice()
            .center_of(cell_of(index, self.view.size()));
        let coarse = self.pyramid.at(centre_m)?;
        Some((coarse.estimate.height_m, coarse.frames))
    }

    /// What a cell counts as: an obstacle where it lies too far above one beside it.
    fn surface(&self, index: usize) -> (Surface, u16) {
        let Some((own_m, frames)) = self.height(index) else {
            let stood = self.underfoot.height_at(index);
            return (stood.map_or(Surface::Unknown, Surface::Floor), 0);
        };
        let size = self.view.size();
        let cell = cell_of(index, size);
        let away = |away: [i32; 2]| self.height_at(index, away);
        let height_m = upper_surface(own_m, away, self.edge_rule()).unwrap_or(own_m);
        let beside = CellArea::of(cell).grown(1);
        let heights = runs(beside, size)
            .flatten()
            .filter_map(|other| self.height(other));
        let lowest_m = heights.fold(height_m, |low, (other, _)| low.min(other));
        if f64::from(height_m - lowest_m) > self.config.rise {
            (Surface::Obstacle(height_m), 0)
        } else {
            (Surface::Floor(height_m), frames)
        }
    }

    /// Brings the view up to date in an area.
    pub(super) fn refresh(&mut self, area: CellArea) {
        let size = self.view.size();
        for index in runs(area, size).flatten() {
            let (surface, frames) = self.surface(index);
            self.view.cells.values_mut()[index] = surface;
            self.view.sightings.values_mut()[index] = frames;
        }
        let sure = self.config.tuning.slopes.sure as f32;
        let (cells, view) = (&self.cells, &mut self.view);
        let height = |index: usize| {
            let known = cells.values()[index].known()?.estimate;
            (known.variance_m2 <= sure * sure).then_some(known.height_m)
        };
        let rule = (self.config.cell as f32, self.config.slope_rule());
        self.slopes
            .find((size, area), height, rule, |index, gradient| {
                view.gradients.values_mut()[index] = gradient;
            });
    }

    /// Height of the cell so many columns and rows away from one, m.
    fn height_at(&self, index: usize, [cols, rows]: [i32; 2]) -> Option<f32> {
        let cell = cell_of(index, self.view.size());
        let at = self
            .cells
            .index(Cell::new(cell.col + cols, cell.row + rows))?;
        Some(self.height(at)?.0)
    }
}
