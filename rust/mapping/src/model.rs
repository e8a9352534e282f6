//! What every world model does: take in a frame, say what changed, show floors, obstacles and the unknown.

use std::borrow::Cow;

use geometry::{Cell, CellArea, Grid, Lattice, Map, Pose, Robot};
use meshes::TriangleMesh;
use segmentation::Planes;

use crate::bevel::Bevel;
use crate::felt_place::FeltPlace;
use crate::foreseen_place::ForeseenPlace;

/// Why a frame could not be inserted. The map is unchanged.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MapError {
    /// A pose with a component that is no number.
    #[error("the robot's pose must be finite")]
    PoseNotFinite,
    /// A world model of the user's failed.
    #[error("{0}")]
    Failed(String),
}

/// What is at a place, seen from above: equation (5) of 000.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Surface {
    /// Not seen yet, or no longer sure.
    #[default]
    Unknown,
    /// A flat surface to step on, at this height in the map frame, m.
    Floor(f32),
    /// Something to keep away from; its top at this height in the map frame, m, as coarse as the model is.
    Obstacle(f32),
}

/// What is known of the room above a cell's floor, up to the robot's head.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum HeadRoom {
    /// There is room, or nobody asks.
    #[default]
    Free,
    /// The floor was seen, but not all that may hang above it.
    Unseen,
    /// Something hangs lower than the robot needs. The cell is an obstacle because of that alone.
    Low {
        /// Height of the floor in the map frame, m; NaN where it was not seen, and the room is that above the robot's own level.
        floor_m: f32,
        /// From there to what hangs, m.
        room_m: f32,
    },
}

/// The floor, obstacle and unknown view that planners read. Cells are fixed to the map; the window moves with the robot.
#[derive(Debug, Clone, PartialEq)]
pub struct FloorView {
    /// Where the cells lie in the map frame.
    pub lattice: Lattice,
    /// What is in each cell.
    pub cells: Grid<Surface>,
    /// How many frames saw each cell as floor, from where the model is sure of it (saturating); judged by the score, of use to
    /// planners.
    pub sightings: Grid<u16>,
    /// How sure each cell's height is, as a standard deviation, m; 0 where the model does not say: then it counts as it is.
    pub sigmas_m: Grid<f32>,
    /// How much each cell's floor rises per metre along the map's axes: nothing where it is level.
    pub gradients: Grid<[f32; 2]>,
    /// Floor that rises by less per metre is level ground seen a little wrong.
    pub least_gradient: f64,
    /// What is known of the room above each cell's floor.
    pub head: Grid<HeadRoom>,
    /// Where the feet met something, in the order in which they did.
    pub felt: Vec<FeltPlace>,
}

impl FloorView {
    /// A window of these cells, each seen so often, with all of its floors level; of gradients that are set later each one counts.
    pub fn new(lattice: Lattice, cells: Grid<Surface>, sightings: u16) -> Self {
        let (cols, rows) = (cells.cols(), cells.rows());
        Self {
            lattice,
            cells,
            sightings: Grid::filled(cols, rows, sightings),
            sigmas_m: Grid::filled(cols, rows, 0.0),
            gradients: Grid::filled(cols, rows, [0.0; 2]),
            least_gradient: 0.0,
            head: Grid::filled(cols, rows, HeadRoom::Free),
            felt: Vec::new(),
        }
    }

    /// A square window of which nothing is known.
    pub(crate) fn unknown(lattice: Lattice, cells: usize) -> Self {
        Self::new(lattice, Grid::filled(cells, cells, Surface::Unknown), 0)
    }

    /// Moves the window by whole cells to where `lattice` lies.
    pub(crate) fn shift(&mut self, cols: i32, rows: i32, lattice: Lattice) {
        self.cells.shift(cols, rows, &Surface::Unknown);
        self.sightings.shift(cols, rows, &0);
        self.sigmas_m.shift(cols, rows, &0.0);
        self.gradients.shift(cols, rows, &[0.0; 2]);
        self.head.shift(cols, rows, &HeadRoom::Free);
        self.lattice = lattice;
    }

    /// Columns and rows.
    pub(crate) const fn size(&self) -> [usize; 2] {
        [self.cells.cols(), self.cells.rows()]
    }

    /// Sets what is in a cell, and how often it was seen.
    pub(crate) fn set(&mut self, cell: Cell, surface: Surface, sightings: u16) {
        if let (Some(slot), Some(count)) = (self.cells.get_mut(cell), self.sightings.get_mut(cell))
        {
            (*slot, *count) = (surface, sightings);
        }
    }

    /// What is at a point of the map frame; unknown outside the window.
    pub fn at(&self, x_m: f64, y_m: f64) -> Surface {
        self.cells
            .get(self.lattice.cell_at(x_m, y_m))
            .copied()
            .unwrap_or_default()
    }

