//! The height of each cell, and the cells at an edge between two levels: no foot is set across one but by a climb.

use mapping::{FloorView, Surface};

use crate::AStarConfig;
use crate::rims::Rims;
use crate::slopes::Slopes;
use crate::treads::Treads;

/// A shadow below an edge, as seen from above, is at most so many cells wide.
const SHADOW_CELLS: usize = 4;
/// From so many cells on a lower level is believed.
const LOWER_CELLS: usize = 12;

/// Where the robot stands, in the map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stand {
    pub(crate) at_m: [f64; 2],
    pub(crate) height_m: f64,
    pub(crate) heading_rad: f64,
    /// Rise of the ground there per metre along the map's axes.
    pub(crate) gradient: [f64; 2],
}

impl Stand {
    /// Height of the ground this far off along the map's axes if it goes on as where the robot stands, m.
    pub(crate) fn ground_m(&self, [dx_m, dy_m]: [f64; 2]) -> f64 {
        self.height_m + self.gradient[0] * dx_m + self.gradient[1] * dy_m
    }
}

/// Differences in height that matter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Limits {
    /// What is still floor, m.
    pub(crate) floor_m: f64,
    /// What may still be climbed, m.
    pub(crate) step_m: f64,
}

/// The levels of a view. Reused.
#[derive(Debug, Clone, Default)]
pub(crate) struct Levels {
    /// Height of each cell, m; not a number where none is known.
    pub(crate) height_m: Vec<f32>,
    /// Cells beside a difference that is no floor, to either side of it, or between two such levels.
    pub(crate) edge: Vec<bool>,
    /// Edges that a stair which is not known yet may be: low enough to be climbed, or with nothing seen behind them.
    pub(crate) open: Vec<bool>,
    /// Whether there is any edge.
    pub(crate) any: bool,
    gaps: Vec<(usize, f32)>,
    rims: Rims,
    pub(crate) slopes: Slopes,
}

impl Levels {
    /// Heights of the floor that was seen often enough and is not in doubt, and of the treads.
    pub(crate) fn read(
        &mut self,
        (view, unknown): (&FloorView, &[bool]),
        treads: &mut Treads,
        stand: &Stand,
        limits: &Limits,
        config: &AStarConfig,
    ) {
        self.height_m.clear();
        let cells = view.cells.values().iter().zip(view.sightings.values());
        let cells = cells.zip(unknown);
        self.height_m
            .extend(cells.map(|((surface, &sightings), &unknown)| {
                if let Surface::Floor(height) = surface
                    && !unknown
                    && sightings >= config.step_sightings
                {
                    *height
                } else {
                    f32::NAN
                }
            }));
        let cols = view.cells.cols();
        treads.lay(&mut self.height_m, cols, stand.height_m, limits.floor_m);
        self.slopes.read(view, config);
        self.close_gaps(cols, limits.floor_m);
        self.edge.clear();
        self.edge.resize(self.height_m.len(), false);
        self.any = false;
        self.open.clear();
        self.open.resize(self.height_m.len(), false);
        let seen = (self.height_m.as_slice(), cols);
        for index in (self.rims).read(seen, treads, stand.height_m, limits.floor_m) {
            self.edge[index] = true;
            self.any = true;
        }
        self.mark_differences(cols, limits);
        self.mark_shadows(cols, limits);
        for index in self.slopes.too_steep() {
            self.edge[index] = true;
            self.any = true;
        }
    }

    /// Gives single cells that were not seen the height of the ground on both sides of them. Else a line of cells that the
    /// camera missed before a box looks like the shadow below an edge.
    fn close_gaps(&mut self, cols: usize, max_step: f64) {
        self.gaps.clear();
        let between = |a: f32, b: f32| {
            // Not a number: unknown, no ground.
            (f64::from((a - b).abs()) <= max_step).then_some(0.5 * (a + b))
        };
        let end = self.height_m.len().saturating_sub(cols);
        for first in (cols..end).step_by(cols.max(1)) {
            let [below, here, above] = [first - cols, first, first + cols]
                .map(|first| &self.height_m[first..first + cols]);
            for col in 1..cols.saturating_sub(1) {
                if !here[col].is_nan() {
                    continue;
                }
                let closed = between(here[col - 1], here[col + 1]);
                if let Some(height) = closed.or_else(|| between(below[col], above[col])) {
                    self.gaps.push((first + col, height));
                }
            }
        }
        for &(index, height) in &self.gaps {
            self.height_m[index] = height;
        }
    }

    /// Both cells beside a difference, neighbours by a side or by a corner.
    fn mark_differences(&mut self, cols: usize, limits: &Limits) {
        let floor = limits.floor_m as f32;
        for index in 0..self.height_m.len() {
            let here = self.height_m[index];
            if here.is_nan() {
                continue;
            }
            let col = index % cols;
            let neighbours = [
                (col + 1 < cols, index + 1),
                (true, index + cols),
                (col + 1 < cols, index + cols + 1),
                (col > 0, index + cols - 1),
            ];
            for (inside, next) in neighbours {
                // Not a number: unknown, no difference.
                let there = self.height_m.get(next).copied().unwrap_or(f32::NAN);
                if !(inside && (there - here).abs() > floor) {
                    continue;
                }
                let rise = self.slopes.step_m(index, next, there - here);
                if rise > floor {
                    self.mark(index, rise, limits);
                    self.mark(next, rise, limits);
                }
            }
        }
    }

    fn mark(&mut self, index: usize, rise: f32, limits: &Limits) {
        self.edge[index] = true;
        self.open[index] |= f64::from(rise) <= limits.step_m;
        self.any = true;
    }

    /// Differences across a few cells of which nothing is known.
    fn mark_shadows(&mut self, cols: usize, limits: &Limits) {
        let rows = self.height_m.len() / cols.max(1);
        for row in 0..rows {
            self.mark_line(row * cols, 1, cols, limits);
        }
        for col in 0..cols {
            self.mark_line(col, cols, rows, limits);
        }
    }

    fn mark_line(&mut self, first: usize, stride: usize, count: usize, limits: &Limits) {
        let mut last: Option<(usize, f32)> = None;
        for i in 0..count {
            let here = self.height_m[first + i * stride];
            if here.is_nan() {
                continue;
            }
            if let Some((known, height)) = last
                && (2..=SHADOW_CELLS + 1).contains(&(i - known))
            {
                let (from, to) = (first + known * stride, first + i * stride);
                let rise = self.slopes.step_m(from, to, here - height);
                if f64::from(rise) > limits.floor_m {
                    for between in known..=i {
                        self.mark(first + between * stride, rise, limits);
                    }
                }
            }
            last = Some((i, here));
        }
    }

    /// Whether something known, or the goal, lies lower than the robot stands.
    pub(crate) fn raised(&self, stand: &Stand, lowest_known_m: f64, config: &AStarConfig) -> bool {
        let below_m = stand.height_m - 2.0 * config.max_step;
        lowest_known_m < below_m
            || self
                .height_m
                .iter()
                .filter(|&&height| f64::from(height) < below_m)
                .count()
                >= LOWER_CELLS
    }
}
