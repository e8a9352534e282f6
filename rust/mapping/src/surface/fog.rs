//! The floor and obstacle grid of Gutmann, Fukuchi and Fujita 2005 (000): equations (5), (10), (11) and the order of an update.

use geometry::{Cell, CellArea, ConfigError, Grid, Map, Pose, Robot};
use segmentation::Planes;

use super::window::Window;
use super::{FloorGrid, FogConfig, LabelledFrame, height_shift};
use crate::volume::{OccupancyGrid, Placement, ProbabilityTable, Size};
use crate::{FloorView, Insertion, MapError, Surface, WorldModel};

/// Keeps the occupancy grid, the floor grid and the view made of both.
#[derive(Debug, Clone)]
pub struct Fog {
    config: FogConfig,
    window: Window,
    occupancy: OccupancyGrid,
    floor: FloorGrid,
    /// Height of the ground where the robot stood, m; NaN where it did not.
    stood: Grid<f32>,
    view: FloorView,
    frame: LabelledFrame,
}

impl Fog {
    /// The name by which it is chosen.
    pub const NAME: &'static str = "fog";

    /// A map of which nothing is known, around the map's origin.
    pub fn new(config: FogConfig) -> Result<Self, ConfigError> {
        config.check()?;
        let window = Window::new();
        let lattice = window.lattice(&config);
        let n = config.cells;
        let table = ProbabilityTable::new(config.p_sense, config.p_occ, config.p_min, config.p_max);
        let placement = Placement {
            lattice,
            bottom_m: window.bottom_m(&config),
            layer_m: config.layer,
        };
        let size = Size {
            cols: n,
            rows: n,
            layers: config.layers,
        };
        Ok(Self {
            occupancy: OccupancyGrid::new(size, placement, table),
            floor: FloorGrid::new(lattice, &config),
            stood: Grid::filled(n, n, f32::NAN),
            view: FloorView {
                lattice,
                cells: Grid::filled(n, n, Surface::Unknown),
                sightings: Grid::filled(n, n, 0),
            },
            frame: LabelledFrame::default(),
            window,
            config,
        })
    }

    /// The occupancy grid.
    pub const fn occupancy(&self) -> &OccupancyGrid {
        &self.occupancy
    }

    /// The floor grid.
    pub const fn floor(&self) -> &FloorGrid {
        &self.floor
    }

    /// Equation (11) of a cell; where that is unknown and the robot stood there, the floor that it stood on.
    pub fn surface(&self, cell: Cell) -> Surface {
        let floor = self.floor.height(cell);
        let obstacle = self.occupancy.obstacle_height_m(cell);
        let limit = floor.map_or(f64::NEG_INFINITY, |h| f64::from(h) + self.config.delta);
        match (obstacle, floor) {
            (Some(top), _) if top > limit => Surface::Obstacle(top as f32),
            (_, Some(height)) => Surface::Floor(height),
            _ => match self.stood.get(cell) {
                Some(&height) if !height.is_nan() => Surface::Floor(height),
                _ => Surface::Unknown,
            },
        }
    }

    /// Moves the window to the robot; the cells of the view that this may have changed.
    fn follow(&mut self, robot_m: [f64; 3]) -> CellArea {
        let [cols, rows, layers] = self.window.follow(robot_m, &self.config);
        if [cols, rows, layers] == [0; 3] {
            return CellArea::EMPTY;
        }
        let lattice = self.window.lattice(&self.config);
        self.occupancy.shift(cols, rows, layers);
        self.occupancy
            .place(lattice, self.window.bottom_m(&self.config));
        self.floor.shift(cols, rows, lattice);
        self.stood.shift(cols, rows, &f32::NAN);
        self.view.cells.shift(cols, rows, &Surface::Unknown);
        self.view.sightings.shift(cols, rows, &0);
        self.view.lattice = lattice;
        let all = self.view.cells.area();
        if layers != 0 {
            self.floor.verify(&self.occupancy, all);
            self.refresh(all);
        }
        all
    }

    /// Remembers the ground under the robot: it cannot see where it stands.
    fn stand(&mut self, robot_m: [f64; 3]) -> CellArea {
        let mut area = CellArea::EMPTY;
        let lattice = self.view.lattice;
        let [x, y, z] = robot_m;
        let reach = self.config.footprint;
        let window = CellArea {
            min: lattice.cell_at(x - reach, y - reach),
            max: lattice.cell_at(x + reach, y + reach),
        };
        for cell in window.cells() {
            let [cx, cy] = lattice.center_of(cell);
            if (cx - x).hypot(cy - y) <= reach
                && let Some(height) = self.stood.get_mut(cell)
            {
                *height = z as f32;
                area.include(cell);
            }
        }
        area
    }

    /// Brings the view up to date in an area.
    fn refresh(&mut self, area: CellArea) {
        for cell in area.cells() {
            let surface = self.surface(cell);
            let seen = self.floor.sightings(cell);
            if let Some(slot) = self.view.cells.get_mut(cell) {
                *slot = surface;
            }
            if let Some(slot) = self.view.sightings.get_mut(cell) {
                *slot = seen;
            }
        }
    }
}

impl WorldModel for Fog {
    fn insert(
        &mut self,
        planes: &Planes,
        map_from_robot: &Pose<Map, Robot>,
    ) -> Result<Insertion, MapError> {
        let finite =
            |pose: &nalgebra::Isometry3<f64>| pose.to_matrix().iter().all(|v| v.is_finite());
        if !finite(&map_from_robot.inner) {
            return Err(MapError::PoseNotFinite);
        }
        if !finite(&planes.robot_from_camera.inner) {
            return Err(MapError::Failed("the camera's pose must be finite".into()));
        }
        let at = map_from_robot.inner.translation.vector;
        let robot_m = [at.x, at.y, at.z];
        let mut changed = self.follow(robot_m);
        join(&mut changed, self.stand(robot_m));

        let config = &self.config;
        self.frame
            .read(planes, map_from_robot, config.snap, config.max_range);
        let shift = height_shift(
            &self.frame,
            &self.floor,
            config.match_gate,
            config.min_pairs,
        );
        let used = planes.reliable || shift.is_some();
        if used {
            self.frame.raise(shift.unwrap_or(0.0));
            let eye_m = self.frame.eye_m;
            let touched = self
                .occupancy
                .insert(eye_m, self.frame.rays(), config.update);
            self.floor.verify(&self.occupancy, touched);
            self.floor
                .update(&self.frame, &self.occupancy, config.update);
            join(&mut changed, touched);
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
}

/// Grows `area` to hold `other`.
fn join(area: &mut CellArea, other: CellArea) {
    if !other.is_empty() {
        area.include(other.min);
        area.include(other.max);
    }
}
