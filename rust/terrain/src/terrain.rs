//! What is known of the cells around the robot: the product of the rules.

use geometry::distance::{CellDistances, NOTHING_NEAR};
use geometry::{Cell, CellArea, Lattice};
use mapping::FloorView;
use settings::{settings, within};

use crate::{CellSettings, Needs, SlopeCells, StairCells, StandingAt};

settings! {
    /// How room along a way is measured.
    pub struct RoomConfig("navigation.terrain.room") {
        /// Room may seem this much less than it was, or half a cell less where that is less, before a way is given up.
        slack: f64 = 0.03, "m", within(0.0, 1.0);
        /// A straight way is looked at in pieces of this share of a cell.
        piece: f64 = 0.25, "1", within(0.01, 1.0);
        /// A line of places between two points is looked at in steps of this share of a cell where only what stands there matters.
        stride: f64 = 0.5, "1", within(0.01, 1.0);
    }
}

/// How far away something is that is not there, m.
const FAR_AWAY_M: u16 = u16::MAX;

/// What is known of the cells of a window, row by row. Reused.
#[derive(Debug, Clone, Default)]
pub struct Terrain {
    /// Room that the robot needs.
    pub needs: Needs,
    /// What users set of cells.
    pub settings: CellSettings,
    /// How room along a way is measured.
    pub room: RoomConfig,
    /// Where the cells lie.
    pub lattice: Lattice,
    /// Cells a row.
    pub cols: usize,
    /// Number of rows.
    pub rows: usize,
    /// Where an obstacle stands.
    pub blocked: Vec<bool>,
    /// Of which cells nothing is known, or nothing that is believed.
    pub unknown: Vec<bool>,
    /// Least distance of each cell to the robot so far, m.
    pub nearest_m: Vec<f32>,
    /// Height of each cell, m; not a number where none is known.
    pub height_m: Vec<f32>,
    /// Standard deviation of each height, m; 0 where it counts as it is.
    pub(crate) sigma_m: Vec<f32>,
    /// Cells beside a difference that is no floor, to either side of it, or between two such levels: no foot is set across one but by a
    /// climb.
    pub edge: Vec<bool>,
    /// Edges that a stair which is not known yet may be: low enough to be climbed, or with nothing seen behind them.
    pub(crate) open: Vec<bool>,
    /// Whether there is any edge.
    pub any_edge: bool,
    /// The cells of stairs.
    pub stairs: StairCells,
    /// The cells that are tilted.
    pub slopes: SlopeCells,
    /// Distance to obstacles.
    pub distance: CellDistances,
    /// Distance to edges, where it is so short that it matters.
    pub(crate) edge_distance: CellDistances,
    /// Distance to the nearest obstacle where the robot stands, m: there it is.
    pub clearance_at_start_m: f64,
    /// What a length costs in a cell: 1 on open known floor, infinite where the robot may not be.
    pub weights: Vec<f32>,
}

impl Terrain {
    /// No cells yet, for a robot that needs this room.
    pub fn new(needs: Needs, settings: CellSettings) -> Self {
        Self {
            needs,
            settings,
            ..Self::default()
        }
    }

    /// Lies where a view lies, with no edges yet.
    pub(crate) fn begin(&mut self, view: &FloorView) {
        self.lattice = view.lattice;
        (self.cols, self.rows) = (view.cells.cols(), view.cells.rows());
        let count = view.cells.values().len();
        self.edge.clear();
        self.edge.resize(count, false);
        self.open.clear();
        self.open.resize(count, false);
        self.any_edge = false;
    }

    /// Makes a cell an edge.
    pub(crate) fn mark_edge(&mut self, index: usize) {
        self.edge[index] = true;
        self.any_edge = true;
    }

    /// Makes a cell an edge beside a step, m.
    pub(crate) fn mark_step(&mut self, index: usize, rise: f32) {
        self.open[index] |= f64::from(rise) <= self.needs.limits.step_m;
        self.mark_edge(index);
    }

