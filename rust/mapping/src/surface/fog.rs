//! The floor and obstacle grid of Gutmann, Fukuchi and Fujita 2005 (000): equations (5), (10), (11), the order of an update, and
//! the ceiling map that its section VI proposes.

mod head_room;

use geometry::{Cell, CellArea, Grid, Map, Pose, Robot};
use segmentation::Planes;
use settings::{ConfigError, Table};

use super::overhead::Overhead;
use super::rough::Rough;
use super::shadow::{Shadow, Surroundings};
use super::underfoot::Underfoot;
use super::window::{Layers, Window};
use super::{
    FloorGrid, FogConfig, LabelledFrame, LabelledPoint, Pair, Reading, check_poses, height_shift,
};
use crate::{FloorView, Insertion, MapError, Surface, WorldModel};
use geometry::runs;
use volume::{Locator, OccupancyGrid, Placement, ProbabilityTable, Size};

/// Keeps the occupancy grid, the floor grid and the view made of both.
#[derive(Debug, Clone)]
pub struct Fog {
    /// The parameters.
    pub(crate) config: FogConfig,
    window: Window,
    layers: Layers,
    /// The occupancy grid.
    pub occupancy: OccupancyGrid,
    /// The floor grid.
    pub floor: FloorGrid,
    rough: Rough,
    underfoot: Underfoot,
    overhead: Overhead,
    /// Height of the ground that the robot stands on, m.
    level_m: f64,
    surroundings: Surroundings,
    view: FloorView,
    /// The points of the last frame, as they were taken in.
    pub(crate) frame: LabelledFrame,
    pairs: Vec<Pair>,
}

impl Fog {
    /// The name by which it is chosen.
    pub const NAME: &'static str = "fog";

    /// A map of which nothing is known, around the map's origin.
    pub fn new(config: FogConfig) -> Result<Self, ConfigError> {
        config.check()?;
        let window = Window::new(config.cell, config.cells, config.tuning.wander);
        Ok(Self::with_window(config, window))
    }

    /// A map of which nothing is known, around a place of the map frame, where the cells stay while the robot is no more than so many of them away.
    pub(crate) fn around(
        config: FogConfig,
        place_m: [f64; 2],
        slack: f64,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        let slack = slack.max(config.tuning.wander);
        let window = Window::around(config.cell, config.cells, place_m, slack);
        Ok(Self::with_window(config, window))
    }

    fn with_window(config: FogConfig, window: Window) -> Self {
        let n = config.cells;
        let layers = Layers::new(&config);
        let lattice = window.lattice();
        let table = ProbabilityTable::new(config.p_sense, config.p_occ, config.p_min, config.p_max);
        let placement = Placement {
            lattice,
            bottom_m: layers.bottom_m(),
            layer_m: config.layer,
        };
        let size = Size {
            cols: n,
            rows: n,
            layers: config.layers,
        };
        Self {
            occupancy: OccupancyGrid::new(size, placement, table)
                .with_looks(config.tuning.looks, config.tuning.looks_at_others),
            floor: FloorGrid::new(lattice, &config),
            rough: Rough::new(n, config.tuning.rough_lead),
            underfoot: Underfoot::new(n, config.footprint),
            overhead: Overhead::new(n, config.tuning.overhead.clone()),
            level_m: 0.0,
            surroundings: Surroundings::default(),
            view: FloorView {
                least_gradient: config.tuning.slopes.least,
                ..FloorView::unknown(lattice, n)
            },
            frame: LabelledFrame::default(),
            pairs: Vec::new(),
            window,
            layers,
            config,
        }
    }

    /// Height of the floor of the cell that is stored at an index: what was seen there, or else what the robot stood on.
    #[inline]
    pub(crate) fn floor_at(&self, index: usize) -> Option<f32> {
        let seen = self.floor.height_at(index);
        seen.or_else(|| self.underfoot.height_at(index))
    }

    /// Section VI: height of the centre of the lowest occupied voxel above a cell's floor, m. `None` where there is no such
    /// voxel, or no floor.
    pub fn ceiling_m(&self, cell: Cell) -> Option<f64> {
        let floor_m = f64::from(self.floor.height(cell)?);
        self.occupancy
            .lowest_above_m(cell, floor_m + self.config.delta)
    }

