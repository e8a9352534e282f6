//! Slopes in the view: there neighbouring cells differ by their tilt, and no foot has to be lifted for that.

use mapping::FloorView;

use crate::AStarConfig;

/// Cells to each side of a slope of which the camera may have made level strips before it told them from the slope.
const STRIP_CELLS: usize = 3;

/// How the cells of a view are tilted. Reused.
#[derive(Debug, Clone, Default)]
pub(crate) struct Slopes {
    cols: usize,
    cell_m: f32,
    gradients: Vec<[f32; 2]>,
    /// Cells of slopes that may be walked on, and those beside them; empty where there is no slope.
    near: Vec<bool>,
    /// What a level strip of a slope may be off it, m.
    strip_m: f32,
    /// Steepest slope that is walked on: rise per metre.
    most: f32,
}

impl Slopes {
    /// Reads a view.
    pub(crate) fn read(&mut self, view: &FloorView, config: &AStarConfig) {
        self.cols = view.cells.cols();
        self.cell_m = view.lattice.cell_m as f32;
        self.strip_m = config.slope_step as f32;
        self.most = config.max_slope as f32;
        self.gradients.clear();
        self.near.clear();
        let gradients = view.gradients.values();
        if gradients.iter().all(|gradient| *gradient == [0.0; 2]) {
            return;
        }
        self.gradients.extend_from_slice(gradients);
        self.near.resize(gradients.len(), false);
        for (index, gradient) in gradients.iter().enumerate() {
            if *gradient != [0.0; 2] && self.too_steep_at(index).is_none() {
                self.mark_near(index);
            }
        }
    }

    fn mark_near(&mut self, index: usize) {
        let (col, row) = (index % self.cols, index / self.cols);
        let cols = col.saturating_sub(STRIP_CELLS)..(col + STRIP_CELLS + 1).min(self.cols);
        let rows = self.near.len() / self.cols;
        for row in row.saturating_sub(STRIP_CELLS)..(row + STRIP_CELLS + 1).min(rows) {
            self.near[row * self.cols..][cols.clone()].fill(true);
        }
    }

    /// Of how much higher one cell is than another what is not the ground's slope, m.
    pub(crate) fn step_m(&self, from: usize, to: usize, rise_m: f32) -> f32 {
        if self.near.is_empty() {
            return rise_m.abs();
        }
        let step_m = (rise_m - self.rise_m(from, to)).abs();
        if self.near[from] && self.near[to] && step_m <= self.strip_m {
            return 0.0;
        }
        step_m
    }

    /// The cells of slopes that are too steep to be walked on.
    pub(crate) fn too_steep(&self) -> impl Iterator<Item = usize> {
        (0..self.gradients.len()).filter(|&index| self.too_steep_at(index).is_some())
    }

    /// How steep a cell is if that is more than what is walked on: rise per metre.
    pub(crate) fn too_steep_at(&self, index: usize) -> Option<f64> {
        let [x, y] = self.gradients.get(index)?;
        let rise = x.hypot(*y);
        (rise > self.most).then_some(f64::from(rise))
    }

    /// The steepest slope that is walked on: rise per metre.
    pub(crate) fn steepest_walked(&self) -> f64 {
        f64::from(self.most)
    }

    /// How much higher one cell is than another by the tilt of both, m.
    fn rise_m(&self, from: usize, to: usize) -> f32 {
        let [a, b] = [from, to].map(|index| self.gradients[index]);
        let place = |index: usize| [(index % self.cols) as f32, (index / self.cols) as f32];
        let (from, to) = (place(from), place(to));
        let along = |axis: usize| (to[axis] - from[axis]) * 0.5 * (a[axis] + b[axis]);
        self.cell_m * (along(0) + along(1))
    }
}
