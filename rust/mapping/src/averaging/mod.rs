//! Averaging: the map that 000, sections II and V, compares itself with, after Kagami et al. 2003.
//!
//! A 2.5D map whose cells hold the mean height of all points that fell into them. Nothing is known of what a ray passed, so
//! that nothing is taken back: what was removed fades only where something else is seen in its place, and what moves
//! leaves heights in between. The map does not tell floors from obstacles; where a foot can be placed is decided
//! afterwards from the heights of neighbouring cells (Chestnutt et al. 2003, reference 1 of 000).
//!
//! Window, frames, fitting them in height, and the ground underfoot are those of [`crate::Fog`]. Points beside the edges of
//! steps are left out here, too, which is to this map's advantage. Points are not moved onto planes: the method knows none.

mod config;
mod means;

use crate::part::WorldModelPart;
use geometry::{Cell, CellArea, Map, Pose, Robot};
use segmentation::Planes;
use settings::{ConfigError, Table};
use settings::{Part, TableDescription, read};

use crate::surface::{
    LabelledFrame, LabelledPoint, Pair, Reading, Underfoot, Window, check_poses, height_shift,
};
use crate::{FloorView, Insertion, MapError, Surface, WorldModel};
pub use config::{AveragingConfig, AveragingTuning};
use means::MeanHeights;

/// How it is listed and made.
pub(crate) const PART: WorldModelPart = Part {
    name: "averaging",
    about: "mean height of each cell's points; what fog is compared with",
    source: Some("Kagami et al. 2003 (000, sections II and V)"),
    tables: &[TableDescription::of::<AveragingConfig>()],
    make: |needs| Ok(Box::new(Averaging::new(read(needs.tables, "averaging")?)?)),
};

/// Keeps the mean height of each cell and the view made of them.
#[derive(Debug, Clone)]
pub struct Averaging {
    config: AveragingConfig,
    window: Window,
    means: MeanHeights,
    underfoot: Underfoot,
    view: FloorView,
    frame: LabelledFrame,
    pairs: Vec<Pair>,
}

impl Averaging {
    /// The name by which it is chosen.
    pub const NAME: &'static str = "averaging";

    /// A map of which nothing is known, around the map's origin.
    pub fn new(config: AveragingConfig) -> Result<Self, ConfigError> {
        config.check()?;
        let window = Window::new(config.cell, config.cells, config.tuning.wander);
        Ok(Self {
            means: MeanHeights::new(config.cells),
            underfoot: Underfoot::new(config.cells, config.footprint),
            view: FloorView::unknown(window.lattice(), config.cells),
            frame: LabelledFrame::default(),
            pairs: Vec::new(),
            window,
            config,
        })
    }

    /// What a cell counts as: an obstacle where it lies too far above one beside it.
    fn surface(&self, cell: Cell) -> Surface {
        let Some(height_m) = self.means.height(cell) else {
            return self
                .underfoot
                .height(cell)
                .map_or(Surface::Unknown, Surface::Floor);
        };
        let lowest_m = self
            .with_neighbours(cell, cell)
            .cells()
            .filter_map(|beside| self.means.height(beside))
            .fold(height_m, f64::min);
        if height_m - lowest_m > self.config.rise {
            Surface::Obstacle(height_m as f32)
        } else {
            Surface::Floor(height_m as f32)
        }
    }

    /// The cells between two corners and those beside them, as far as they are in the window.
    fn with_neighbours(&self, min: Cell, max: Cell) -> CellArea {
        let all = self.view.cells.area();
        CellArea {
            min: Cell::new(all.min.col.max(min.col - 1), all.min.row.max(min.row - 1)),
            max: Cell::new(all.max.col.min(max.col + 1), all.max.row.min(max.row + 1)),
        }
    }

    /// Moves the window to the robot; the cells of the view that this may have changed.
    fn follow(&mut self, robot_m: [f64; 3]) -> CellArea {
        let [cols, rows] = self.window.follow(robot_m);
        if [cols, rows] == [0; 2] {
            return CellArea::EMPTY;
        }
        self.means.shift(cols, rows);
        self.underfoot.shift(cols, rows);
        self.view.shift(cols, rows, self.window.lattice());
        self.view.cells.area()
    }

    /// Adds the frame's points to the means; the cells that they fell into.
    fn add_points(&mut self) -> CellArea {
        let mut touched = CellArea::EMPTY;
        self.means.start_frame();
        for point in self.frame.points.iter().filter(|point| point.hit) {
            let [x, y, z] = point.position_m;
            let cell = self.view.lattice.cell_at(x, y);
            if self.means.add(cell, z) {
                touched.include(cell);
            }
        }
        touched
    }

    /// Brings the view up to date in an area.
    fn refresh(&mut self, area: CellArea) {
        for cell in area.cells() {
            let surface = self.surface(cell);
            let seen = match surface {
                Surface::Floor(_) => self.means.frames(cell),
                Surface::Obstacle(_) | Surface::Unknown => 0,
            };
            self.view.set(cell, surface, seen);
        }
    }
}

impl WorldModel for Averaging {
    fn forget(&mut self) {
        if let Ok(fresh) = Self::new(self.config.clone()) {
            *self = fresh;
        }
    }

    fn insert(
        &mut self,
        planes: &Planes,
        map_from_robot: &Pose<Map, Robot>,
    ) -> Result<Insertion, MapError> {
        check_poses(planes, map_from_robot)?;
        let at = map_from_robot.inner.translation.vector;
        let robot_m = [at.x, at.y, at.z];
        let mut changed = self.follow(robot_m);
        changed.join(self.underfoot.stand(robot_m, &self.view.lattice));

        let config = &self.config;
        let reading = Reading {
            snap_stretch: None,
            max_range_m: config.max_range,
            sure_range_m: f64::INFINITY,
            delta_m: 0.0,
            rough: f32::INFINITY,
        };
        self.frame.read(planes, map_from_robot, reading);
        let mut pairs = std::mem::take(&mut self.pairs);
        let pair = |point: &LabelledPoint| {
            let [x, y, z] = point.position_m;
            let known_m = self.means.height(self.view.lattice.cell_at(x, y))?;
            let residual_m = known_m - z;
            point.hit.then_some(Pair {
                residual_m,
                weight: 1,
            })
        };
        let shift = height_shift(
            self.frame.points.iter().filter_map(pair),
            (config.match_gate, config.min_pairs),
            &config.tuning.matching,
            &mut pairs,
        );
        self.pairs = pairs;
        let used = planes.reliable || shift.is_some();
        if used {
            self.frame.raise(shift.unwrap_or(0.0));
            let touched = self.add_points();
            if !touched.is_empty() {
                changed.join(self.with_neighbours(touched.min, touched.max));
            }
        }
        self.refresh(changed);
        Ok(Insertion {
            changed,
            height_shift_m: shift.filter(|_| used),
            used,
        })
    }

    fn view(&self) -> &FloorView {
        &self.view
    }

    fn needs_surfaces(&self) -> bool {
        false
    }
}
