//! The ground under soles that stand.

use geometry::{Cell, CellArea, PlanarPose};

use super::{GroundMap, SoleOnGround};

impl GroundMap {
    /// Under a sole that stands there is ground where nothing else is known: as high as the map has it where that is about where the foot is, else
    /// as high as the foot.
    pub fn stand_on(&mut self, sole: &SoleOnGround) {
        let lattice = self.map.lattice;
        let around_m = sole.half_m.map(|half_m| half_m + lattice.cell_m);
        let reach_m = geometry::hypot(around_m[0], around_m[1]);
        let PlanarPose { x_m, y_m, .. } = sole.pose;
        let area = CellArea {
            min: lattice.cell_at(x_m - reach_m, y_m - reach_m),
            max: lattice.cell_at(x_m + reach_m, y_m + reach_m),
        };
        let from_map = sole.pose.inverse();
        let on_sole_m = |cell: Cell| {
            let [x_m, y_m] = lattice.center_of(cell);
            from_map.apply(x_m, y_m)
        };
        let within = |cell: Cell, half_m: [f64; 2]| {
            let (ahead_m, left_m) = on_sole_m(cell);
            ahead_m.abs() <= half_m[0] && left_m.abs() <= half_m[1]
        };
        // How much higher than the sole's middle it is there.
        let tilted_m = |cell: Cell| {
            let (ahead_m, left_m) = on_sole_m(cell);
            sole.slope[0] * ahead_m as f32 + sole.slope[1] * left_m as f32
        };
        let as_felt = |cell: Cell, height_m: f32| {
            let off_m = height_m - tilted_m(cell) - sole.height_m;
            f64::from(off_m.abs()) <= self.config.blended
        };
        let under = area.cells().filter(|&cell| within(cell, sole.half_m));
        let seen = under.filter_map(|cell| Some((cell, self.map.height_m(cell)?)));
        let seen = seen.filter(|&(cell, height_m)| as_felt(cell, height_m));
        let middles_m = seen.map(|(cell, height_m)| height_m - tilted_m(cell));
        let middle_m = median(middles_m.collect()).unwrap_or(sole.height_m);
        let sigma_m = self.config.sigma as f32;
        let middle = lattice.cell_at(x_m, y_m);
        for cell in area.cells().filter(|&cell| within(cell, around_m)) {
            // A part that is known to hang over lower ground goes on to do so.
            let hangs = match (self.map.height_m(cell), self.map.blurred_m(cell)) {
                (Some(known_m), _) => !within(cell, sole.half_m) || !as_felt(cell, known_m),
                (None, Some(about_m)) => !as_felt(cell, about_m),
                (None, None) => false,
            };
            if !hangs || cell == middle {
                self.map.set(cell, middle_m + tilted_m(cell), sigma_m);
            }
        }
    }
}

/// The middle one of some heights, m.
fn median(mut heights_m: Vec<f32>) -> Option<f32> {
    heights_m.sort_by(f32::total_cmp);
    heights_m.get(heights_m.len() / 2).copied()
}
