//! The ground beside a sole: how much of it is closed to the next step.

use geometry::Cell;
use mapping::HeightMap;

use super::raster::SoleRaster;

impl SoleRaster {
    /// Which share of its surroundings no foot steps to from this height, m, with legs that climb so high, m.
    pub(super) fn closed_share(
        &self,
        map: &HeightMap,
        middle: Cell,
        [height_m, rise_m]: [f32; 2],
    ) -> f32 {
        let is_open = |&&[col, row]: &&[i32; 2]| {
            let there = Cell::new(middle.col + col, middle.row + row);
            let there_m = map.heights_m().get(there);
            there_m.is_some_and(|there_m| (there_m - height_m).abs() <= rise_m)
        };
        let open = self.beside.iter().filter(is_open).count();
        1.0 - open as f32 / self.beside.len().max(1) as f32
    }
}
