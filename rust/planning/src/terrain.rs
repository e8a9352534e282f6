//! What a cell costs: obstacles, steps, clearance, the unknown.

use geometry::{Cell, Lattice};
use mapping::FloorView;
use stairs::Staircase;

use crate::AStarConfig;
use crate::distance::{DistanceField, NOTHING_NEAR};
use crate::judged::Judged;
use crate::levels::{Levels, Limits, Stand};
use crate::slits::Rectangle;
use crate::specks::Specks;
use crate::treads::Treads;
use crate::verge::{Seen, Verge};
use crate::voronoi::VoronoiField;

/// Room that the robot needs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Needs {
    /// Around its middle, to obstacles, m.
    pub(crate) body_m: f64,
    /// Around the middle between its feet, to edges of the level, m.
    pub(crate) feet_m: f64,
    /// Of the ground that it walks on.
    pub(crate) limits: Limits,
    /// To obstacles while it walks sideways, where it may.
    pub(crate) turned: Option<Rectangle>,
}

/// The floor view as the planner reads it, row by row. Reused.
#[derive(Debug, Clone)]
pub(crate) struct Terrain {
    pub(crate) lattice: Lattice,
    pub(crate) cols: usize,
    pub(crate) rows: usize,
    /// Obstacles.
    pub(crate) blocked: Vec<bool>,
    pub(crate) unknown: Vec<bool>,
    /// To obstacles.
    pub(crate) distance: DistanceField,
    pub(crate) needs: Needs,
    pub(crate) levels: Levels,
    /// Distance to the nearest obstacle where the robot stands, m: there it is.
    pub(crate) clearance_at_start_m: f64,
    edge_distance: DistanceField,
    treads: Treads,
    pub(crate) judged: Judged,
    verge: Verge,
    /// Where the way is to keep to the lines with most room.
    pub(crate) voronoi: Option<VoronoiField>,
    /// What a length costs in a cell: 1 on open known floor, infinite where the robot may not be.
    pub(crate) weights: Vec<f32>,
    specks: Specks,
    /// Weight of a cell by its squared distance to what is blocked, in cells.
    by_squared: Vec<f32>,
    /// The same for edges.
    by_edge_squared: Vec<f32>,
}

