//! Heights of the ground cell by cell, fine enough for a sole.

use geometry::{Cell, Grid, Lattice};

/// How high the ground is in each cell of a window, and how sure that is.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightMap {
    /// Where its cells are.
    pub lattice: Lattice,
    /// Height, m; NaN where nothing was seen.
    heights_m: Grid<f32>,
    /// Standard deviation of the heights, m.
    sigmas_m: Grid<f32>,
}

impl HeightMap {
    /// Height of what is never stepped on though nothing stands there, m: lower than any ground.
    pub const BOTTOMLESS_M: f32 = -1e3;

    /// A map of these heights, m, NaN or infinite where nothing was seen, all as sure as this, m.
    pub fn new(lattice: Lattice, mut heights_m: Grid<f32>, sigma_m: f32) -> Self {
        for height_m in heights_m.values_mut() {
            if !height_m.is_finite() {
                *height_m = f32::NAN;
            }
        }
        let sigmas_m = Grid::filled(heights_m.cols(), heights_m.rows(), sigma_m);
        Self {
            lattice,
            heights_m,
            sigmas_m,
        }
    }

    /// Heights, m, NaN where nothing was seen.
    pub const fn heights_m(&self) -> &Grid<f32> {
        &self.heights_m
    }

    /// Standard deviations of the heights, m, of the same size.
    pub const fn sigmas_m(&self) -> &Grid<f32> {
        &self.sigmas_m
    }

    /// The height of a cell, m; `None` outside, and where nothing was seen.
    pub fn height_m(&self, cell: Cell) -> Option<f32> {
        self.heights_m
            .get(cell)
            .copied()
            .filter(|height_m| !height_m.is_nan())
    }

    /// Sets what is known of a cell: its height and the standard deviation of that, m. Outside nothing happens.
    pub fn set(&mut self, cell: Cell, height_m: f32, sigma_m: f32) {
        if let Some(index) = self.heights_m.index(cell) {
            self.heights_m.values_mut()[index] = height_m;
            self.sigmas_m.values_mut()[index] = sigma_m;
        }
    }
}
