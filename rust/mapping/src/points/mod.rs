//! SurfaceSamples of surfaces in a sparse three-dimensional grid, without a direction that is up (004, section 36.3.2).
//!
//! A dynamic grid ([`volume::SparseGrid`], 36.21) holds blocks of cells where something was seen. In them are [`SurfaceSamples`] (36.22): a point is fused
//! with the sample that is near, unless they differ, and samples that are surely on one surface become one. The samples keep the
//! moments of their points ([`Moments`]), so that the true local distribution in three dimensions can be asked: a bush costs less than a
//! wall of the same height ([`Points::cost`]).
//!
//! Planners see, of each column of cells, the surface that is reached from where the robot stands, as with [`crate::MultiLevel`].

mod block;
mod cells;
mod columns;
mod config;
mod moments;
mod sample;
mod samples;

use geometry::{Cell, CellArea, Grid, Map, Pose, Robot};
use segmentation::Planes;
use settings::{ConfigError, Part, Table, TableDescription, read, require};

use crate::elevation::edges::upper_surface;
use crate::elevation::sensed::SensedFrame;
use crate::elevation::slope::SlopeFinder;
use crate::elevation::{ElevationConfig, cell_of};
use crate::multi_level::reached::Reached;
use crate::multi_level::seen_through::SeenThrough;
use crate::part::WorldModelPart;
use crate::surface::{Underfoot, Window, check_poses};
use crate::{FloorView, Insertion, MapError, Surface, Voxel, WorldModel};
use columns::Columns;
pub use config::{PointsConfig, PointsTuning};
pub use moments::{Moments, Shape};
pub use sample::{Sample, Span};
pub use samples::SurfaceSamples;

/// How it is listed and made.
pub(crate) const PART: WorldModelPart = Part {
    name: Points::NAME,
    about: "samples of surfaces in a sparse 3D grid, more where things are not flat",
    source: Some("Burgard and Hebert, World Modeling (004, section 36.3.2)"),
    tables: &[
        TableDescription::of::<ElevationConfig>(),
        TableDescription::of::<PointsConfig>(),
    ],
    make: |needs| {
        let config: PointsConfig = read(needs.tables, "points")?;
        let elevation = read(needs.tables, "elevation")?;
        Ok(Box::new(Points::new(config, elevation, needs.headroom_m)?))
    },
};

/// Keeps the samples and the view made of them.
#[derive(Debug, Clone)]
pub struct Points {
    config: PointsConfig,
    elevation: ElevationConfig,
    /// Room between two things above each other with which both are kept, m.
    headroom_m: f32,
    window: Window,
    samples: SurfaceSamples,
    columns: Columns,
    underfoot: Underfoot,
    frame: SensedFrame,
    reached: Reached,
    slopes: SlopeFinder,
    view: FloorView,
}

impl Points {
    /// The name by which it is chosen.
    pub const NAME: &'static str = "points";

    /// A map of which nothing is known, around the map's origin. `robot_height_m` is the room that counts where the configuration has none.
    pub fn new(
        config: PointsConfig,
        elevation: ElevationConfig,
        robot_height_m: Option<f64>,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        elevation.check()?;
        let headroom = config.headroom.or(robot_height_m);
        let key = "navigation.points.headroom";
        let wanted = "given where there is no robot";
        require(headroom.is_some(), key, wanted, "nothing")?;
        let n = elevation.window;
        let window = Window::new(elevation.cell, n, elevation.tuning.wander);
        Ok(Self {
            headroom_m: headroom.map_or(f32::INFINITY, |room_m| room_m as f32),
            samples: SurfaceSamples::new(elevation.cell, elevation.gate, config.flat),
            columns: Columns::default(),
            underfoot: Underfoot::new(n, elevation.footprint),
            frame: SensedFrame::default(),
            reached: Reached::new(n),
            slopes: SlopeFinder::default(),
            view: FloorView {
                least_gradient: elevation.tuning.slopes.least,
                ..FloorView::unknown(window.lattice(), n)
            },
            window,
            config,
            elevation,
        })
    }

    /// The samples.
    pub const fn samples(&self) -> &SurfaceSamples {
        &self.samples
    }

    /// The things in a cell of the view, the lowest first; none where nothing was seen, and outside.
    pub fn things(&self, cell: Cell) -> &[Span] {
        self.view
            .cells
            .index(cell)
            .map_or(&[], |at| self.columns.things(at))
    }

