//! Voxels of places, many at a time.

use geometry::Lattice;

use super::placement::{Placement, Size};

/// Nearer to a border than this, in voxels, a product with one over the voxel's size does not tell on which side of it a place is.
const AT_BORDER: f64 = 1e-9;
/// Added to a number far below it, it leaves no room for a fraction: the sum is rounded, and its lowest bits are the whole number.
pub(super) const NO_FRACTION: f64 = 6_755_399_441_055_744.0;

/// Finds the voxels of places, or their cells, without a division, but for places at borders: the same as by
/// [`Placement::in_voxels`] and [`Lattice::cell_at`].
#[derive(Debug, Clone, Copy)]
pub struct Locator<const AXES: usize> {
    corner_m: [f64; AXES],
    side_m: [f64; AXES],
    per_voxel: [f64; AXES],
    size: [f64; AXES],
    middle: [f64; AXES],
}

impl Locator<3> {
    /// A locator of voxels.
    pub(super) fn of_voxels(placement: &Placement, size: Size) -> Self {
        let Placement {
            lattice,
            bottom_m,
            layer_m,
        } = *placement;
        let [x_m, y_m] = lattice.origin_m;
        let side_m = [lattice.cell_m, lattice.cell_m, layer_m];
        Self::new([x_m, y_m, bottom_m], side_m, size.voxels())
    }
}

impl Locator<2> {
    /// A locator of the cells of a grid with so many columns and rows.
    pub fn of_cells(lattice: &Lattice, [cols, rows]: [usize; 2]) -> Self {
        let size = [cols, rows].map(|n| n as i32);
        Self::new(lattice.origin_m, [lattice.cell_m; 2], size)
    }

    /// Where a place's cell is stored, row by row; none outside of the grid.
    #[inline]
    pub fn index_at(&self, at_m: [f64; 2]) -> Option<usize> {
        let [col, row] = self.voxel_at(at_m)?;
        Some(row as usize * self.size[0] as usize + col as usize)
    }
}

impl<const AXES: usize> Locator<AXES> {
    fn new(corner_m: [f64; AXES], side_m: [f64; AXES], size: [i32; AXES]) -> Self {
        let size = size.map(f64::from);
        Self {
            corner_m,
            side_m,
            per_voxel: side_m.map(|side_m| 1.0 / side_m),
            middle: size.map(|size| 0.5 * size),
            size,
        }
    }

    /// Column, row and layer of a place; none outside of the grid.
    #[inline]
    pub(super) fn voxel_at(&self, at_m: [f64; AXES]) -> Option<[i32; AXES]> {
        let at: [f64; AXES] =
            std::array::from_fn(|a| (at_m[a] - self.corner_m[a]) * self.per_voxel[a]);
        let near = |a: usize| (at[a] - self.middle[a]).abs() < self.middle[a] + AT_BORDER;
        if !all::<AXES>(near) {
            return None;
        }
        // What is nearest half a voxel below is what is below. A cast to an integer takes several times as long.
        let below: [f64; AXES] = at.map(|at| at - 0.5 + NO_FRACTION);
        let clear = |a: usize| (at[a] - 0.5 - (below[a] - NO_FRACTION)).abs() < 0.5 - AT_BORDER;
        if all::<AXES>(clear) {
            return Some(below.map(|below| below.to_bits() as i32));
        }
        let at: [f64; AXES] =
            std::array::from_fn(|a| (at_m[a] - self.corner_m[a]) / self.side_m[a]);
        let within = (0..AXES).all(|a| at[a] >= 0.0 && at[a] < self.size[a]);
        within.then(|| at.map(|at| at as i32))
    }
}

/// Whether it holds of all axes; no branch for each of them.
#[inline]
fn all<const AXES: usize>(holds: impl Fn(usize) -> bool) -> bool {
    (0..AXES).fold(true, |all, axis| all & holds(axis))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const SIZE: Size = Size {
        cols: 50,
        rows: 40,
        layers: 24,
    };

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]
        #[test]
        fn a_place_is_in_the_voxel_that_divisions_find(
            corner_m in prop::array::uniform3(-3.0..3.0_f64),
            side_m in prop_oneof![Just(0.04), Just(0.1), 0.01..0.2_f64],
            voxels in prop::array::uniform3(-2_i32..60),
            off in prop::array::uniform3(prop_oneof![
                2 => Just(0.0),
                1 => Just(1e-16),
                1 => Just(-1e-12),
                1 => 0.0..1.0_f64,
            ]),
        ) {
            let placement = Placement {
                lattice: Lattice { origin_m: [corner_m[0], corner_m[1]], cell_m: side_m },
                bottom_m: corner_m[2],
                layer_m: side_m,
            };
            let at_m = std::array::from_fn(|a| corner_m[a] + (f64::from(voxels[a]) + off[a]) * side_m);
            let at = placement.in_voxels(at_m);
            let size = SIZE.voxels();
            let within = (0..3).all(|a| at[a] >= 0.0 && at[a] < f64::from(size[a]));
            let wanted = within.then(|| at.map(|at| at as i32));
            prop_assert_eq!(Locator::of_voxels(&placement, SIZE).voxel_at(at_m), wanted);
            let [x_m, y_m, _] = at_m;
            let cells = geometry::Grid::filled(SIZE.cols, SIZE.rows, ());
            let locator = Locator::of_cells(&placement.lattice, [SIZE.cols, SIZE.rows]);
            prop_assert_eq!(locator.index_at([x_m, y_m]), cells.index(placement.lattice.cell_at(x_m, y_m)));
        }
    }
}
