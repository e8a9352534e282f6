//! What is shown of what is known: floor, obstacle or unknown, and slopes.

use geometry::{CellArea, runs};

use super::edges::upper_surface;
use super::{Elevation, HeightEstimate, cell_of};
use crate::Surface;

impl Elevation {
    /// Height of a cell and how sure it is, and how many frames saw it: measured, filled, or that of a coarser grid.
    fn height(&self, index: usize) -> Option<(HeightEstimate, u16)> {
        if let Some(known) = self.cells.values()[index].known() {
            return Some((known.estimate, known.frames));
        }
        let filled = self.filled.values()[index];
        if !filled.height_m.is_nan() {
            let (height_m, variance_m2) = (filled.height_m, filled.variance_m2);
            let estimate = HeightEstimate {
                height_m,
                variance_m2,
            };
            return Some((estimate, filled.frames));
        }
        if self.pyramid.is_empty() {
            return None;
        }
        let centre_m = self
            .window
            .lattice()
            .center_of(cell_of(index, self.view.size()));
        let coarse = self.pyramid.at(centre_m)?;
        Some((coarse.estimate, coarse.frames))
    }

    /// What a cell counts as: an obstacle where it lies too far above one beside it.
    fn surface(&self, index: usize) -> (Surface, u16) {
        let own_m = self.heights_m[index];
        if own_m.is_nan() {
            let stood = self.underfoot.height_at(index);
            return (stood.map_or(Surface::Unknown, Surface::Floor), 0);
        }
        let size = self.view.size();
        let (col, row) = (index % size[0], index / size[0]);
        let away = |[cols, rows]: [i32; 2]| {
            let at = [col as i32 + cols, row as i32 + rows];
            let inside = (0..2).all(|axis| at[axis] >= 0 && (at[axis] as usize) < size[axis]);
            let height_m =
                inside.then(|| self.heights_m[at[1] as usize * size[0] + at[0] as usize]);
            height_m.filter(|height_m| !height_m.is_nan())
        };
        let height_m = upper_surface(own_m, away, self.config.edge_rule()).unwrap_or(own_m);
        let estimate = |index: usize, height_m: f32| {
            HeightEstimate::with_sigma(height_m, self.view.sigmas_m.values()[index])
        };
        let beside = CellArea::of(cell_of(index, size)).grown(1);
        let (own, rule) = (estimate(index, height_m), self.config.rise_rule());
        let mut beside = runs(beside, size).flatten();
        if beside.any(|other| rule.is_above(own, estimate(other, self.heights_m[other]))) {
            (Surface::Obstacle(height_m), 0)
        } else {
            (Surface::Floor(height_m), self.seen[index])
        }
    }

    /// Brings the view up to date in an area.
    pub(super) fn refresh(&mut self, area: CellArea) {
        let size = self.view.size();
        self.heights_m.resize(size[0] * size[1], f32::NAN);
        self.seen.resize(size[0] * size[1], 0);
        let reach = (1 + self.config.edge_rule().reach).max(2);
        for index in runs(area.grown(reach), size).flatten() {
            let known = self.height(index);
            let (height_m, sigma_m, frames) = known
                .map_or((f32::NAN, 0.0, 0), |(known, frames)| {
                    (known.height_m, known.variance_m2.sqrt(), frames)
                });
            (self.heights_m[index], self.seen[index]) = (height_m, frames);
            self.view.sigmas_m.values_mut()[index] = sigma_m;
        }
        let rule = (Some(self.config.edge_rule()), self.config.rise as f32);
        let mut level_cells = std::mem::take(&mut self.level);
        for run in runs(area, size) {
            let level = level_cells.of_run(&self.heights_m, size, run.clone(), rule);
            for (index, &level) in run.zip(level) {
                let (surface, frames) = if level {
                    (Surface::Floor(self.heights_m[index]), self.seen[index])
                } else {
                    self.surface(index)
                };
                self.view.cells.values_mut()[index] = surface;
                self.view.sightings.values_mut()[index] = frames;
            }
        }
        self.level = level_cells;
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
}