    /// How much the floor at a point of the map frame rises per metre along the map's axes; nothing where it is level, as far as
    /// can be told.
    pub fn gradient_at(&self, x_m: f64, y_m: f64) -> [f64; 2] {
        let cell = self.lattice.cell_at(x_m, y_m);
        let gradient = self.gradients.get(cell).copied().unwrap_or_default();
        let gradient = gradient.map(f64::from);
        if geometry::hypot(gradient[0], gradient[1]) < self.least_gradient {
            [0.0; 2]
        } else {
            gradient
        }
    }

    /// What is known of the room above the floor at a point of the map frame.
    pub fn head_at(&self, x_m: f64, y_m: f64) -> HeadRoom {
        let cell = self.lattice.cell_at(x_m, y_m);
        self.head.get(cell).copied().unwrap_or_default()
    }

    /// The view as it were for a robot that needs no room for its head; `None` where that is no other.
    pub fn without_ceilings(&self) -> Option<Self> {
        let low = |head: &HeadRoom| matches!(head, HeadRoom::Low { .. });
        if !self.head.values().iter().any(low) {
            return None;
        }
        let mut view = self.clone();
        let cells = view.cells.values_mut().iter_mut();
        for (surface, head) in cells.zip(view.head.values_mut()) {
            if let HeadRoom::Low { floor_m, .. } = *head {
                let floor = Some(floor_m).filter(|floor_m| !floor_m.is_nan());
                *surface = floor.map_or(Surface::Unknown, Surface::Floor);
                *head = HeadRoom::Free;
            }
        }
        Some(view)
    }

    /// The view with an obstacle where the feet met something that is higher than what was seen there.
    pub fn shown(&self) -> Cow<'_, Self> {
        let mut shown = Cow::Borrowed(self);
        for felt in &self.felt {
            for cell in felt.cells(self.lattice) {
                let top = felt.top_m as f32;
                let as_high = match self.cell(cell) {
                    Surface::Obstacle(_) => true,
                    Surface::Floor(height) => height >= top,
                    Surface::Unknown => false,
                };
                if !as_high && let Some(slot) = shown.to_mut().cells.get_mut(cell) {
                    *slot = Surface::Obstacle(top);
                }
            }
        }
        shown
    }

    /// The view as it were had the feet met nothing; `None` where they did not.
    pub fn without_felt(&self) -> Option<Self> {
        (!self.felt.is_empty()).then(|| Self {
            felt: Vec::new(),
            ..self.clone()
        })
    }

    /// What is in a cell; unknown outside the window.
    pub fn cell(&self, cell: Cell) -> Surface {
        self.cells.get(cell).copied().unwrap_or_default()
    }
}

/// What inserting a frame did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Insertion {
    /// Cells of the view that may have changed.
    pub changed: CellArea,
    /// Height by which the frame was shifted to fit the floor that is known, m, where there was enough to match.
    pub height_shift_m: Option<f64>,
    /// Whether the frame was used, or withdrawn as unreliable.
    pub used: bool,
}

/// A cube of space that something is in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Voxel {
    /// Its middle in the map frame, m.
    pub centre_m: [f64; 3],
    /// Its side, m.
    pub side_m: f64,
}

/// Keeps a model of the world.
pub trait WorldModel: Send + Sync {
    /// Moves the window to the robot, takes in one frame seen from `map_from_robot`, and says what changed.
    fn insert(
        &mut self,
        planes: &Planes,
        map_from_robot: &Pose<Map, Robot>,
    ) -> Result<Insertion, MapError>;

    /// The floor, obstacle and unknown view, as of the last insertion.
    fn view(&self) -> &FloorView;

    /// Whether it takes the frame's surfaces, not its points alone: such a model has no use for points of which no surfaces are known.
    fn needs_surfaces(&self) -> bool {
        true
    }

    /// Takes in what a foot met. A model by itself knows only what is seen; [`Overlay`](crate::Overlay) keeps it for any.
    fn feel(&mut self, _felt: FeltPlace) {}

    /// Takes in where short slopes are, all that are known. A model by itself knows none; [`Overlay`](crate::Overlay) keeps them for any.
    fn lay(&mut self, _bevels: &[Bevel]) {}

    /// Takes in where things that move will be, all that are foreseen. A model by itself knows none; [`Overlay`](crate::Overlay) shows them as obstacles
    /// until the next time.
    fn foresee(&mut self, _places: &[ForeseenPlace]) {}

    /// The robot goes for its next goal: what was seen blocked may be free again. A model by itself keeps no states;
    /// [`Overlay`](crate::Overlay) does.
    fn doubt(&mut self) {}

    /// Drops what was seen: the robot found itself at another place than it had believed.
    fn forget(&mut self) {}

    /// For each cell of the view the height at which what hangs above its floor begins, m in the map frame, as coarse as the
    /// model is; NaN where nothing is known to. `None` from a model that keeps no ceilings. Made anew at each call.
    fn ceilings(&self) -> Option<Grid<f32>> {
        None
    }

    /// What was seen to be occupied, of a model that keeps the space in three dimensions. Made anew at each call.
    fn occupied(&self) -> Vec<Voxel> {
        Vec::new()
    }

    /// The surface that was seen, as triangles in the map frame, of a model that keeps such. Made anew at each call.
    fn surface(&self) -> Option<TriangleMesh> {
        None
    }
}
