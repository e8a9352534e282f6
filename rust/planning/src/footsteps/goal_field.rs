//! What the way to the goal costs at least, s, over coarse cells: it leads the search for footsteps.

use geometry::{Cell, CellArea, Dijkstra, Goal, Grid, Lattice, PlanarPose, same_level};
use mapping::HeightMap;
use terrain::footholds::HighBlocks;

use super::config::FootstepsConfig;
use super::field_steps::{Prices, steps};
use super::limits::StepLimits;
use super::question::FootstepQuestion;
use super::unseen::{Unseen, guess_levels, smooth_levels};

/// A field that is rooted at the goal.
#[derive(Debug, Clone, Default)]
pub(super) struct GoalField {
    pub(super) lattice: Lattice,
    pub(super) cols: i32,
    pub(super) rows: i32,
    /// Height of each cell's middle, m; NaN where nothing is known of it, infinite where the body has no room.
    pub(super) levels_m: Vec<f32>,
    /// Whether each cell was not seen: its level is guessed.
    pub(super) unseen: Vec<bool>,
    /// Whether each cell is the end of what a plan can tell: it was not seen, or levels meet in it nobody knows just where, or the map ends there and
    /// the goal lies beyond.
    pub(super) exits: Vec<bool>,
    /// Whether so much of the ground around a cell lies on its level that a sole finds support there.
    carries: Vec<bool>,
    /// What the way from each cell costs, s; infinite where nothing leads on.
    pub(super) costs_s: Vec<f32>,
    /// Whether ground at the goal was seen.
    goal_seen: bool,
    dijkstra: Dijkstra,
    speed_mps: f64,
    /// What the way from the start costs; it is no less from where no cost was found.
    farthest_s: f32,
}

impl GoalField {
    /// Finds the costs of the ways to a goal that are no longer than that from a start. False where nothing is known of the ground at the
    /// goal, and that counts.
    pub(super) fn find(
        &mut self,
        (map, blocks): (&HeightMap, &HighBlocks),
        (config, limits): (&FootstepsConfig, &StepLimits),
        (start, goal): (&PlanarPose, &Goal),
        question: &FootstepQuestion<'_>,
    ) -> bool {
        self.read_levels((map, blocks), config, limits);
        self.unseen.clear();
        self.unseen
            .extend(self.levels_m.iter().map(|level_m| level_m.is_nan()));
        let leads_there = question.unseen != Unseen::Closed;
        if leads_there {
            self.tell_goals_level(goal);
            let guessed: Vec<bool> = self
                .levels_m
                .iter()
                .map(|level_m| level_m.is_nan())
                .collect();
            guess_levels(&mut self.levels_m, self.cols);
            smooth_levels(&mut self.levels_m, &guessed, self.cols, config.guess_rounds);
        }
        self.read_exits(map, config.walk_height as f32, question.vain_m);
        self.speed_mps = limits.speed_mps();
        self.costs_s.clear();
        self.costs_s.resize(self.levels_m.len(), f32::INFINITY);
        self.dijkstra.clear();
        let mut known = false;
        self.goal_seen = false;
        for row in 0..self.rows {
            for col in 0..self.cols {
                let node = (row * self.cols + col) as u32;
                if self.is_at_goal(node, goal) && !self.levels_m[node as usize].is_nan() {
                    known = true;
                    self.goal_seen |= !self.unseen[node as usize];
                    self.dijkstra.begin_at(&mut self.costs_s, node, 0.0);
                }
            }
        }
        let prices = Prices::of(config, limits, self.lattice.cell_m);
        if leads_there && !known {
            known = self.begin_at_rim(goal, &prices);
        }
        let Self {
            dijkstra,
            costs_s,
            levels_m,
            carries,
            unseen,
            cols,
            rows,
            ..
        } = self;
        let ground = (levels_m.as_slice(), carries.as_slice(), unseen.as_slice());
        let steps = |from: u32| steps((from, *cols, *rows), ground, &prices);
        let start = self.lattice.cell_at(start.x_m, start.y_m);
        let col = start.col.clamp(0, (*cols - 1).max(0));
        let row = start.row.clamp(0, (*rows - 1).max(0));
        if known {
            let node = (row * *cols + col) as u32;
            dijkstra.run_to(costs_s, node, steps);
            self.farthest_s = costs_s[node as usize];
        }
        known
    }