    /// What going through a cell costs, by what stands on its ground: how high that is, in heights that can be climbed, the less the more it is
    /// scattered in all directions. From 0, level ground, to 1; none where nothing was seen.
    ///
    /// The moments are those of all samples around, so that what is no surface, as plants, is told by its true distribution in three dimensions
    /// (004, section 36.3.2; Lalonde et al. 2006).
    pub fn cost(&self, cell: Cell) -> Option<f32> {
        let things = self.things(cell);
        let lattice = self.window.lattice();
        let side_m = lattice.cell_m;
        let beside = CellArea::of(cell).grown(self.config.tuning.around as i32);
        let ground_m = beside
            .within(self.view.cells.area())
            .cells()
            .filter_map(|other| self.things(other).first())
            .map(|thing| f64::from(thing.low_m))
            .fold(f64::INFINITY, f64::min);
        let top_m = f64::from(things.first()?.high_m);
        let rise_m = self.elevation.rise;
        let height = ((top_m - ground_m) / rise_m).min(1.0);
        // What can be climbed is ground, and no part of what stands on it.
        let reach_m = (self.config.tuning.around as f64 + 0.5) * side_m;
        let [x_m, y_m] = lattice.center_of(cell);
        let standing = self.samples.moments_in(
            [x_m - reach_m, y_m - reach_m, ground_m + rise_m],
            [x_m + reach_m, y_m + reach_m, top_m + side_m],
        );
        Some(height as f32 * (1.0 - standing.scatter()))
    }

    fn follow(&mut self, robot_m: [f64; 3]) {
        let [cols, rows] = self.window.follow(robot_m);
        if [cols, rows] != [0; 2] {
            self.underfoot.shift(cols, rows);
            self.view.shift(cols, rows, self.window.lattice());
            self.columns_anew();
        }
    }

    /// The shift that brings the frame onto the heights that are known.
    fn shift_m(&mut self) -> Option<f64> {
        let columns = &self.columns;
        let known_m = |cell: usize, from_m: f32| {
            let heights_m = columns.things(cell).iter().map(|one| one.high_m);
            heights_m.min_by(|a, b| (a - from_m).abs().total_cmp(&(b - from_m).abs()))
        };
        let gate = (self.elevation.match_gate, self.elevation.min_pairs);
        (self.frame).shift_m(known_m, gate, &self.elevation.tuning.matching)
    }

    fn take_in(&mut self, planes: &Planes, map_from_robot: &Pose<Map, Robot>) {
        let noise = self.elevation.noise();
        for point in &self.frame.points {
            let at_m = self.frame.at_m(point);
            let from_above = self.frame.eye_m[2] >= at_m[2];
            let variance_m2 = noise.variance_m2(point.range_m);
            self.samples.add(at_m, variance_m2, from_above);
        }
        if self.elevation.clearing
            && let Some(seen) = SeenThrough::new(planes, map_from_robot)
        {
            let (behind, side_m) = (self.config.tuning.behind as f32, self.elevation.cell as f32);
            self.samples
                .look_through(self.elevation.tuning.patience, |at_m, variance_m2| {
                    seen.beyond_m(at_m).is_some_and(|(range_m, beyond_m)| {
                        let sigma_m = (noise.variance_m2(range_m) + variance_m2).sqrt();
                        beyond_m > behind * sigma_m + side_m
                    })
                });
        }
        self.samples.end_frame();
        let robot_m: [f64; 3] = map_from_robot.inner.translation.vector.into();
        self.samples.forget_beyond(robot_m, self.config.kept);
    }

    /// Brings the samples into the columns of the window.
    fn columns_anew(&mut self) {
        let lattice = self.window.lattice();
        let corner = lattice
            .origin_m
            .map(|at_m| (at_m / lattice.cell_m).round() as i32);
        let (columns, cells) = (&mut self.columns, &self.view.cells);
        columns.begin();
        let tuning = &self.config.tuning;
        self.samples.spans(
            tuning.least_points,
            tuning.upright as f32,
            |column, span| {
                let cell = Cell::new(column[0] - corner[0], column[1] - corner[1]);
                if let Some(index) = cells.index(cell) {
                    columns.add(index, span);
                }
            },
        );
        columns.finish(cells.values().len(), self.headroom_m);
    }

    /// The surface of a cell by which the robot comes: height and frames, and the room above it, m.
    fn way(&self, index: usize) -> Option<(f32, u16, f32)> {
        let by_m = self.reached.height_m(index);
        let things = self.columns.things(index);
        let off = |one: &Span| (one.high_m - by_m).abs();
        let nearest =
            (0..things.len()).min_by(|&a, &b| off(&things[a]).total_cmp(&off(&things[b])))?;
        let height_m = things[nearest].high_m;
        let above = things.get(nearest + 1);
        let room_m = above.map_or(f32::INFINITY, |one| one.low_m - height_m);
        Some((height_m, things[nearest].frames, room_m))
    }