    /// Equation (11) of a cell, but that a ceiling which is high enough is no obstacle, and nor is what does not stand out of the
    /// floor beside it where the cell's own is not known: the border of a tread, or floor that was only seen from far away. Where
    /// it is unknown and the robot stood there, the floor that it stood on.
    pub fn surface(&self, cell: Cell) -> Surface {
        let index = self.view.cells.index(cell);
        index.map_or(Surface::Unknown, |index| self.surface_at(index))
    }

    /// What is in the cell that is stored at an index, row by row: [`Self::surface`].
    #[inline]
    fn surface_at(&self, index: usize) -> Surface {
        let floor = self.floor.height_at(index);
        let below = match (self.occupancy.obstacle_height_at(index), floor) {
            (Some(top_m), _) if self.stands_out(index, top_m, floor) => {
                return Surface::Obstacle(top_m as f32);
            }
            (_, None) => self.underfoot.height_at(index),
            _ => floor,
        };
        below.map_or(Surface::Unknown, Surface::Floor)
    }

    /// Whether the highest occupied voxel of a cell, whose centre lies at `top_m`, is an obstacle.
    fn stands_out(&self, index: usize, top_m: f64, floor: Option<f32>) -> bool {
        let cols = self.view.cells.cols();
        let cell = Cell::new((index % cols) as i32, (index / cols) as i32);
        let level = floor.or_else(|| self.floor_beside(cell));
        let limit_m = level.map_or(f64::NEG_INFINITY, |h| f64::from(h) + self.config.delta);
        top_m > limit_m && !self.is_passed_under(cell)
    }

    /// The highest floor beside a cell without one, as far as it counts for it, m.
    pub(crate) fn floor_beside(&self, cell: Cell) -> Option<f32> {
        self.floor.highest_around(cell, self.cells_beside())
    }

    /// Cells to each side of one without a floor whose floor counts for it.
    fn cells_beside(&self) -> i32 {
        (self.config.floor_beside / self.config.cell).round() as i32
    }

    /// Moves the window to the robot, and the view with it; the cells of the view that this may have changed.
    fn follow(&mut self, robot_m: [f64; 3]) -> CellArea {
        let [cols, rows] = self.window.follow(robot_m);
        let layers = self.layers.follow(robot_m[2]);
        if [cols, rows, layers] == [0; 3] {
            return CellArea::EMPTY;
        }
        let lattice = self.window.lattice();
        self.occupancy.shift(cols, rows, layers);
        self.occupancy.place(lattice, self.layers.bottom_m());
        self.floor.shift(cols, rows, lattice);
        self.rough.shift(cols, rows);
        self.underfoot.shift(cols, rows);
        self.overhead.shift(cols, rows, layers);
        self.view.shift(cols, rows, lattice);
        let all = self.view.cells.area();
        if layers != 0 {
            self.floor.verify(&self.occupancy, all);
            return self.refresh(all);
        }
        // Their neighbours may have left the window.
        for side in all.rim(self.cells_beside()) {
            let _ = self.refresh(side);
        }
        all
    }

    /// A point and the known floor of its cell.
    fn pair(&self, point: &LabelledPoint, index: usize) -> Option<Pair> {
        let height_m = f64::from(self.floor.height_at(index)?);
        let sightings = self.floor.all_sightings()[index];
        Some(Pair {
            residual_m: height_m - point.floor_height_m,
            // A patch that a few frames got wrong does not pull up what it borders on. What was only seen from afar has no
            // sighting, but is better than nothing.
            weight: u64::from(sightings.max(1)),
        })
    }

    /// Takes in the frame that was read, in the paper's order (section III.A): rays, equations (8) and (9); the cells that this touched.
    fn take_in(&mut self, planes: &Planes, map_from_robot: &Pose<Map, Robot>) -> CellArea {
        let config = &self.config;
        let size = self.view.size();
        self.frame.locate(&self.view.lattice, size);
        let map = (&self.view, &self.occupancy);
        let (eye_m, around) = (self.frame.eye_m, &mut self.surroundings);
        let shadow = Shadow::new(eye_m, config.shadow, map, around);
        self.frame
            .disbelieve(|at_m, index| shadow.holds(at_m, index));
        let mut touched = occupy(&mut self.occupancy, &self.frame, config);
        self.floor.verify(&self.occupancy, touched);
        self.floor
            .update(&self.frame, &self.occupancy, config.update);
        let judged = self.rough.take(&self.frame);
        self.floor.forget(judged, |cell| self.rough.is_rough(cell));
        touched.join(judged);
        touched.join(self.look_overhead(planes, map_from_robot));
        touched
    }

