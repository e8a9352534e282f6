//! What is above each cell's floor, up to the robot's head: where lines of sight went through, and where what hangs begins.
//!
//! The occupancy grid knows what was met, by layers. It does not know what was looked through, where a line of sight ends at nothing
//! that the camera can measure, and a layer is coarser than the room that decides whether the robot fits.

use geometry::{Cell, CellArea, Grid, Lattice, Map, Pose, Robot};
use segmentation::Planes;
use settings::{NOT_NEGATIVE, POSITIVE, above_to, settings, within};

mod in_view;

use in_view::InView;

use super::LabelledFrame;

settings! {
    /// What is above the floor, up to the robot's head.
    pub struct OverheadTuning("navigation.fog.tuning.overhead") {
        /// What hangs begins above this share of the room that the robot needs; what is lower stands there, and is seen as the robot
        /// looks at the floor.
        hangs: f64 = 0.5, "1", above_to(0.0, 1.0);
        /// From this share of the room on it is kept where lines of sight went through: what hangs was looked under there.
        under: f64 = 0.3, "1", above_to(0.0, 1.0);
        /// A line of sight that ends at nothing is free up to this distance: things nearer show in the camera's picture.
        empty_range: f64 = 2.0, "m" of camera, POSITIVE;
        /// Nearer than this the camera sees nothing, so that an empty picture tells nothing.
        blind_range: f64 = 0.3, "m" of camera, NOT_NEGATIVE;
        /// So many pixels around one without depth must be without depth or deeper before the way there counts as free.
        beside: usize = 1, "1", within(0.0, 8.0);
        /// Weight of a frame's lowest point of what hangs above a cell, beside those of the frames before.
        newer: f32 = 0.2, "1", above_to(0.0, 1.0);
    }
}

/// What was seen above the floors. Bits are layers of the occupancy grid.
#[derive(Debug, Clone)]
pub(super) struct Overhead {
    /// Layers of each cell in which lines of sight went through the middle.
    through: Grid<u64>,
    /// Height of the lowest points above each cell, m; NaN where there was none.
    lowest_m: Grid<f32>,
    /// Of the frame that is read.
    frame_lowest_m: Vec<(u32, f32)>,
    config: OverheadTuning,
}

/// Layers of the occupancy grid as heights.
#[derive(Debug, Clone, Copy)]
pub(super) struct Heights {
    pub(super) bottom_m: f64,
    pub(super) layer_m: f64,
    pub(super) layers: usize,
}

impl Heights {
    /// The layers whose middles lie between two heights, a bit each.
    fn between(&self, low_m: f64, high_m: f64) -> u64 {
        let first = ((low_m - self.bottom_m) / self.layer_m - 0.5)
            .ceil()
            .max(0.0) as u64;
        let end = ((high_m - self.bottom_m) / self.layer_m - 0.5).ceil();
        let end = end.clamp(0.0, self.layers as f64) as u64;
        let below = |bits: u64| u64::MAX.checked_shr(64 - bits as u32).unwrap_or(0);
        if first >= end {
            0
        } else {
            below(end) & !below(first)
        }
    }

    fn middle_m(&self, layer: u32) -> f64 {
        self.bottom_m + (f64::from(layer) + 0.5) * self.layer_m
    }
}

impl Overhead {
    pub(super) fn new(cells: usize, config: OverheadTuning) -> Self {
        Self {
            through: Grid::filled(cells, cells, 0),
            lowest_m: Grid::filled(cells, cells, f32::NAN),
            frame_lowest_m: Vec::new(),
            config,
        }
    }

    /// Moves the window by whole cells and layers.
    pub(super) fn shift(&mut self, cols: i32, rows: i32, layers: i32) {
        self.through.shift(cols, rows, &0);
        self.lowest_m.shift(cols, rows, &f32::NAN);
        if layers == 0 {
            return;
        }
        let by = layers.unsigned_abs();
        for through in self.through.values_mut() {
            let moved = if layers > 0 {
                through.checked_shr(by)
            } else {
                through.checked_shl(by)
            };
            *through = moved.unwrap_or(0);
        }
    }

    /// The layers between where things may hang above a floor and the robot's head.
    fn band(&self, heights: &Heights, floor_m: f64, headroom_m: f64) -> u64 {
        heights.between(
            floor_m + self.config.hangs * headroom_m,
            floor_m + headroom_m,
        )
    }

    /// Whether all of the room above a floor that the robot's head needs was looked through.
    pub(super) fn is_seen(
        &self,
        index: usize,
        heights: &Heights,
        floor_m: f64,
        headroom_m: f64,
    ) -> bool {
        let band = self.band(heights, floor_m, headroom_m);
        band & !self.through.values()[index] == 0
    }