    /// Whether ground at the goal was seen when the costs were found last.
    pub(super) const fn is_goal_seen(&self) -> bool {
        self.goal_seen
    }

    /// What the way from a place costs at least, s: infinite where there is none.
    pub(super) fn remaining_s(&self, x_m: f64, y_m: f64) -> f64 {
        let half_m = 0.5 * self.lattice.cell_m;
        let first = self.lattice.cell_at(x_m - half_m, y_m - half_m);
        let mut least_s = f64::INFINITY;
        for (right, up) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let cell = Cell::new(first.col + right, first.row + up);
            if (0..self.cols).contains(&cell.col) && (0..self.rows).contains(&cell.row) {
                let node = (cell.row * self.cols + cell.col) as usize;
                let cost_s = self.costs_s[node].min(self.farthest_s);
                let [center_x_m, center_y_m] = self.lattice.center_of(cell);
                let to_m = geometry::hypot(center_x_m - x_m, center_y_m - y_m);
                least_s = least_s.min(f64::from(cost_s) + to_m / self.speed_mps);
            }
        }
        least_s
    }

    /// Whether a cell lies at the goal: its own one does whatever its radius.
    fn is_at_goal(&self, node: u32, goal: &Goal) -> bool {
        let cell = Cell::new(node as i32 % self.cols, node as i32 / self.cols);
        let from_m = geometry::distance_m(self.lattice.center_of(cell), [goal.x_m, goal.y_m]);
        from_m <= goal.radius_m.max(self.lattice.cell_m)
    }

    /// Where the ground at the goal was not seen it is as high as was told, if anything was.
    fn tell_goals_level(&mut self, goal: &Goal) {
        let Some(height_m) = goal.height_m else {
            return;
        };
        for node in 0..self.levels_m.len() {
            if self.unseen[node] && self.is_at_goal(node as u32, goal) {
                self.levels_m[node] = height_m as f32;
            }
        }
    }

    /// Begins at the cells along the rim, each as far from the goal as the straight way is, and the climb to its level: the goal lies beyond.
    fn begin_at_rim(&mut self, goal: &Goal, prices: &Prices) -> bool {
        let mut any = false;
        for node in 0..self.levels_m.len() {
            let (col, row) = (node as i32 % self.cols, node as i32 / self.cols);
            let inside = (1..self.cols - 1).contains(&col) && (1..self.rows - 1).contains(&row);
            if inside || !self.levels_m[node].is_finite() {
                continue;
            }
            let [x_m, y_m] = self.lattice.center_of(Cell::new(col, row));
            let to_m = geometry::hypot(x_m - goal.x_m, y_m - goal.y_m);
            let rise_m = (goal.height_m).map_or(0.0, |height_m| {
                (height_m as f32 - self.levels_m[node]).abs()
            });
            let cost_s = (to_m / self.speed_mps) as f32 + prices.unseen_climb_s(rise_m);
            self.dijkstra
                .begin_at(&mut self.costs_s, node as u32, cost_s);
            self.exits[node] = true;
            any = true;
        }
        any
    }

    fn read_levels(
        &mut self,
        (map, blocks): (&HeightMap, &HighBlocks),
        config: &FootstepsConfig,
        limits: &StepLimits,
    ) {
        let side = (config.field_cell / map.lattice.cell_m).round().max(1.0) as i32;
        let heights_m: &Grid<f32> = map.heights_m();
        self.lattice = Lattice {
            origin_m: map.lattice.origin_m,
            cell_m: f64::from(side) * map.lattice.cell_m,
        };
        let count = |cells: usize| cells.div_ceil(side as usize) as i32;
        (self.cols, self.rows) = (count(heights_m.cols()), count(heights_m.rows()));
        self.levels_m.clear();
        self.carries.clear();
        for row in 0..self.rows {
            for col in 0..self.cols {
                let level_m = level_of(map, Cell::new(col * side, row * side), side);
                let [x_m, y_m] = self.lattice.center_of(Cell::new(col, row));
                let body_m = level_m + limits.body_from_m as f32;
                let no_room = level_m <= HeightMap::BOTTOMLESS_M
                    || blocks.is_higher_within(map, [x_m, y_m], limits.body_radius_m, body_m);
                self.levels_m
                    .push(if no_room { f32::INFINITY } else { level_m });
            }
        }
        self.read_what_carries(map, config, limits);
    }

    /// Where all around is level, a sole stands; elsewhere the map is asked.
    fn read_what_carries(
        &mut self,
        map: &HeightMap,
        config: &FootstepsConfig,
        limits: &StepLimits,
    ) {
        let walk_m = config.walk_height as f32;
        let (levels_m, cols, rows) = (&self.levels_m, self.cols, self.rows);
        for row in 0..rows {
            for col in 0..cols {
                let level_m = levels_m[(row * cols + col) as usize];
                let around = |cell: Cell| {
                    let inside = (0..cols).contains(&cell.col) && (0..rows).contains(&cell.row);
                    !inside
                        || same_level(
                            levels_m[(cell.row * cols + cell.col) as usize],
                            level_m,
                            walk_m,
                        )
                };
                let level = CellArea::of(Cell::new(col, row))
                    .grown(1)
                    .cells()
                    .all(around);
                let carries = level || {
                    let middle_m = self.lattice.center_of(Cell::new(col, row));
                    let sole_m = 0.5 * limits.sole.length_m;
                    share_on_level(map, middle_m, sole_m, (level_m, walk_m))
                        >= config.foothold.least_bearing
                };
                self.carries.push(carries);
            }
        }
    }
}