    /// Brings the view up to date where an area in which floors or voxels changed reaches to, and says where that is.
    fn refresh(&mut self, area: CellArea) -> CellArea {
        let all = self.view.cells.area();
        let reached = area.grown(self.cells_beside()).within(all);
        let size = self.view.size();
        for index in runs(reached, size).flatten() {
            let surface = self.surface_at(index);
            self.view.cells.values_mut()[index] = surface;
            self.view.head.values_mut()[index] = self.head_at(index, surface);
            self.view.sightings.values_mut()[index] = self.floor.all_sightings()[index];
            self.view.gradients.values_mut()[index] = match self.view.cells.values()[index] {
                Surface::Floor(_) => self.floor.gradient_at(index),
                Surface::Obstacle(_) | Surface::Unknown => [0.0; 2],
            };
        }
        reached
    }
}

/// Takes the lines of sight of a frame into the occupancy grid; the cells that they touched.
fn occupy(occupancy: &mut OccupancyGrid, frame: &LabelledFrame, config: &FogConfig) -> CellArea {
    let (eye_m, rays) = (frame.eye_m, frame.rays());
    let (update, clearing) = (config.update, config.clearing);
    if let Some(picture) = &frame.picture {
        occupancy.insert_picture(eye_m, picture, rays, update, clearing)
    } else {
        occupancy.insert(eye_m, rays.map(|(_, ray)| ray), update, clearing)
    }
}

impl WorldModel for Fog {
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
        self.level_m = robot_m[2];
        let moved = self.follow(robot_m);
        let mut changed = self.underfoot.stand(robot_m, &self.view.lattice);
        if let Some(headroom_m) = self.config.headroom {
            let heights = self.heights();
            (self.overhead).stand(changed, &heights, robot_m[2], headroom_m);
        }

        let config = &self.config;
        let reading = Reading {
            snap_stretch: config.snap.then_some(config.tuning.snap_stretch),
            max_range_m: config.max_range,
            sure_range_m: config.sure_range,
            delta_m: config.delta,
            rough: config.rough.map_or(f32::INFINITY, |rough| rough as f32),
        };
        self.frame.read(planes, map_from_robot, reading);
        let locator = Locator::of_cells(&self.view.lattice, self.view.size());
        let mut pairs = std::mem::take(&mut self.pairs);
        let pair = |point: &LabelledPoint| {
            let [x_m, y_m, _] = point.position_m;
            self.pair(point, locator.index_at([x_m, y_m])?)
        };
        // The ground that the robot stands on tells a frame's height best. To fit that frame to floor that was seen from far before
        // would carry the errors of that from level to level.
        let shift = if planes.ground.is_some() {
            None
        } else {
            height_shift(
                self.frame.points.iter().filter_map(pair),
                (config.match_gate, config.min_pairs),
                &config.tuning.matching,
                &mut pairs,
            )
        };
        self.pairs = pairs;
        let used = planes.reliable || shift.is_some();
        if used {
            if let Some(shift_m) = shift {
                self.frame.raise(shift_m);
            }
            changed.join(self.take_in(planes, map_from_robot));
        }
        changed = self.refresh(changed);
        changed.join(moved);
        Ok(Insertion {
            changed,
            height_shift_m: shift.filter(|_| used),
            used,
        })
    }

    fn view(&self) -> &FloorView {
        &self.view
    }

    fn ceilings(&self) -> Option<Grid<f32>> {
        let mut ceilings = Grid::filled(self.config.cells, self.config.cells, f32::NAN);
        for cell in ceilings.area().cells() {
            if let (Some(height_m), Some(slot)) = (self.ceiling_m(cell), ceilings.get_mut(cell)) {
                *slot = height_m as f32;
            }
        }
        Some(ceilings)
    }
}