    /// Whether a line of sight went through between a floor and what begins above it at a height, m.
    pub(super) fn is_looked_under(
        &self,
        index: usize,
        heights: &Heights,
        (floor_m, headroom_m): (f64, f64),
        begins_m: f64,
    ) -> bool {
        let under = heights.between(floor_m + self.config.under * headroom_m, begins_m);
        under & self.through.values()[index] != 0
    }

    /// The robot stands here: up to its head nothing else does.
    pub(super) fn stand(
        &mut self,
        area: CellArea,
        heights: &Heights,
        floor_m: f64,
        headroom_m: f64,
    ) {
        let band = self.band(heights, floor_m, headroom_m);
        for cell in area.cells() {
            if let Some(through) = self.through.get_mut(cell) {
                *through |= band;
            }
        }
    }

    /// Where what hangs above a cell begins, m, where that was seen.
    pub(super) fn lowest_m(&self, index: usize) -> Option<f64> {
        let lowest_m = self.lowest_m.values()[index];
        (!lowest_m.is_nan()).then(|| f64::from(lowest_m))
    }

    /// Takes in where the points of a frame that belong to no floor hang, above `above_m`.
    pub(super) fn note_points(&mut self, frame: &LabelledFrame, above_m: f64) {
        let lowest = &mut self.frame_lowest_m;
        lowest.clear();
        let hanging = frame.located().filter_map(|(point, cell)| {
            let height_m = point.position_m[2];
            let hangs = point.hit && point.floor_height_m.is_nan() && height_m > above_m;
            Some((cell.filter(|_| hangs)? as u32, height_m as f32))
        });
        lowest.extend(hanging);
        lowest.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        lowest.dedup_by_key(|(cell, _)| *cell);
        for &(cell, height_m) in lowest.iter() {
            let known_m = &mut self.lowest_m.values_mut()[cell as usize];
            if known_m.is_nan() {
                *known_m = height_m;
            } else {
                *known_m += self.config.newer * (height_m - *known_m);
            }
        }
    }

    /// Takes in what a frame that is a picture looks through, above floors as `floor_at` says; the cells that it changed.
    pub(super) fn look(
        &mut self,
        (planes, frame): (&Planes, &LabelledFrame),
        map_from_robot: &Pose<Map, Robot>,
        (lattice, heights, headroom_m): (&Lattice, &Heights, f64),
        floor_at: impl Fn(usize) -> Option<f32>,
    ) -> CellArea {
        let mut changed = CellArea::EMPTY;
        let Some(picture) = frame.picture else {
            return changed;
        };
        let [width, height] = picture.size_px;
        if width * height != planes.points_in_robot_m.len() || width * height == 0 {
            return changed;
        }
        let camera = planes.robot_from_camera.inner;
        let axis = camera.rotation * nalgebra::Vector3::z();
        let eye = InView {
            planes,
            picture,
            eye_m: frame.eye_m,
            robot_eye_m: camera.translation.vector.into(),
            robot_axis: axis.into(),
        };
        let level_m = map_from_robot.origin().inner.z;
        let reach_m = self.config.empty_range;
        let [eye_x, eye_y, eye_z] = frame.eye_m;
        let window = CellArea {
            min: lattice.cell_at(eye_x - reach_m, eye_y - reach_m),
            max: lattice.cell_at(eye_x + reach_m, eye_y + reach_m),
        };
        let half_cell_m = 0.5 * lattice.cell_m;
        let size = [self.through.cols(), self.through.rows()];
        for cell in window.within(self.through.area()).cells() {
            let index = cell.row as usize * size[0] + cell.col as usize;
            let floor_m = floor_at(index).map_or(level_m, f64::from);
            let (from_m, to_m) = (
                floor_m + self.config.under * headroom_m,
                floor_m + headroom_m,
            );
            let mut wanted = heights.between(from_m, to_m) & !self.through.values()[index];
            let column = eye.column(lattice.center_of(cell));
            let mut seen = 0;
            if wanted != 0 {
                let lowest_m = heights.middle_m(wanted.trailing_zeros());
                let highest_m = heights.middle_m(wanted.ilog2());
                let reach_m = (lowest_m - eye_z).abs().max((highest_m - eye_z).abs());
                if !eye.may_see(&column, reach_m, &self.config) {
                    continue;
                }
            }
            while wanted != 0 {
                let layer = wanted.trailing_zeros();
                wanted &= wanted - 1;
                let height_m = heights.middle_m(layer);
                if eye.goes_through(&column, height_m, half_cell_m, &self.config) {
                    seen |= 1 << layer;
                }
            }
            if seen != 0 {
                self.through.values_mut()[index] |= seen;
                changed.include(Cell::new(cell.col, cell.row));
            }
        }
        changed
    }
}

#[cfg(test)]
mod tests;