    /// Distance from a cell's centre to the nearest edge of a level, m, far away where feet have room to spare: the edge lies between the
    /// cells beside it.
    pub fn edge_clearance_m(&self, index: usize) -> f64 {
        if !self.any_edge || self.edge_distance.squared(index) == NOTHING_NEAR {
            return f64::from(FAR_AWAY_M);
        }
        let cells = f64::from(self.edge_distance.squared(index)).sqrt();
        (cells + 0.5) * self.lattice.cell_m
    }

    /// Whether a cell lies at the end of a level with nothing known behind it, or at an edge that is no stair's.
    pub fn is_open_edge(&self, index: usize) -> bool {
        self.open[index] && !self.stairs.is_near(index)
    }

    /// What the difference between the heights of two cells is off by noise, m, as far as noise is allowed for.
    pub(crate) fn noise_m(&self, one: usize, other: usize) -> f32 {
        let [a, b] = [one, other].map(|index| self.sigma_m.get(index).copied().unwrap_or(0.0));
        self.settings.step_sigmas as f32 * (a * a + b * b).sqrt()
    }

    /// Whether a difference in height on or beside a slope, of no more than a step, was never seen from so near that it could be told from
    /// the level strips that a slope is cut into from afar.
    pub(crate) fn may_be_strips(&self, one: usize, other: usize, rise_m: f32) -> bool {
        let range_m = self.settings.judge_range as f32;
        let is_unsure = |index: usize| {
            let was_near = self.nearest_m.get(index);
            self.slopes.is_near(index) && was_near.is_some_and(|&at_m| at_m > range_m)
        };
        f64::from(rise_m) <= self.needs.limits.step_m && is_unsure(one) && is_unsure(other)
    }

    /// Height of a cell, m, where one is known.
    pub fn level_m(&self, index: usize) -> Option<f64> {
        let height = self.height_m[index];
        (!height.is_nan()).then(|| f64::from(height))
    }

    /// How near the robot has been to a place, m; infinite where it was never looked at.
    pub fn nearest_m(&self, at_m: [f64; 2]) -> f64 {
        let known_m = self
            .index_at(at_m)
            .and_then(|index| self.nearest_m.get(index));
        known_m.map_or(f64::INFINITY, |&known_m| f64::from(known_m))
    }

    /// Distance from a cell's centre to the centre of the nearest blocked cell, m. An obstacle's surface lies anywhere in
    /// its cell, so that this is right on average.
    pub fn clearance_m(&self, index: usize) -> f64 {
        let squared = self.distance.squared(index);
        if squared == NOTHING_NEAR {
            f64::from(FAR_AWAY_M)
        } else {
            f64::from(squared).sqrt() * self.lattice.cell_m
        }
    }

    /// Centre of a cell, m.
    pub fn center_m(&self, index: usize) -> [f64; 2] {
        let cell = Cell::new((index % self.cols) as i32, (index / self.cols) as i32);
        self.lattice.center_of(cell)
    }

    /// The cell that holds a place, m; none outside of the window.
    pub fn index_at(&self, point_m: [f64; 2]) -> Option<usize> {
        let cell = self.lattice.cell_at(point_m[0], point_m[1]);
        let (col, row) = (
            usize::try_from(cell.col).ok()?,
            usize::try_from(cell.row).ok()?,
        );
        (col < self.cols && row < self.rows).then(|| row * self.cols + col)
    }

    /// Whether a cell lies at the window's border.
    pub fn on_border(&self, index: usize) -> bool {
        let (col, row) = (index % self.cols, index / self.cols);
        col == 0 || row == 0 || col + 1 == self.cols || row + 1 == self.rows
    }

    /// What the straight way between two points costs, m; `None` where it may not be walked. Looked at in short pieces, each weighed by
    /// the cell of its middle.
    pub fn straight_cost_m(&self, from: [f64; 2], to: [f64; 2]) -> Option<f64> {
        self.straight_cost_over_m(&self.weights, from, to)
    }

