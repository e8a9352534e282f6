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
    /// As the heights, but where levels meet, nobody knows just where: there about how high it is, m.
    tops_m: Grid<f32>,
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
            tops_m: heights_m.clone(),
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

    /// How high what is there reaches, m: also where levels meet, nobody knows just where, and so no height is known. NaN where nothing was seen.
    pub const fn tops_m(&self) -> &Grid<f32> {
        &self.tops_m
    }

    /// About how high it is in a cell in which levels meet, nobody knows just where, m: nothing stands there, though it was seen.
    pub fn blurred_m(&self, cell: Cell) -> Option<f32> {
        let about_m = self.tops_m.get(cell).copied();
        about_m.filter(|about_m| !about_m.is_nan() && self.height_m(cell).is_none())
    }

    /// Says that levels meet in a cell, about so high, m, nobody knows just where. Outside nothing happens.
    pub fn set_blurred(&mut self, cell: Cell, about_m: f32) {
        if let Some(index) = self.heights_m.index(cell) {
            self.heights_m.values_mut()[index] = f32::NAN;
            self.tops_m.values_mut()[index] = about_m;
        }
    }

    /// Sets what is known of a cell: its height and the standard deviation of that, m. Outside nothing happens.
    pub fn set(&mut self, cell: Cell, height_m: f32, sigma_m: f32) {
        if let Some(index) = self.heights_m.index(cell) {
            self.heights_m.values_mut()[index] = height_m;
            self.tops_m.values_mut()[index] = height_m;
            self.sigmas_m.values_mut()[index] = sigma_m;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_blurred_cell_has_a_top_and_no_height_until_that_is_known() {
        let lattice = Lattice {
            origin_m: [0.0; 2],
            cell_m: 0.01,
        };
        let mut map = HeightMap::new(lattice, Grid::filled(3, 2, f32::INFINITY), 0.003);
        let cell = Cell::new(1, 1);
        assert_eq!((map.height_m(cell), map.blurred_m(cell)), (None, None));
        map.set_blurred(cell, 0.04);
        assert_eq!(
            (map.height_m(cell), map.blurred_m(cell)),
            (None, Some(0.04))
        );
        assert_eq!(map.tops_m().get(cell), Some(&0.04));
        map.set(cell, 0.03, 0.0);
        assert_eq!(
            (map.height_m(cell), map.blurred_m(cell)),
            (Some(0.03), None)
        );
        map.set_blurred(Cell::new(9, 9), 1.0);
        assert_eq!(map.blurred_m(Cell::new(9, 9)), None);
    }
}