    fn surface(&self, index: usize) -> (Surface, u16) {
        let Some((own_m, frames, room_m)) = self.way(index) else {
            let stood = self.underfoot.height_at(index);
            return (stood.map_or(Surface::Unknown, Surface::Floor), 0);
        };
        let size = self.view.size();
        let cell = cell_of(index, size);
        let away = |[cols, rows]: [i32; 2]| {
            let beside = Cell::new(cell.col + cols, cell.row + rows);
            Some(self.way(self.view.cells.index(beside)?)?.0)
        };
        let rule = self.elevation.edge_rule();
        let height_m = upper_surface(own_m, away, rule).unwrap_or(own_m);
        let heights = geometry::runs(CellArea::of(cell).grown(1), size)
            .flatten()
            .filter_map(|other| self.way(other));
        let lowest_m = heights.fold(height_m, |low, (other, ..)| low.min(other));
        if f64::from(height_m - lowest_m) > self.elevation.rise || room_m < self.headroom_m {
            (Surface::Obstacle(height_m), 0)
        } else {
            (Surface::Floor(height_m), frames)
        }
    }

    /// Makes the view of what is reached from where the robot stands.
    fn refresh(&mut self, robot_m: [f64; 3]) {
        let start = self.window.lattice().cell_at(robot_m[0], robot_m[1]);
        let columns = &self.columns;
        let nearest = |index: usize, from_m: f32| {
            let heights = columns.things(index).iter().map(|one| one.high_m);
            heights.min_by(|a, b| (a - from_m).abs().total_cmp(&(b - from_m).abs()))
        };
        let joined_m = (self.config.tuning.joined * self.elevation.rise) as f32;
        self.reached
            .spread((start, robot_m[2] as f32), joined_m, nearest);
        for index in 0..self.view.cells.values().len() {
            let (surface, frames) = self.surface(index);
            self.view.cells.values_mut()[index] = surface;
            self.view.sightings.values_mut()[index] = frames;
        }
        let place = (self.view.size(), self.view.cells.area());
        let rule = (self.elevation.cell as f32, self.elevation.slope_rule());
        let (mut slopes, mut gradients) = (
            std::mem::take(&mut self.slopes),
            std::mem::replace(&mut self.view.gradients, Grid::filled(0, 0, [0.0; 2])),
        );
        let height = |index: usize| self.way(index).map(|way| way.0);
        slopes.find(place, height, rule, |index, gradient| {
            gradients.values_mut()[index] = gradient;
        });
        (self.slopes, self.view.gradients) = (slopes, gradients);
    }

    /// For each cell of the view what going through it costs, as [`Points::cost`] has it; NaN where nothing was seen.
    pub fn costs(&self) -> Grid<f32> {
        let [cols, rows] = self.view.size();
        let mut costs = Grid::filled(cols, rows, f32::NAN);
        for cell in costs.area().cells() {
            if let (Some(slot), Some(cost)) = (costs.get_mut(cell), self.cost(cell)) {
                *slot = cost;
            }
        }
        costs
    }
}

impl WorldModel for Points {
    fn forget(&mut self) {
        let height_m = Some(f64::from(self.headroom_m));
        if let Ok(fresh) = Self::new(self.config.clone(), self.elevation.clone(), height_m) {
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
        self.follow(robot_m);
        let _stood = self.underfoot.stand(robot_m, &self.window.lattice());
        let place = (self.window.lattice(), self.view.size());
        self.frame
            .read(planes, map_from_robot, self.elevation.max_range, place);
        let shift = planes.ground.is_none().then(|| self.shift_m());
        let shift = shift.flatten();
        let used = self.frame.settle(planes, shift);
        if used {
            self.take_in(planes, map_from_robot);
            self.columns_anew();
        }
        self.refresh(robot_m);
        Ok(Insertion {
            changed: self.view.cells.area(),
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

    /// Cubes of a cell's side over the vertical extent of each thing in the window.
    fn occupied(&self) -> Vec<Voxel> {
        let (lattice, side_m) = (self.window.lattice(), self.elevation.cell);
        let mut voxels = Vec::new();
        for cell in self.view.cells.area().cells() {
            let [x_m, y_m] = lattice.center_of(cell);
            for thing in self.things(cell) {
                let count = (f64::from(thing.high_m - thing.low_m) / side_m) as usize + 1;
                let top_m = f64::from(thing.high_m);
                voxels.extend((0..count).map(|down| Voxel {
                    centre_m: [x_m, y_m, top_m - (down as f64 + 0.5) * side_m],
                    side_m,
                }));
            }
        }
        voxels
    }
}
