//! Elevation: a height a cell, as the handbook's section 36.3.1 has it (004), kept by a Kalman filter.
//!
//! One measurement a cell and frame is fused ([`HeightEstimate`], equations 36.17 and 36.18), the less sure the further away it was
//! seen ([`RangeNoise`], Fig. 36.10). What a step's edge runs through has the height of what is above, never one in between
//! ([`Gathered`]). Sight lines take back what they pass below, and bound the ground where nothing was seen ([`SightLines`]).
//! Gaps within one surface are filled, shadows are not.
//!
//! A grid has one height a cell: what hangs is taken for what stands, so that the way below a bridge is blocked (Fig. 36.11b).
//! With room for a robot, a gap, above what is lower, it is the lower height that counts: the extended elevation map of Pfaff, Triebel and Burgard
//! 2007 (Fig. 36.11c).

mod by_range;
pub(crate) mod cells;
mod config;
pub(crate) mod edges;
mod estimate;
mod extended;
mod filling;
mod gathered;
pub(crate) mod level;
mod pyramid;
pub(crate) mod rise;
pub(crate) mod sensed;
mod showing;
mod sight_lines;
pub(crate) mod slope;
mod taking_in;

use geometry::{Cell, CellArea, Grid, Map, Pose, Robot};
use segmentation::Planes;
use settings::{ConfigError, Part, Table, TableDescription, read};

use crate::part::WorldModelPart;
use crate::surface::{Underfoot, Window, check_poses};
use crate::{FloorView, Insertion, MapError, WorldModel};
pub use by_range::RangeCells;
use cells::{HeightCell, Revision};
pub use config::{CellSizes, ElevationConfig, ElevationTuning, EvenSlopeTuning};
pub use estimate::HeightEstimate;
pub use extended::ExtendedElevationConfig;
pub(crate) use extended::PART as EXTENDED;
use filling::Filled;
pub use gathered::{CellMeasurement, Gathered, SurfaceRule};
use level::LevelCells;
use pyramid::Pyramid;
use sensed::SensedFrame;
use sensing::RangeNoise;
pub use sight_lines::SightLines;
use slope::SlopeFinder;

/// How it is listed and made.
pub(crate) const PART: WorldModelPart = Part {
    name: Elevation::NAME,
    about: "a height a cell, fused by a Kalman filter; edges kept, gaps filled, shadows not",
    source: Some("Burgard and Hebert, World Modeling (004, equations 36.17 and 36.18)"),
    tables: &[TableDescription::of::<ElevationConfig>()],
    make: |needs| Ok(Box::new(Elevation::new(read(needs.tables, "elevation")?)?)),
};

/// Keeps the heights and the view made of them.
#[derive(Debug, Clone)]
pub struct Elevation {
    config: ElevationConfig,
    /// Room between two things above each other, m, with which the lower one counts; infinite: the higher one does.
    gap_m: f32,
    window: Window,
    cells: Grid<HeightCell>,
    filled: Grid<Filled>,
    pyramid: Pyramid,
    /// What is known, where cells grow with the distance; those of the window are samples of it.
    by_range: Option<RangeCells>,
    underfoot: Underfoot,
    frame: SensedFrame,
    gathered: Gathered,
    lines: SightLines,
    /// Above which nothing is, as far as sight lines tell, m; infinite where none passed.
    bounds_m: Grid<f32>,
    /// Height of each cell, m, as far as the last refresh asked for it; NaN where nothing is known.
    heights_m: Vec<f32>,
    /// Frames that saw it.
    seen: Vec<u16>,
    level: LevelCells,
    slopes: SlopeFinder,
    view: FloorView,
}

impl Elevation {
    /// The name by which it is chosen.
    pub const NAME: &'static str = "elevation";

    /// A map of which nothing is known, around the map's origin.
    pub fn new(config: ElevationConfig) -> Result<Self, ConfigError> {
        Self::with_gap(config, f32::INFINITY)
    }

