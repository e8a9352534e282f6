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
mod config;
mod moments;
mod sample;
mod samples;

use geometry::{Cell, CellArea, Grid, Map, Pose, Robot};
use segmentation::Planes;
use settings::{ConfigError, Part, Table, TableDescription, read, require};

use crate::columns::{ColumnView, Span};
use crate::elevation::ElevationConfig;
use crate::elevation::sensed::SensedFrame;
use crate::multi_level::seen_through::SeenThrough;
use crate::part::WorldModelPart;
use crate::surface::check_poses;
use crate::{FloorView, Insertion, MapError, Voxel, WorldModel};
pub use config::{PointsConfig, PointsTuning};
pub use moments::{Moments, Shape};
pub use sample::Sample;
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
    samples: SurfaceSamples,
    columns: ColumnView,
    frame: SensedFrame,
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
        let headroom_m = headroom.map_or(f32::INFINITY, |room_m| room_m as f32);
        Ok(Self {
            headroom_m,
            samples: SurfaceSamples::new(elevation.cell, elevation.gate, config.flat),
            columns: ColumnView::new(&elevation, headroom_m, config.tuning.joined),
            frame: SensedFrame::default(),
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
        self.columns.things(cell)
    }

    /// What going through a cell costs, by what stands on its ground: how high that is, in heights that can be climbed, the less the more it is
    /// scattered in all directions. From 0, level ground, to 1; none where nothing was seen.
    ///
    /// The moments are those of all samples around, so that what is no surface, as plants, is told by its true distribution in three dimensions
    /// (004, section 36.3.2; Lalonde et al. 2006).
    pub fn cost(&self, cell: Cell) -> Option<f32> {
        let things = self.things(cell);
        let lattice = self.view().lattice;
        let side_m = lattice.cell_m;
        let beside = CellArea::of(cell).grown(self.config.tuning.around as i32);
        let ground_m = beside
            .within(self.view().cells.area())
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
        let (samples, tuning) = (&self.samples, &self.config.tuning);
        self.columns.fill(|add| {
            samples.spans(tuning.least_points, tuning.upright as f32, add);
        });
    }

    /// For each cell of the view what going through it costs, as [`Points::cost`] has it; NaN where nothing was seen.
    pub fn costs(&self) -> Grid<f32> {
        let [cols, rows] = self.view().size();
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
        let (seen, most_m) = ((planes, map_from_robot), self.elevation.max_range);
        let settled = self.columns.settle(&mut self.frame, seen, most_m);
        if settled.used {
            self.take_in(planes, map_from_robot);
        }
        if settled.used || settled.moved {
            self.columns_anew();
        }
        Ok(self.columns.refresh(map_from_robot, settled))
    }

    fn view(&self) -> &FloorView {
        self.columns.view()
    }

    fn needs_surfaces(&self) -> bool {
        false
    }

    /// Cubes of a cell's side over the vertical extent of each thing in the window.
    fn occupied(&self) -> Vec<Voxel> {
        self.columns.occupied()
    }
}
