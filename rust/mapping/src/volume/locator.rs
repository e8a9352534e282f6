//! Voxels of places, many at a time.

use super::occupancy::{Placement, Size};

/// Nearer to a border than this, in voxels, a product with one over the voxel's size does not tell on which side of it a place is.
const AT_BORDER: f64 = 1e-9;
/// Added to a number far below it, it leaves no room for a fraction: the sum is rounded, and its lowest bits are the whole number.
const NO_FRACTION: f64 = 6_755_399_441_055_744.0;

/// Finds the voxels of places without a division, but for places at borders: the same voxels as by [`Placement::in_voxels`].
#[derive(Debug, Clone, Copy)]
pub(super) struct Locator<'a> {
    placement: &'a Placement,
    corner_m: [f64; 3],
    per_voxel: [f64; 3],
    size: [f64; 3],
}

impl<'a> Locator<'a> {
    pub(super) fn new(placement: &'a Placement, size: Size) -> Self {
        let Placement {
            lattice,
            bottom_m,
            layer_m,
        } = *placement;
        Self {
            corner_m: [lattice.origin_m[0], lattice.origin_m[1], bottom_m],
            per_voxel: [lattice.cell_m, lattice.cell_m, layer_m].map(|side_m| 1.0 / side_m),
            size: size.voxels().map(f64::from),
            placement,
        }
    }

    /// Column, row and layer of a place; none outside of the grid.
    #[inline]
    pub(super) fn voxel_at(&self, at_m: [f64; 3]) -> Option<[i32; 3]> {
        let scaled = |a: usize| (at_m[a] - self.corner_m[a]) * self.per_voxel[a];
        let at = [scaled(0), scaled(1), scaled(2)];
        let near = |a: usize| at[a] > -AT_BORDER && at[a] < self.size[a] + AT_BORDER;
        if !(near(0) && near(1) && near(2)) {
            return None;
        }
        // What is nearest half a voxel below is what is below. A cast to an integer takes several times as long.
        let below = |a: usize| at[a] - 0.5 + NO_FRACTION;
        let clear = |a: usize| (at[a] - 0.5 - (below(a) - NO_FRACTION)).abs() < 0.5 - AT_BORDER;
        if clear(0) & clear(1) & clear(2) {
            let whole = |a: usize| below(a).to_bits() as i32;
            return Some([whole(0), whole(1), whole(2)]);
        }
        let at = self.placement.in_voxels(at_m);
        let within = (0..3).all(|a| at[a] >= 0.0 && at[a] < self.size[a]);
        within.then(|| at.map(|at| at as i32))
    }
}

#[cfg(test)]
mod tests {
    use geometry::Lattice;
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
            prop_assert_eq!(Locator::new(&placement, SIZE).voxel_at(at_m), wanted);
        }
    }
}