impl Terrain {
    pub(crate) fn new(needs: Needs) -> Self {
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
            needs,
            clearance_at_start_m: 0.0,
            levels: Levels::default(),
            edge_distance: DistanceField::default(),
            treads: Treads::default(),
            judged: Judged::default(),
            verge: Verge::default(),
            voronoi: None,
            weights: Vec::new(),
            specks: Specks::default(),
            by_squared: Vec::new(),
            by_edge_squared: Vec::new(),
        }
    }

    /// Reads a view and the stairs for a robot that stands at `stand` and needs this room; `goal_m`: the goal's height.
    pub(crate) fn read(
        &mut self,
        view: &FloorView,
        stairs: &Staircase,
        stand: &Stand,
        goal_m: Option<f64>,
        config: &AStarConfig,
    ) {
        self.lattice = view.lattice;
        (self.cols, self.rows) = (view.cells.cols(), view.cells.rows());
        self.treads.read(view, stairs, self.needs.limits.step_m);
        let (blocked, unknown) = (&mut self.blocked, &mut self.unknown);
        self.treads.read_surfaces(view, blocked, unknown);
        let floor_m = self.needs.limits.floor_m;
        self.judged.look(view, stand.at_m);
        let (seen, range_m) = ((view, &self.treads), config.judge_range);
        self.judged
            .doubt(seen, range_m, (stand, floor_m), blocked, unknown);
        self.specks
            .clear(blocked, unknown, self.cols, config.speck_cells);
        let limits = &self.needs.limits;
        let seen = (view, self.unknown.as_slice());
        self.levels
            .read(seen, &mut self.treads, stand, limits, config);
        let heights = stairs.stairs.iter().map(stairs::Stair::height_m);
        let lowest_m = heights.chain(goal_m).fold(f64::INFINITY, f64::min);
        if self.levels.raised(stand, lowest_m, config) {
            let on_tread = self
                .index_at(stand.at_m)
                .is_some_and(|start| self.treads.covers(start));
            let blind_m = if on_tread { 0.0 } else { config.blind };
            let seen = Seen {
                view,
                blocked: &self.blocked,
                unknown: &self.unknown,
            };
            self.verge
                .mark(&mut self.levels, &seen, stand, config.max_step, blind_m);
        }
        self.block_tall(stand);
        self.distance.compute(&self.blocked, self.cols);
        if self.levels.any {
            self.edge_distance.compute(&self.levels.edge, self.cols);
        }
        self.weigh(config);
        if let Some(start) = self.index_at(stand.at_m) {
            self.clearance_at_start_m = self.clearance_m(start);
        }
        if !self.is_in_slit(stand, config) {
            self.open_escape(stand.at_m, config);
        }
    }

    /// What ends higher above the robot's feet than a step is an obstacle to its body, flat as its top may be, unless it is part of a
    /// staircase.
    fn block_tall(&mut self, stand: &Stand) {
        let highest_m = stand.height_m + self.needs.limits.step_m;
        for (index, &edge) in self.levels.edge.iter().enumerate() {
            let tall = f64::from(self.levels.height_m[index]) > highest_m;
            if edge && tall && !self.treads.is_near_climbable(index) {
                self.blocked[index] = true;
            }
        }
    }

    /// What a length costs, by clearance and what is unseen.
    fn weigh(&mut self, config: &AStarConfig) {
        let cell_m = self.lattice.cell_m;
        fill(
            &mut self.by_squared,
            self.needs.body_m,
            config.soft_range,
            config,
            |cells| cells * cell_m,
        );
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
        if let Some(field) = &mut self.voronoi {
            field.weigh(&mut self.weights, &self.distance, (self.cols, cell_m));
        }
        if self.levels.any {
            let soft_m = 0.5 * config.soft_range;
            let table = &mut self.by_edge_squared;
            fill(table, self.needs.feet_m, soft_m, config, |cells| {
                (cells + 0.5) * cell_m
            });
            let furthest = table.len() - 1;
            let squared = self.edge_distance.all_squared();
            for (weight, &squared) in self.weights.iter_mut().zip(squared) {
                *weight += table[furthest.min(squared as usize)] - 1.0;
            }
            for (weight, &edge) in self.weights.iter_mut().zip(&self.levels.edge) {
                if edge {
                    *weight = f32::INFINITY;
                }
            }
        }
    }

    /// Where the robot already stands too near to something it may leave, but come no nearer.
    pub(crate) fn open_escape(&mut self, start_m: [f64; 2], config: &AStarConfig) {
        let Some(start) = self.index_at(start_m) else {
            return;
        };
        let Needs { body_m, feet_m, .. } = self.needs;
        let (at_start_m, to_edge_m) = (self.clearance_m(start), self.edge_clearance_m(start));
        if at_start_m >= body_m && to_edge_m >= feet_m {
            return;
        }
        let half_m = 0.5 * self.lattice.cell_m;
        let least_m = (at_start_m - half_m).min(body_m);
        let least_edge_m = (to_edge_m - half_m).min(feet_m);
        for index in 0..self.weights.len() {
            let near = || {
                let [x, y] = self.center_m(index);
                (x - start_m[0]).hypot(y - start_m[1]) <= config.escape_range
            };
            let no_ground = self.blocked[index] || self.levels.edge[index];
            let barred = self.weights[index].is_infinite() && !no_ground;
            if barred
                && near()
                && self.clearance_m(index) >= least_m
                && self.edge_clearance_m(index) >= least_edge_m
            {
                self.weights[index] = 1.0 + config.escape_cost as f32;
            }
        }
    }

    /// Distance from a cell's centre to the nearest edge of a level, m: the edge lies between the cells beside it.
    pub(crate) fn edge_clearance_m(&self, index: usize) -> f64 {
        if !self.levels.any || self.edge_distance.squared(index) == NOTHING_NEAR {
            return f64::from(u16::MAX);
        }
        let cells = f64::from(self.edge_distance.squared(index)).sqrt();
        (cells + 0.5) * self.lattice.cell_m
    }

    /// Whether a cell lies at the end of a level with nothing known behind it, or at an edge that is no stair's.
    pub(crate) fn is_open_edge(&self, index: usize) -> bool {
        self.levels.open[index] && !self.treads.is_near(index)
    }

    /// Height of a cell, m, where one is known.
    pub(crate) fn level_m(&self, index: usize) -> Option<f64> {
        let height = self.levels.height_m[index];
        (!height.is_nan()).then(|| f64::from(height))
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

/// Weights by squared distance in cells, as far as being near costs anything; `clearance_m` of a distance in cells.
fn fill(
    table: &mut Vec<f32>,
    needed_m: f64,
    soft_m: f64,
    config: &AStarConfig,
    clearance_m: impl Fn(f64) -> f64,
) {
    table.clear();
    for squared in 0_u32.. {
        let clearance_m = clearance_m(f64::from(squared).sqrt());
        let weight = config.weight(clearance_m - needed_m, soft_m) as f32;
        let allowed = clearance_m >= needed_m;
        table.push(if allowed { weight } else { f32::INFINITY });
        if allowed && weight <= 1.0 {
            break;
        }
    }
}
