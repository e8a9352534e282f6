//! What a cell costs: obstacles, steps, clearance, the unknown.

use geometry::{Cell, Lattice};
use mapping::{FloorView, Surface};

use crate::AStarConfig;
use crate::distance::{DistanceField, NOTHING_NEAR};
use crate::specks::Specks;

/// The floor view as the planner reads it, row by row. Reused.
#[derive(Debug, Clone)]
pub(crate) struct Terrain {
    pub(crate) lattice: Lattice,
    pub(crate) cols: usize,
    pub(crate) rows: usize,
    /// Obstacles, and cells at a step.
    pub(crate) blocked: Vec<bool>,
    pub(crate) unknown: Vec<bool>,
    pub(crate) distance: DistanceField,
    /// What a length costs in a cell: 1 on open known floor, infinite where the robot may not be.
    pub(crate) weights: Vec<f32>,
    specks: Specks,
    /// Weight of a cell by its squared distance to what is blocked, in cells.
    by_squared: Vec<f32>,
}

impl Terrain {
    pub(crate) fn new() -> Self {
        Self {
            lattice: Lattice {
                origin_m: [0.0; 2],
                cell_m: 1.0,
            },
            cols: 0,
            rows: 0,
            blocked: Vec::new(),
            unknown: Vec::new(),
            distance: DistanceField::default(),
            weights: Vec::new(),
            specks: Specks::default(),
            by_squared: Vec::new(),
        }
    }

    /// Reads a view for a robot at `start_m` that needs `needed_m` around its middle.
    pub(crate) fn read(
        &mut self,
        view: &FloorView,
        start_m: [f64; 2],
        needed_m: f64,
        config: &AStarConfig,
    ) {
        let surfaces = view.cells.values();
        self.lattice = view.lattice;
        (self.cols, self.rows) = (view.cells.cols(), view.cells.rows());
        self.blocked.clear();
        self.unknown.clear();
        for surface in surfaces {
            self.blocked.push(matches!(surface, Surface::Obstacle(_)));
            self.unknown.push(matches!(surface, Surface::Unknown));
        }
        let (blocked, unknown) = (&mut self.blocked, &mut self.unknown);
        self.specks
            .clear(blocked, unknown, self.cols, config.speck_cells);
        self.mark_steps(view, config);
        self.distance.compute(&self.blocked, self.cols);
        self.weigh(start_m, needed_m, config);
    }

    /// A step is an obstacle to either side of it.
    fn mark_steps(&mut self, view: &FloorView, config: &AStarConfig) {
        let height = |index: usize| match view.cells.values()[index] {
            Surface::Floor(height) if view.sightings.values()[index] >= config.step_sightings => {
                Some(height)
            }
            _ => None,
        };
        for index in 0..self.blocked.len() {
            let Some(here) = height(index) else { continue };
            let east = (index % self.cols + 1 < self.cols).then_some(index + 1);
            let north = (index + self.cols < self.blocked.len()).then_some(index + self.cols);
            for next in east.into_iter().chain(north) {
                if height(next).is_some_and(|h| f64::from((h - here).abs()) > config.max_step) {
                    self.blocked[index] = true;
                    self.blocked[next] = true;
                }
            }
        }
    }

    /// What a length costs, by clearance, escape and what is unseen.
    fn weigh(&mut self, start_m: [f64; 2], needed_m: f64, config: &AStarConfig) {
        // By squared distance in cells, as far as being near costs anything.
        let reach = ((needed_m + config.soft_range) / self.lattice.cell_m).ceil() as u32;
        self.by_squared.clear();
        for squared in 0..=reach * reach {
            let clearance_m = f64::from(squared).sqrt() * self.lattice.cell_m;
            let spare = (clearance_m - needed_m) / config.soft_range.max(1e-9);
            let near = (1.0 - spare).max(0.0);
            let weight = 1.0 + config.soft_cost * near * near;
            let allowed = clearance_m >= needed_m;
            self.by_squared.push(if allowed {
                weight as f32
            } else {
                f32::INFINITY
            });
        }
        let furthest = self.by_squared.len() - 1;
        self.weights.clear();
        for (&squared, &unknown) in self.distance.all_squared().iter().zip(&self.unknown) {
            let unseen = if unknown {
                config.unknown_cost as f32
            } else {
                0.0
            };
            self.weights
                .push(self.by_squared[furthest.min(squared as usize)] + unseen);
        }
        self.open_escape(start_m, needed_m, config);
    }

    /// Where the robot already stands too near to something it may leave, but come no nearer.
    fn open_escape(&mut self, start_m: [f64; 2], needed_m: f64, config: &AStarConfig) {
        let at_start_m = self
            .index_at(start_m)
            .map_or(needed_m, |i| self.clearance_m(i));
        if at_start_m >= needed_m {
            return;
        }
        let least_m = at_start_m - 0.5 * self.lattice.cell_m;
        for index in 0..self.weights.len() {
            let [x, y] = self.center_m(index);
            let near = (x - start_m[0]).hypot(y - start_m[1]) <= config.escape_range;
            let barred = self.weights[index].is_infinite() && !self.blocked[index];
            if near && barred && self.clearance_m(index) >= least_m {
                self.weights[index] = 1.0 + config.escape_cost as f32;
            }
        }
    }

    /// Distance from a cell's centre to the centre of the nearest blocked cell, m. An obstacle's surface lies anywhere in
    /// its cell, so that this is right on average.
    pub(crate) fn clearance_m(&self, index: usize) -> f64 {
        let squared = self.distance.squared(index);
        if squared == NOTHING_NEAR {
            f64::from(u16::MAX)
        } else {
            f64::from(squared).sqrt() * self.lattice.cell_m
        }
    }

    pub(crate) fn center_m(&self, index: usize) -> [f64; 2] {
        let cell = Cell::new((index % self.cols) as i32, (index / self.cols) as i32);
        self.lattice.center_of(cell)
    }

    pub(crate) fn index_at(&self, point_m: [f64; 2]) -> Option<usize> {
        let cell = self.lattice.cell_at(point_m[0], point_m[1]);
        let (col, row) = (
            usize::try_from(cell.col).ok()?,
            usize::try_from(cell.row).ok()?,
        );
        (col < self.cols && row < self.rows).then(|| row * self.cols + col)
    }

    pub(crate) fn on_border(&self, index: usize) -> bool {
        let (col, row) = (index % self.cols, index / self.cols);
        col == 0 || row == 0 || col + 1 == self.cols || row + 1 == self.rows
    }

    /// What the straight way between two points costs, m; `None` where it may not be walked. Looked at every quarter of a
    /// cell, each piece weighed by the cell of its middle.
    pub(crate) fn straight_cost_m(&self, from: [f64; 2], to: [f64; 2]) -> Option<f64> {
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let pieces = (length / (0.25 * self.lattice.cell_m)).ceil().max(1.0);
        let mut sum = 0.0;
        for piece in 0..pieces as usize {
            let t = (piece as f64 + 0.5) / pieces;
            let at = [
                from[0] + t * (to[0] - from[0]),
                from[1] + t * (to[1] - from[1]),
            ];
            let weight = self.weights[self.index_at(at)?];
            if weight.is_infinite() {
                return None;
            }
            sum += f64::from(weight);
        }
        Some(sum * length / pieces)
    }
}
