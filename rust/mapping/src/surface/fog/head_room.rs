//! The room above the floors of the grid: how much of it there is, whether the robot passes, and what was seen of it.

use geometry::{Cell, CellArea, Map, Pose, Robot};
use segmentation::Planes;

use super::Fog;
use crate::surface::overhead::Heights;
use crate::{HeadRoom, Surface};

/// Heights that differ by less are the same, m: a rounding guard.
const ROUNDING_M: f64 = 1e-6;

impl Fog {
    /// Room above a cell's floor, or the one beside it, m, as far as it matters: to the lowest layer that something is in, and within
    /// that layer to where points were seen. `None` where nothing is above it, or no floor is known.
    fn room_m(&self, cell: Cell, headroom_m: f64) -> Option<f64> {
        let floor_m = f64::from(self.floor_near(cell)?);
        let layer_m = self.config.layer;
        let above_m = floor_m + self.config.delta;
        let bottom_m = self.occupancy.lowest_above_m(cell, above_m)? - 0.5 * layer_m;
        let needed_m = floor_m + headroom_m;
        let index = self.view.cells.index(cell)?;
        let is_in_doubt = bottom_m < needed_m && needed_m <= bottom_m + layer_m + ROUNDING_M;
        let seen_m = self.overhead.lowest_m(index).filter(|_| is_in_doubt);
        let seen_m = seen_m.map(|seen_m| seen_m.clamp(bottom_m, bottom_m + 2.0 * layer_m));
        Some(seen_m.unwrap_or(bottom_m) - floor_m)
    }

    /// Height of a cell's floor, m, or else of the one beside it: what hangs above a floor hangs on above a cell in which it was not
    /// seen.
    fn floor_near(&self, cell: Cell) -> Option<f32> {
        (self.floor.height(cell)).or_else(|| self.floor_beside(cell))
    }

    /// Whether all that is above a cell's floor begins so high that the robot passes under it.
    pub(super) fn is_passed_under(&self, cell: Cell) -> bool {
        let Some(headroom_m) = self.config.headroom else {
            return false;
        };
        let room_m = self.room_m(cell, headroom_m);
        room_m.is_some_and(|room_m| room_m + ROUNDING_M >= headroom_m)
    }

    /// What is known of the room above the floor of the cell that is stored at an index, which shows this surface.
    pub(super) fn head_at(&self, index: usize, surface: Surface) -> HeadRoom {
        let Some(headroom_m) = self.config.headroom else {
            return HeadRoom::Free;
        };
        match surface {
            Surface::Unknown => HeadRoom::Free,
            Surface::Floor(floor_m) => {
                let heights = self.heights();
                if self
                    .overhead
                    .is_seen(index, &heights, f64::from(floor_m), headroom_m)
                {
                    HeadRoom::Free
                } else {
                    HeadRoom::Unseen
                }
            }
            Surface::Obstacle(_) => {
                let cols = self.view.cells.cols();
                let cell = Cell::new((index % cols) as i32, (index / cols) as i32);
                let hangs_m = self.config.tuning.overhead.hangs * headroom_m;
                let floor = self.floor_near(cell);
                let room_m = if floor.is_some() {
                    self.room_m(cell, headroom_m)
                } else {
                    let above_m = self.level_m + self.config.delta;
                    let lowest_m = self.occupancy.lowest_above_m(cell, above_m);
                    lowest_m.map(|lowest_m| lowest_m - 0.5 * self.config.layer - self.level_m)
                };
                match room_m {
                    Some(room_m)
                        if room_m >= hangs_m && self.is_looked_under(cell, index, headroom_m) =>
                    {
                        let base_m = floor.map_or(self.level_m, f64::from);
                        let seen_m = self.overhead.lowest_m(index).map(|at_m| at_m - base_m);
                        // Within the layer, for who is told how much there is.
                        let told_m = seen_m.map_or(room_m, |seen_m| {
                            seen_m.clamp(room_m, room_m + self.config.layer)
                        });
                        HeadRoom::Low {
                            floor_m: floor.unwrap_or(f32::NAN),
                            room_m: told_m.min(headroom_m) as f32,
                        }
                    }
                    _ => HeadRoom::Free,
                }
            }
        }
    }

    /// Whether the lowest of what is above a cell's floor, or the robot's own, was looked under: what stands on the floor may be known
    /// from its upper part alone.
    fn is_looked_under(&self, cell: Cell, index: usize, headroom_m: f64) -> bool {
        let floor_m = self.floor_near(cell).map_or(self.level_m, f64::from);
        let above_m = floor_m + self.config.delta;
        let Some(lowest_m) = self.occupancy.lowest_above_m(cell, above_m) else {
            return false;
        };
        let begins_m = lowest_m - 0.5 * self.config.layer;
        let (heights, room) = (self.heights(), (floor_m, headroom_m));
        (self.overhead).is_looked_under(index, &heights, room, begins_m)
    }

    /// The layers as heights.
    pub(super) fn heights(&self) -> Heights {
        Heights {
            bottom_m: self.layers.bottom_m(),
            layer_m: self.config.layer,
            layers: self.config.layers,
        }
    }

    /// Takes in what the frame that was taken in shows above the floors; the cells that this touched.
    pub(super) fn look_overhead(
        &mut self,
        planes: &Planes,
        map_from_robot: &Pose<Map, Robot>,
    ) -> CellArea {
        let Some(headroom_m) = self.config.headroom else {
            return CellArea::EMPTY;
        };
        let heights = self.heights();
        let hangs_m = self.config.tuning.overhead.hangs * headroom_m;
        self.overhead
            .note_points(&self.frame, self.level_m + hangs_m);
        let (floor, underfoot) = (&self.floor, &self.underfoot);
        let floor_at = |index| (floor.height_at(index)).or_else(|| underfoot.height_at(index));
        self.overhead.look(
            (planes, &self.frame),
            map_from_robot,
            (&self.view.lattice, &heights, headroom_m),
            floor_at,
        )
    }
}
