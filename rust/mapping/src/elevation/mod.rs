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
mod pyramid;
pub(crate) mod sensed;
mod sight_lines;
pub(crate) mod slope;

use geometry::{Cell, CellArea, Grid, Map, Pose, Robot, runs};
use segmentation::Planes;
use settings::{ConfigError, Part, Table, TableDescription, read};
use volume::Locator;

use crate::part::WorldModelPart;
use crate::surface::{Pair, Underfoot, Window, check_poses, height_shift};
use crate::{FloorView, Insertion, MapError, Surface, WorldModel};
pub use by_range::RangeCells;
use cells::{Belief, HeightCell};
pub use config::{CellSizes, ElevationConfig, ElevationTuning, SlopeTuning};
use edges::{EdgeRule, upper_surface};
pub use estimate::{HeightEstimate, RangeNoise};
pub use extended::ExtendedElevationConfig;
pub(crate) use extended::PART as EXTENDED;
use filling::{FillRule, Filled, fill};
pub use gathered::{CellMeasurement, Gathered, SurfaceRule};
use pyramid::Pyramid;
use sensed::{SensedFrame, SensedPoint};
pub use sight_lines::SightLines;
use slope::Slopes;

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
    slopes: Slopes,
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
            slopes: Slopes::default(),
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

    const fn edge_rule(&self) -> EdgeRule {
        EdgeRule {
            least_m: self.config.tuning.edge as f32,
            uneven: self.config.tuning.uneven as f32,
            reach: 3,
        }
    }

    const fn belief(&self) -> Belief {
        Belief {
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

    /// The shift that brings the frame onto the heights that are known.
    fn shift_m(&self, locator: &Locator<2>) -> Option<f64> {
        let pair = |point: &SensedPoint| {
            let [x_m, y_m, z_m] = point.at_m;
            let known = self.cells.values()[locator.index_at([x_m, y_m])?].known()?;
            Some(Pair {
                residual_m: f64::from(known.estimate.height_m) - z_m,
                weight: 1,
            })
        };
        let pairs = self.frame.points.iter().filter_map(pair);
        let gate = (self.config.match_gate, self.config.min_pairs);
        height_shift(pairs, gate, &self.config.tuning.matching)
    }

    /// Takes in the frame that was read; the cells that it changed.
    fn take_in(&mut self, robot_m: [f64; 3], locator: &Locator<2>) -> CellArea {
        let (rule, belief, noise) = (self.rule(), self.belief(), self.config.noise());
        let (size, area) = (self.view.size(), self.view.cells.area());
        if let Some(known) = &mut self.by_range {
            known.insert(robot_m, &self.frame, (noise, rule, belief));
            let lattice = self.window.lattice();
            for (index, cell) in self.cells.values_mut().iter_mut().enumerate() {
                let found = known.at(lattice.center_of(cell_of(index, size)));
                *cell = found.unwrap_or(HeightCell::UNKNOWN);
            }
            return area;
        }
        self.gathered.begin(size[0] * size[1]);
        for point in &self.frame.points {
            let [x_m, y_m, z_m] = point.at_m;
            if let Some(cell) = locator.index_at([x_m, y_m]) {
                (self.gathered).add(cell, z_m as f32, noise.variance_m2(point.range_m));
            }
        }
        let mut touched = CellArea::EMPTY;
        let cells = self.cells.values_mut();
        self.gathered.measure(rule, |measured| {
            cells[measured.cell].measure(&measured, belief);
            touched.include(cell_of(measured.cell, size));
        });
        self.pyramid.insert(&self.frame, noise, rule, belief);
        if self.config.clearing {
            touched.join(self.look_below_sight_lines(belief, noise));
        }
        if self.config.fill > 0.0 {
            self.fill_gaps(touched.grown(self.fill_rule().cells).within(area));
        }
        touched
    }

    /// Takes back what sight lines pass below; the cells in which something was.
    fn look_below_sight_lines(&mut self, belief: Belief, noise: RangeNoise) -> CellArea {
        let eye_m = self.frame.eye_m;
        self.lines.begin(eye_m);
        for point in &self.frame.points {
            self.lines.add(point.at_m);
        }
        self.lines.finish();
        let (size, lattice) = (self.view.size(), self.window.lattice());
        let mut cleared = CellArea::EMPTY;
        for (index, cell) in self.cells.values_mut().iter_mut().enumerate() {
            if self.gathered.holds(index) {
                continue;
            }
            let at = cell_of(index, size);
            let centre_m = lattice.center_of(at);
            let Some(bound_m) = self.lines.bound_m(centre_m) else {
                continue;
            };
            let lowest = &mut self.bounds_m.values_mut()[index];
            *lowest = lowest.min(bound_m as f32);
            if cell.known().is_some() {
                let range_m = geometry::hypot(centre_m[0] - eye_m[0], centre_m[1] - eye_m[1]);
                if cell.pass(bound_m as f32, noise.variance_m2(range_m as f32), belief) {
                    cleared.include(at);
                }
            }
        }
        cleared
    }

    /// What may be filled.
    fn fill_rule(&self) -> FillRule {
        FillRule {
            cells: (self.config.fill / self.config.cell + 0.5) as i32,
            gate: self.config.gate as f32,
            slope: (self.config.rise / self.config.cell.max(self.config.fill)) as f32,
        }
    }

    /// Fills the gaps of an area that lie between cells that the frame saw.
    fn fill_gaps(&mut self, area: CellArea) {
        let (rule, eye_m, lattice) = (self.fill_rule(), self.frame.eye_m, self.window.lattice());
        let size = self.view.size();
        for index in runs(area, size).flatten() {
            if self.cells.values()[index].known().is_none() {
                let cell = cell_of(index, size);
                if let Some(found) = fill(&self.cells, &lattice, (cell, eye_m), rule) {
                    self.filled.values_mut()[index] = found;
                }
            }
        }
    }

    /// Height of a cell and how many frames saw it: measured, filled, or that of a coarser grid.
    fn height(&self, index: usize) -> Option<(f32, u16)> {
        if let Some(known) = self.cells.values()[index].known() {
            return Some((known.estimate.height_m, known.frames));
        }
        let filled = self.filled.values()[index];
        if !filled.height_m.is_nan() {
            return Some((filled.height_m, filled.frames));
        }
        let centre_m = self
            .window
            .lattice()
            .center_of(cell_of(index, self.view.size()));
        let coarse = self.pyramid.at(centre_m)?;
        Some((coarse.estimate.height_m, coarse.frames))
    }

    /// What a cell counts as: an obstacle where it lies too far above one beside it.
    fn surface(&self, index: usize) -> (Surface, u16) {
        let Some((own_m, frames)) = self.height(index) else {
            let stood = self.underfoot.height_at(index);
            return (stood.map_or(Surface::Unknown, Surface::Floor), 0);
        };
        let size = self.view.size();
        let cell = cell_of(index, size);
        let away = |away: [i32; 2]| self.height_at(index, away);
        let height_m = upper_surface(own_m, away, self.edge_rule()).unwrap_or(own_m);
        let beside = CellArea::of(cell).grown(1);
        let heights = runs(beside, size)
            .flatten()
            .filter_map(|other| self.height(other));
        let lowest_m = heights.fold(height_m, |low, (other, _)| low.min(other));
        if f64::from(height_m - lowest_m) > self.config.rise {
            (Surface::Obstacle(height_m), 0)
        } else {
            (Surface::Floor(height_m), frames)
        }
    }

    /// Brings the view up to date in an area.
    fn refresh(&mut self, area: CellArea) {
        let size = self.view.size();
        for index in runs(area, size).flatten() {
            let (surface, frames) = self.surface(index);
            self.view.cells.values_mut()[index] = surface;
            self.view.sightings.values_mut()[index] = frames;
        }
        let sure = self.config.tuning.slopes.sure as f32;
        let (cells, view) = (&self.cells, &mut self.view);
        let height = |index: usize| {
            let known = cells.values()[index].known()?.estimate;
            (known.variance_m2 <= sure * sure).then_some(known.height_m)
        };
        let rule = (self.config.cell as f32, self.config.slope_rule());
        self.slopes
            .find((size, area), height, rule, |index, gradient| {
                view.gradients.values_mut()[index] = gradient;
            });
    }

    /// Height of the cell so many columns and rows away from one, m.
    fn height_at(&self, index: usize, [cols, rows]: [i32; 2]) -> Option<f32> {
        let cell = cell_of(index, self.view.size());
        let at = self
            .cells
            .index(Cell::new(cell.col + cols, cell.row + rows))?;
        Some(self.height(at)?.0)
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
        self.frame
            .read(planes, map_from_robot, self.config.max_range);
        let locator = Locator::of_cells(&self.window.lattice(), self.view.size());
        // The ground that the robot stands on tells a frame's height best.
        let shift = if planes.ground.is_some() {
            None
        } else {
            self.shift_m(&locator)
        };
        let used = planes.reliable || shift.is_some();
        if used {
            if let Some(shift_m) = shift {
                self.frame.raise(shift_m);
            }
            let touched = self.take_in(robot_m, &locator);
            // Beside what was filled or cleared, too.
            changed.join(
                touched.grown(
                    self.fill_rule().cells
                        + 1
                        + self
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
