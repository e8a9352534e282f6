//! The cells that a sole covers, by heading.

use geometry::PlanarPose;

use super::resting_plane::PlaneFit;

/// A sole: a rectangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SoleSize {
    /// Extent forward, m.
    pub length_m: f64,
    /// Extent across, m.
    pub width_m: f64,
}

impl SoleSize {
    /// From its middle to a corner, m.
    pub fn reach_m(&self) -> f64 {
        0.5 * geometry::hypot(self.length_m, self.width_m)
    }
}

/// A cell under a sole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CellUnder {
    /// Columns and rows from the cell of the sole's middle.
    pub(super) offset: [i32; 2],
    /// Where it is from the sole's middle, forward and to the left, m.
    pub(super) at_m: [f32; 2],
    /// In which strip across the sole it is, from the heel on.
    pub(super) strip: usize,
}

/// The cells under a sole that points in one direction, and those close around it.
#[derive(Debug, Clone, PartialEq)]
pub struct SoleRaster {
    pub(super) under: Vec<CellUnder>,
    pub(super) around: Vec<CellUnder>,
    /// Every second cell of its surroundings, as columns and rows from the cell of its middle.
    pub(super) beside: Vec<[i32; 2]>,
    /// The plane through all cells under it.
    pub(super) fit: PlaneFit,
    /// Cells in each strip across.
    pub(super) strips: Vec<u16>,
    /// Extent of a strip along the sole, m.
    pub(super) strip_m: f64,
    pub(super) half_length_m: f64,
    /// Farthest offset of any cell.
    pub(super) reach: i32,
}

impl SoleRaster {
    /// The cells of a lattice with cells of this size that a sole covers whose middle lies `off_m` from the centre of its cell, and those
    /// of which a side is no further than the first margin, m, beside it; its surroundings are those no further than the second.
    pub fn new(
        sole: SoleSize,
        yaw_rad: f64,
        off_m: [f64; 2],
        cell_m: f64,
        [margin_m, beside_m]: [f64; 2],
    ) -> Self {
        let [half_length_m, half_width_m] = [0.5 * sole.length_m, 0.5 * sole.width_m];
        let count = (sole.length_m / cell_m).floor().max(1.0);
        let strip_m = sole.length_m / count;
        let reach = ((sole.reach_m() + margin_m) / cell_m).ceil() as i32 + 1;
        let mut raster = Self {
            under: Vec::new(),
            around: Vec::new(),
            beside: Vec::new(),
            fit: PlaneFit::default(),
            strips: vec![0; count as usize],
            strip_m,
            half_length_m,
            reach,
        };
        let map_from_sole = PlanarPose::new(off_m[0], off_m[1], yaw_rad);
        let sole_from_map = map_from_sole.inverse();
        let farthest = reach.max(((sole.reach_m() + beside_m) / cell_m).ceil() as i32 + 1);
        for row in -farthest..=farthest {
            for col in -farthest..=farthest {
                let (along_m, across_m) =
                    sole_from_map.apply(f64::from(col) * cell_m, f64::from(row) * cell_m);
                let beyond_m = (along_m.abs() - half_length_m).max(across_m.abs() - half_width_m);
                let strip = ((along_m + half_length_m) / strip_m).clamp(0.0, count - 1.0) as usize;
                let cell = CellUnder {
                    offset: [col, row],
                    at_m: [along_m as f32, across_m as f32],
                    strip,
                };
                if beyond_m <= 0.0 {
                    raster.strips[strip] += 1;
                    raster.under.push(cell);
                } else if beyond_m - 0.5 * cell_m <= margin_m {
                    raster.around.push(cell);
                }
                if beyond_m > 0.0 && beyond_m <= beside_m && (col + row) % 2 == 0 {
                    raster.beside.push([col, row]);
                }
            }
        }
        let places_m: Vec<[f32; 2]> = raster.under.iter().map(|cell| cell.at_m).collect();
        raster.fit = PlaneFit::of(&places_m);
        raster
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_sole_covers_as_many_cells_as_its_area_has(
            yaw_rad in -4.0..4.0f64, x in -0.005..0.005f64, y in -0.005..0.005f64,
        ) {
            let sole = SoleSize { length_m: 0.105, width_m: 0.075 };
            let raster = SoleRaster::new(sole, yaw_rad, [x, y], 0.01, [0.01, 0.04]);
            let area = sole.length_m * sole.width_m / 1e-4;
            prop_assert!((raster.under.len() as f64 - area).abs() < 0.18 * area);
            let counted: usize = raster.strips.iter().map(|&cells| usize::from(cells)).sum();
            prop_assert_eq!(counted, raster.under.len());
            prop_assert!(raster.strips.iter().all(|&cells| cells > 3));
            prop_assert!(!raster.around.is_empty());
        }
    }
}
