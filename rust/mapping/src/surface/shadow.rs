//! What lies behind an obstacle is not seen: a wall rises through every height, so that a strip of it passes for a continuation
//! of whatever floor or lid borders on it, and with its height seems to lie behind the wall.

use geometry::Cell;

use crate::volume::OccupancyGrid;
use crate::{FloorView, Surface};

/// What hides floor from one frame's camera.
#[derive(Debug, Clone, Copy)]
pub struct Shadow<'a> {
    /// The camera in the map frame, m.
    pub eye_m: [f64; 3],
    /// How far behind an obstacle floor is not believed, m over the ground.
    pub reach_m: f64,
    /// The map as it was before the frame.
    pub view: &'a FloorView,
    /// Its voxels.
    pub occupancy: &'a OccupancyGrid,
}

impl Shadow<'_> {
    /// Whether the line of sight to a point of the map frame passes an obstacle shortly before it.
    pub fn holds(&self, [x_m, y_m, z_m]: [f64; 3]) -> bool {
        let back = [
            self.eye_m[0] - x_m,
            self.eye_m[1] - y_m,
            self.eye_m[2] - z_m,
        ];
        let distance_m = back[0].hypot(back[1]);
        let cell_m = self.view.lattice.cell_m;
        let cells = (self.reach_m.min(distance_m) / cell_m).round() as i32;
        (1..=cells).any(|cell| {
            let part = f64::from(cell) * cell_m / distance_m;
            let at = self
                .view
                .lattice
                .cell_at(x_m + part * back[0], y_m + part * back[1]);
            matches!(self.view.cell(at), Surface::Obstacle(_))
                && self.is_barred(at, z_m + part * back[2])
        })
    }

    /// Whether a cell is occupied at a height, or so near that a layer's width may be the reason why it is not.
    fn is_barred(&self, cell: Cell, height_m: f64) -> bool {
        let layer_m = self.occupancy.placement().layer_m;
        [-layer_m, 0.0, layer_m]
            .iter()
            .any(|above_m| self.occupancy.is_occupied_at(cell, height_m + above_m))
    }
}
