//! The occupancy grid of a plane (004, section 36.2.1; [`plan_view::OccupancyMap`]), fed by a slice of each frame between floor and head that is
//! taken for the scan of a laser.
//!
//! It knows one level, that of the ground where the robot begins. Steps up and down, ramps that leave that level and what hangs lower than the
//! robot's head are obstacles to it: where the way leads over them there is none.

mod config;
mod slice;

use geometry::{Cell, Map, PlanarPose, Pose, Robot};
use plan_view::{OccupancyConfig, OccupancyMap};
use segmentation::Planes;
use settings::{ConfigError, Part, Table, TableDescription, read, require};

use crate::part::WorldModelPart;
use crate::surface::{Underfoot, Window, check_poses};
use crate::{FloorView, Insertion, MapError, Surface, Voxel, WorldModel};
pub use config::DepthSliceConfig;
use slice::Slicer;

/// How it is listed and made.
pub(crate) const PART: WorldModelPart = Part {
    name: Occupancy2d::NAME,
    about: "free and occupied cells of one level, from a slice of the depth image: no steps",
    source: Some("Burgard and Hebert, World Modeling (004, section 36.2.1)"),
    tables: &[
        TableDescription::of::<OccupancyConfig>(),
        TableDescription::of::<DepthSliceConfig>(),
    ],
    make: |needs| {
        let config = read(needs.tables, "occupancy_2d")?;
        let slice = read(needs.tables, "depth_slice")?;
        Ok(Box::new(Occupancy2d::new(config, slice, needs.headroom_m)?))
    },
};

/// Keeps the grid and the view made of it.
#[derive(Debug, Clone)]
pub struct Occupancy2d {
    config: OccupancyConfig,
    slice: DepthSliceConfig,
    high_m: f64,
    /// Height of the ground where the robot began, m in the map frame.
    level_m: Option<f64>,
    window: Window,
    map: OccupancyMap,
    underfoot: Underfoot,
    slicer: Slicer,
    view: FloorView,
}

impl Occupancy2d {
    /// The name by which it is chosen.
    pub const NAME: &'static str = "occupancy_2d";

    /// A map of which nothing is known, around the map's origin. `robot_height_m` is the height of the slice where the configuration has none.
    pub fn new(
        config: OccupancyConfig,
        slice: DepthSliceConfig,
        robot_height_m: Option<f64>,
    ) -> Result<Self, ConfigError> {
        slice.check()?;
        let high = slice.high.or(robot_height_m);
        let key = "navigation.depth_slice.high";
        require(
            high.is_some(),
            key,
            "given where there is no robot",
            "nothing",
        )?;
        let window = Window::new(config.cell, slice.window, slice.wander);
        let size = [slice.window; 2];
        Ok(Self {
            map: OccupancyMap::of_size(config.clone(), window.lattice().origin_m, size)?,
            high_m: high.unwrap_or(f64::INFINITY),
            level_m: None,
            underfoot: Underfoot::new(slice.window, slice.footprint),
            slicer: Slicer::new(&slice),
            view: FloorView::unknown(window.lattice(), slice.window),
            window,
            config,
            slice,
        })
    }

    /// The grid itself: what it says of each cell.
    pub const fn map(&self) -> &OccupancyMap {
        &self.map
    }

    fn follow(&mut self, robot_m: [f64; 3]) {
        let [cols, rows] = self.window.follow(robot_m);
        if [cols, rows] != [0; 2] {
            self.map.shift(cols, rows);
            self.underfoot.shift(cols, rows);
            self.view.shift(cols, rows, self.window.lattice());
        }
        let _stood = self.underfoot.stand(robot_m, &self.view.lattice);
    }

    /// What a cell is to planners.
    fn surface(&self, cell: Cell, level_m: f64) -> (Surface, u16) {
        let looks = self.map.cells().get(cell).map_or(0, |belief| belief.looks);
        match self.map.probability(cell) {
            Some(occupied) if occupied > self.config.obstacle => {
                (Surface::Obstacle((level_m + self.high_m) as f32), 0)
            }
            Some(occupied) if occupied < self.slice.floor => {
                (Surface::Floor(level_m as f32), looks)
            }
            _ => {
                let stood = self.underfoot.height(cell);
                let floor = |_| Surface::Floor(level_m as f32);
                (stood.map_or(Surface::Unknown, floor), 0)
            }
        }
    }

    fn refresh(&mut self, level_m: f64) {
        for cell in self.view.cells.area().cells() {
            let (surface, seen) = self.surface(cell, level_m);
            self.view.set(cell, surface, seen);
        }
    }
}

impl WorldModel for Occupancy2d {
    fn forget(&mut self) {
        let height_m = Some(self.high_m);
        if let Ok(fresh) = Self::new(self.config.clone(), self.slice.clone(), height_m) {
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
        let level_m = *self.level_m.get_or_insert(robot_m[2]);
        if planes.reliable {
            let place = (self.high_m, self.view.lattice);
            let beams = self
                .slicer
                .scan((planes, map_from_robot), &self.slice, place);
            let eye = (*map_from_robot * planes.robot_from_camera.origin()).inner;
            let pose = PlanarPose::new(eye.x, eye.y, 0.0);
            let taken = self.map.insert_swept(&pose, &beams);
            taken.map_err(|error| MapError::Failed(error.to_string()))?;
        }
        self.refresh(level_m);
        Ok(Insertion {
            changed: self.view.cells.area(),
            height_shift_m: None,
            used: planes.reliable,
        })
    }

    fn view(&self) -> &FloorView {
        &self.view
    }

    fn needs_surfaces(&self) -> bool {
        false
    }

    /// Columns of cubes from the level up to the head, where a cell is occupied.
    fn occupied(&self) -> Vec<Voxel> {
        let Some(level_m) = self.level_m else {
            return Vec::new();
        };
        let side_m = self.config.cell;
        let count = (self.high_m / side_m).ceil() as usize;
        let cells = self.map.cells().area().cells();
        let occupied = |cell: &Cell| {
            self.map
                .probability(*cell)
                .is_some_and(|p| p > self.config.obstacle)
        };
        let column = |cell: Cell| {
            let [x_m, y_m] = self.view.lattice.center_of(cell);
            (0..count).map(move |up| Voxel {
                centre_m: [x_m, y_m, level_m + (up as f64 + 0.5) * side_m],
                side_m,
            })
        };
        cells.filter(occupied).flat_map(column).collect()
    }
}