    fn with_gap(config: ElevationConfig, gap_m: f32) -> Result<Self, ConfigError> {
        config.check()?;
        let (n, wander) = (config.window, config.tuning.wander);
        let window = Window::new(config.cell, n, wander);
        Ok(Self {
            cells: Grid::filled(n, n, HeightCell::UNKNOWN),
            filled: Grid::filled(n, n, Filled::NOT),
            pyramid: Pyramid::new(
                config.pyramid - 1,
                (config.cell, n),
                wander,
                config.tuning.dense,
            ),
            by_range: (config.cells == CellSizes::ByRange)
                .then(|| RangeCells::new(config.cell, config.tuning.nearest, config.max_range)),
            underfoot: Underfoot::new(n, config.footprint),
            frame: SensedFrame::default(),
            gathered: Gathered::default(),
            lines: SightLines::new(config.cell, config.max_range),
            bounds_m: Grid::filled(n, n, f32::INFINITY),
            heights_m: Vec::new(),
            seen: Vec::new(),
            level: LevelCells::default(),
            slopes: SlopeFinder::default(),
            view: FloorView {
                least_gradient: config.tuning.slopes.least,
                ..FloorView::unknown(window.lattice(), n)
            },
            window,
            gap_m,
            config,
        })
    }

    /// Height of a cell as the filter has it; none where nothing was measured, and outside.
    pub fn estimate(&self, cell: Cell) -> Option<HeightEstimate> {
        Some(self.cells.get(cell)?.known()?.estimate)
    }

    /// The cells that grow with the distance, where the map has such.
    pub const fn by_range(&self) -> Option<&RangeCells> {
        self.by_range.as_ref()
    }

    /// Height, m, that the ground of a cell does not exceed: that of the lowest sight line over it. None where none passed.
    pub fn bound_m(&self, cell: Cell) -> Option<f32> {
        self.bounds_m
            .get(cell)
            .copied()
            .filter(|bound| bound.is_finite())
    }

    const fn rule(&self) -> SurfaceRule {
        SurfaceRule {
            gate: self.config.gate as f32,
            share: self.config.tuning.surface_share as f32,
            gap_m: self.gap_m,
        }
    }

    const fn revision(&self) -> Revision {
        Revision {
            gate: self.config.gate as f32,
            patience: self.config.tuning.patience,
            gap_m: self.gap_m,
        }
    }

    /// Moves the window to the robot; the cells of the view that this may have changed.
    fn follow(&mut self, robot_m: [f64; 3]) -> CellArea {
        self.pyramid.follow(robot_m);
        let [cols, rows] = self.window.follow(robot_m);
        if [cols, rows] == [0; 2] {
            return CellArea::EMPTY;
        }
        self.cells.shift(cols, rows, &HeightCell::UNKNOWN);
        self.filled.shift(cols, rows, &Filled::NOT);
        self.bounds_m.shift(cols, rows, &f32::INFINITY);
        self.underfoot.shift(cols, rows);
        self.view.shift(cols, rows, self.window.lattice());
        self.view.cells.area()
    }
}

/// The cell that is stored at an index, row by row.
pub(crate) const fn cell_of(index: usize, [cols, _]: [usize; 2]) -> Cell {
    Cell::new((index % cols) as i32, (index / cols) as i32)
}

impl WorldModel for Elevation {
    fn forget(&mut self) {
        if let Ok(fresh) = Self::with_gap(self.config.clone(), self.gap_m) {
            *self = fresh;
        }
    }

    fn insert(
        &mut self,
        planes: &Planes,
        map_from_robot: &Pose<Map, Robot>,
    ) -> Result<Insertion, MapError> {
        check_poses(planes, map_from_robot)?;
        let robot_m: [f64; 3] = map_from_robot.inner.translation.vector.into();
        let mut changed = self.follow(robot_m);
        changed.join(self.underfoot.stand(robot_m, &self.window.lattice()));
        let place = (self.window.lattice(), self.view.size());
        self.frame
            .read(planes, map_from_robot, self.config.max_range, place);
        let shift = planes.ground.is_none().then(|| self.shift_m());
        let shift = shift.flatten();
        let used = self.frame.settle(planes, shift);
        if used {
            let touched = self.take_in(robot_m);
            // Beside what was filled or cleared, too.
            changed.join(
                touched.grown(
                    self.fill_rule().cells
                        + 1
                        + self
                            .config
                            .edge_rule()
                            .reach
                            .max(2 * self.config.slope_rule().reach),
                ),
            );
        }
        self.refresh(changed.within(self.view.cells.area()));
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