    /// As [`Self::straight_cost_m`], with other weights for the cells.
    pub fn straight_cost_over_m(
        &self,
        weights: &[f32],
        from: [f64; 2],
        to: [f64; 2],
    ) -> Option<f64> {
        let length = geometry::hypot(to[0] - from[0], to[1] - from[1]);
        let pieces = (length / (self.room.piece * self.lattice.cell_m))
            .ceil()
            .max(1.0);
        let mut sum = 0.0;
        for piece in 0..pieces as usize {
            let t = (piece as f64 + 0.5) / pieces;
            let at = [
                from[0] + t * (to[0] - from[0]),
                from[1] + t * (to[1] - from[1]),
            ];
            let weight = weights[self.index_at(at)?];
            if weight.is_infinite() {
                return None;
            }
            sum += f64::from(weight);
        }
        Some(sum * length / pieces)
    }

    /// What a metre sideways costs here for a robot with this heading; `None` where its rectangle, less `slack_m` all round, is not
    /// clear of obstacles or its feet are near an edge.
    pub fn sideways_weight(&self, at_m: [f64; 2], heading_rad: f64, slack_m: f64) -> Option<f64> {
        let settings = &self.settings;
        let rectangle = self.needs.turned?;
        let index = self.index_at(at_m)?;
        let at_edge = self.edge[index] || self.edge_clearance_m(index) < self.needs.feet_m;
        if self.blocked[index] || at_edge {
            return None;
        }
        let half_width_m = rectangle.half_width_m - slack_m;
        let half_depth_m = rectangle.half_depth_m - slack_m;
        let soft_m = half_depth_m + settings.soft_range;
        let (sin, cos) = libm::sincos(heading_rad);
        let mut spare_m = settings.soft_range;
        let reach_m = geometry::hypot(half_width_m, soft_m);
        for place_m in self.obstacles_near(at_m, reach_m) {
            let [dx, dy] = [place_m[0] - at_m[0], place_m[1] - at_m[1]];
            let ahead_m = (cos * dx + sin * dy).abs();
            let aside_m = (cos * dy - sin * dx).abs();
            if aside_m < half_width_m {
                if ahead_m < half_depth_m {
                    return None;
                }
                spare_m = spare_m.min(ahead_m - half_depth_m);
            }
        }
        let unseen = if self.unknown[index] {
            settings.unknown_cost
        } else {
            0.0
        };
        Some(settings.weight(spare_m, settings.soft_range) + settings.sideways_cost + unseen)
    }

    /// Centres of the blocked cells within a square around a place, m.
    pub fn obstacles_near(
        &self,
        [x, y]: [f64; 2],
        reach_m: f64,
    ) -> impl Iterator<Item = [f64; 2]> + '_ {
        // A range may be large; the window is not.
        let last = [self.cols, self.rows].map(|cells| cells as i32 - 1);
        let corner = |x_m: f64, y_m: f64| {
            let cell = self.lattice.cell_at(x_m, y_m);
            Cell::new(cell.col.min(last[0]).max(0), cell.row.min(last[1]).max(0))
        };
        let area = CellArea {
            min: corner(x - reach_m, y - reach_m),
            max: corner(x + reach_m, y + reach_m),
        };
        area.cells().filter_map(|cell| {
            let col = usize::try_from(cell.col).ok().filter(|&c| c < self.cols)?;
            let row = usize::try_from(cell.row).ok().filter(|&r| r < self.rows)?;
            self.blocked[row * self.cols + col].then(|| self.lattice.center_of(cell))
        })
    }

    /// Whether there is room for the robot's circle in a cell.
    pub fn is_roomy(&self, index: usize) -> bool {
        self.weights[index].is_finite() && self.clearance_m(index) >= self.needs.body_m
    }

    /// Whether the robot stands where there is no room for the circle, but for itself as it is turned.
    pub fn is_in_passage(&self, stand: &StandingAt) -> bool {
        let closed = |start: &usize| !self.is_roomy(*start);
        let slack_m = self.room.slack.min(0.5 * self.lattice.cell_m);
        let start = self.index_at(stand.at_m).filter(closed);
        let weight = || self.sideways_weight(stand.at_m, stand.heading_rad, slack_m);
        start.and_then(|_| weight()).is_some()
    }
}