/// Height of the middle of a coarse cell, m; where that was not seen, the mean of what was.
fn level_of(map: &HeightMap, first: Cell, side: i32) -> f32 {
    let middle = Cell::new(first.col + side / 2, first.row + side / 2);
    let known_m = map.height_m(middle).or_else(|| map.blurred_m(middle));
    known_m.unwrap_or_else(|| {
        let area = CellArea {
            min: first,
            max: Cell::new(first.col + side - 1, first.row + side - 1),
        };
        let seen = area.cells().filter_map(|cell| map.height_m(cell));
        let (count, sum_m) = seen.fold((0.0, 0.0), |(count, sum), height| {
            (count + 1.0, sum + height)
        });
        sum_m / count
    })
}

/// Share of what lies within a distance of a place that is on a level.
fn share_on_level(
    map: &HeightMap,
    [x_m, y_m]: [f64; 2],
    radius_m: f64,
    (level_m, within_m): (f32, f32),
) -> f64 {
    let lattice = &map.lattice;
    let [low, high] = [-radius_m, radius_m].map(|off_m| lattice.cell_at(x_m + off_m, y_m + off_m));
    let (mut all, mut on_level) = (0, 0);
    for row in low.row..=high.row {
        let [first_x_m, row_y_m] = lattice.center_of(Cell::new(0, row));
        let (across_m, off_m) = (row_y_m - y_m, x_m - first_x_m);
        let half_m = (radius_m * radius_m - across_m * across_m).max(0.0).sqrt();
        // The cells of the row whose middles lie within the circle.
        let first = ((off_m - half_m) / lattice.cell_m).ceil() as i32;
        let last = ((off_m + half_m) / lattice.cell_m).floor() as i32;
        let heights_m = map.heights_m().row(row, first..last.saturating_add(1));
        let level = |height_m: &&f32| same_level(**height_m, level_m, within_m);
        all += heights_m.len();
        on_level += heights_m.iter().filter(level).count();
    }
    on_level as f64 / all.max(1) as f64
}
