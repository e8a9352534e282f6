//! What the way to the goal costs at least, s, over coarse cells: it leads the search for footsteps.

use geometry::{Cell, CellArea, Dijkstra, Goal, Grid, Lattice, PlanarPose, same_level};
use mapping::HeightMap;
use terrain::footholds::HighBlocks;

use super::config::FootstepsConfig;
use super::field_steps::{Prices, steps};
use super::limits::StepLimits;
use super::unseen::{Blurred, Unseen, guess_levels, smooth_levels};

/// A field that is rooted at the goal.
#[derive(Debug, Clone, Default)]
pub(super) struct GoalField {
    lattice: Lattice,
    cols: i32,
    rows: i32,
    /// Height of each cell's middle, m; NaN where nothing is known of it, infinite where the body has no room.
    levels_m: Vec<f32>,
    /// Whether each cell is the end of what a plan can tell: it was not seen, or the map ends there and the goal lies beyond.
    exits: Vec<bool>,
    /// Whether so much of the ground around a cell lies on its level that a sole finds support there.
    carries: Vec<bool>,
    /// What the way from each cell costs, s; infinite where nothing leads on.
    costs_s: Vec<f32>,
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
        (unseen, blurred): (Unseen, Blurred),
    ) -> bool {
        self.read_levels((map, blocks, blurred), config, limits);
        self.exits.clear();
        self.exits
            .extend(self.levels_m.iter().map(|level_m| level_m.is_nan()));
        if unseen != Unseen::Closed {
            guess_levels(&mut self.levels_m, self.cols);
            smooth_levels(
                &mut self.levels_m,
                &self.exits,
                self.cols,
                config.guess_rounds,
            );
        }
        self.speed_mps = limits.speed_mps();
        self.costs_s.clear();
        self.costs_s.resize(self.levels_m.len(), f32::INFINITY);
        self.dijkstra.clear();
        let mut known = false;
        for row in 0..self.rows {
            for col in 0..self.cols {
                let node = (row * self.cols + col) as u32;
                let [x_m, y_m] = self.lattice.center_of(Cell::new(col, row));
                // The goal's own cell counts whatever its radius.
                let from_m = geometry::hypot(x_m - goal.x_m, y_m - goal.y_m);
                let here = from_m <= goal.radius_m.max(self.lattice.cell_m);
                if here && !self.levels_m[node as usize].is_nan() {
                    known = true;
                    self.dijkstra.begin_at(&mut self.costs_s, node, 0.0);
                }
            }
        }
        if unseen != Unseen::Closed && !known {
            known = self.begin_at_rim(goal);
        }
        let prices = Prices::of(config, limits, self.lattice.cell_m);
        let Self {
            dijkstra,
            costs_s,
            levels_m,
            carries,
            exits,
            cols,
            rows,
            ..
        } = self;
        let ground = (levels_m.as_slice(), carries.as_slice(), exits.as_slice());
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

    /// Begins at the cells along the rim, each as far from the goal as the straight way is: the goal lies beyond.
    fn begin_at_rim(&mut self, goal: &Goal) -> bool {
        let mut any = false;
        for node in 0..self.levels_m.len() {
            let (col, row) = (node as i32 % self.cols, node as i32 / self.cols);
            let inside = (1..self.cols - 1).contains(&col) && (1..self.rows - 1).contains(&row);
            if inside || !self.levels_m[node].is_finite() {
                continue;
            }
            let [x_m, y_m] = self.lattice.center_of(Cell::new(col, row));
            let to_m = geometry::hypot(x_m - goal.x_m, y_m - goal.y_m);
            let cost_s = (to_m / self.speed_mps) as f32;
            self.dijkstra
                .begin_at(&mut self.costs_s, node as u32, cost_s);
            self.exits[node] = true;
            any = true;
        }
        any
    }

    /// Where the cheapest way from a place comes, within a distance, m, to what was not seen.
    pub(super) fn exit_within(&self, x_m: f64, y_m: f64, within_m: f64) -> Option<[f64; 2]> {
        let mut at = self.lattice.cell_at(x_m, y_m);
        let index = |cell: Cell| {
            let inside = (0..self.cols).contains(&cell.col) && (0..self.rows).contains(&cell.row);
            inside.then(|| (cell.row * self.cols + cell.col) as usize)
        };
        for _ in 0..=(within_m / self.lattice.cell_m) as usize {
            let here = index(at)?;
            if self.exits[here] {
                return Some(self.lattice.center_of(at));
            }
            let around = CellArea::of(at).grown(1);
            let next = around
                .cells()
                .filter_map(|cell| Some((self.costs_s[index(cell)?], cell)))
                .min_by(|a, b| a.0.total_cmp(&b.0));
            match next {
                Some((cost_s, cell)) if cost_s < self.costs_s[here] => at = cell,
                _ => return None,
            }
        }
        None
    }

    fn read_levels(
        &mut self,
        (map, blocks, blurred): (&HeightMap, &HighBlocks, Blurred),
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
                let level_m = level_of((map, blurred), Cell::new(col * side, row * side), side);
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
fn level_of((map, blurred): (&HeightMap, Blurred), first: Cell, side: i32) -> f32 {
    let middle = Cell::new(first.col + side / 2, first.row + side / 2);
    let about_m = || (blurred == Blurred::Crossed).then(|| map.blurred_m(middle))?;
    map.height_m(middle).or_else(about_m).unwrap_or_else(|| {
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
