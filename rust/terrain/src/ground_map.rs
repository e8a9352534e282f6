//! Where the ground is, fine enough for a sole: the heights of the map, cut along the edges of the stairs that were recognised.
//!
//! The map knows heights well, and to a cell where they end; the recognizer knows edges to millimetres. So a place beside an edge has the
//! height of the nearest cell on its side of that, and where heights end at no edge that is known, the ground is not known.

mod config;
mod plain;
mod stair_edges;
mod under_soles;

use geometry::{Cell, CellArea, Grid, Lattice, PlanarPose};
use mapping::{FloorView, HeightMap, Surface};
use stairs::Staircase;

pub use config::GroundMapConfig;
use plain::{Plain, without_strays};
use stair_edges::{KnownEdge, StairEdges};

/// What a sole stands on now.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SoleOnGround {
    /// Its middle in the map.
    pub pose: PlanarPose,
    /// Half its length and half its breadth, m.
    pub half_m: [f64; 2],
    /// How high the robot believes that to be, m.
    pub height_m: f32,
    /// How that rises, forward and to the left.
    pub slope: [f32; 2],
}

/// Heights around the robot. Its arrays are used again.
#[derive(Debug, Clone)]
pub struct GroundMap {
    config: GroundMapConfig,
    /// The highest that the legs climb, m.
    rise_m: f32,
    edges: StairEdges,
    /// What a cell of the view says by itself, row by row of the part that is read.
    plain: Grid<Plain>,
    map: HeightMap,
}

impl GroundMap {
    /// For legs that climb no higher than this, m.
    pub fn new(config: GroundMapConfig, rise_m: f64) -> Self {
        let lattice = Lattice {
            origin_m: [0.0; 2],
            cell_m: config.cell,
        };
        Self {
            config,
            rise_m: rise_m as f32,
            edges: StairEdges::default(),
            plain: Grid::filled(0, 0, Plain::Unseen),
            map: HeightMap::new(lattice, Grid::filled(0, 0, f32::NAN), 0.0),
        }
    }

    /// The map as it was read last.
    pub const fn map(&self) -> &HeightMap {
        &self.map
    }

    /// The map as it was read last, for what else is known of it until it is read again.
    pub const fn map_mut(&mut self) -> &mut HeightMap {
        &mut self.map
    }

    /// Reads the heights around a place, m.
    pub fn read(&mut self, view: &FloorView, stairs: &Staircase, around_m: [f64; 2]) -> &HeightMap {
        let area = self.area_around(view, around_m);
        self.read_plain(view, area);
        let fine = (view.lattice.cell_m / self.config.cell).round().max(1.0) as i32;
        let cell_m = view.lattice.cell_m / f64::from(fine);
        let corner = |cell: Cell| {
            let [x_m, y_m] = view.lattice.center_of(cell);
            [
                x_m - 0.5 * view.lattice.cell_m,
                y_m - 0.5 * view.lattice.cell_m,
            ]
        };
        let lattice = Lattice {
            origin_m: corner(area.min),
            cell_m,
        };
        let [cols, rows] =
            [self.plain.cols(), self.plain.rows()].map(|cells| cells * fine as usize);
        let sigma_m = self.config.sigma as f32;
        let heights_m = Grid::filled(cols, rows, f32::NAN);
        self.map = HeightMap::new(lattice, heights_m, sigma_m);
        self.edges.read(stairs, view.lattice.cell_m);
        for row in 0..self.plain.rows() as i32 {
            for col in 0..self.plain.cols() as i32 {
                let at = view
                    .lattice
                    .center_of(Cell::new(area.min.col + col, area.min.row + row));
                self.fill(Cell::new(col, row), at, fine);
            }
        }
        &self.map
    }

    /// The part of the view around a place that is read.
    fn area_around(&self, view: &FloorView, [x_m, y_m]: [f64; 2]) -> CellArea {
        let reach_m = self.config.reach;
        let area = CellArea {
            min: view.lattice.cell_at(x_m - reach_m, y_m - reach_m),
            max: view.lattice.cell_at(x_m + reach_m, y_m + reach_m),
        };
        area.within(view.cells.area())
    }

    fn read_plain(&mut self, view: &FloorView, area: CellArea) {
        let size = |least: i32, most: i32| (most - least + 1).max(0) as usize;
        let cols = size(area.min.col, area.max.col);
        let rows = size(area.min.row, area.max.row);
        self.plain = Grid::filled(cols, rows, Plain::Unseen);
        let cleaned = without_strays(view, area, &self.config);
        for (index, cell) in area.cells().enumerate() {
            let plain = Plain::of(&cleaned, cell, &self.config);
            let unseen = matches!(view.cell(cell), Surface::Unknown);
            self.plain.values_mut()[index] = if unseen { plain } else { plain.seen() };
        }
    }

    /// Fills the fine cells of one cell of the view.
    fn fill(&mut self, cell: Cell, middle_m: [f64; 2], fine: i32) {
        let plain = self.plain.get(cell).copied().unwrap_or(Plain::Unseen);
        let cell_m = self.map.lattice.cell_m * f64::from(fine);
        let near_m = self.config.edge_cells * cell_m;
        let (mut edges, mut levels_m) = (Vec::new(), Vec::new());
        if matches!(
            plain,
            Plain::Border(_) | Plain::Between | Plain::Obstacle(_)
        ) {
            edges = self.edges.near(middle_m, near_m);
            levels_m.extend(edges.iter().flat_map(|edge| edge.levels_m));
        }
        if let Plain::Obstacle(top_m) = plain {
            // A riser may be taken for something that stands before it, as high as the stair behind it.
            let highest_m = levels_m.iter().copied().fold(f32::NEG_INFINITY, f32::max);
            if top_m > highest_m + self.config.blended as f32 {
                edges.clear();
            }
        }
        let sigma_m = self.config.sigma as f32;
        for row in 0..fine {
            for col in 0..fine {
                let at = Cell::new(cell.col * fine + col, cell.row * fine + row);
                let at_m = self.map.lattice.center_of(at);
                let height_m = if edges.is_empty() {
                    self.plain_height_m(plain, cell)
                } else {
                    self.cut_height_m((cell, middle_m, cell_m), (&edges, &levels_m), at_m)
                };
                match (height_m, plain) {
                    (Some(height_m), _) => self.map.set(at, height_m, sigma_m),
                    (
                        None,
                        Plain::Level(about_m) | Plain::Border(about_m) | Plain::Missing(about_m),
                    ) => {
                        self.map.set_blurred(at, about_m);
                    }
                    (None, Plain::Unseen | Plain::Between | Plain::Obstacle(_)) => {}
                }
            }
        }
    }

    /// The height where no known edge is near, m. Where in a cell two levels meet is not known: there is none.
    fn plain_height_m(&self, plain: Plain, cell: Cell) -> Option<f32> {
        match plain {
            Plain::Unseen | Plain::Between | Plain::Missing(_) | Plain::Border(_) => None,
            Plain::Level(height_m) => Some(height_m),
            Plain::Obstacle(top_m) => Some(self.out_of_reach_m(top_m, cell)),
        }
    }

    /// The height at a place beside known edges, m: that of the nearest cell of the map of those that the fewest edges separate from it. None
    /// where cells meet at other heights than those edges explain.
    fn cut_height_m(
        &self,
        (cell, middle_m, cell_m): (Cell, [f64; 2], f64),
        (edges, levels_m): (&[KnownEdge], &[f32]),
        at_m: [f64; 2],
    ) -> Option<f32> {
        let middle_of = |[cols, rows]: [i32; 2]| {
            [
                middle_m[0] + cell_m * f64::from(cols),
                middle_m[1] + cell_m * f64::from(rows),
            ]
        };
        let level_m = self.config.level as f32;
        let explained_m = self.config.explained_cells * cell_m;
        let beside = || {
            self.around(cell, 2).map(|(by, height_m)| {
                let other_m = middle_of(by);
                let separated = edges.iter().filter(|edge| edge.separates(at_m, other_m));
                let away_m = geometry::distance_m(other_m, at_m);
                let height_m = self.as_stair_m(height_m, levels_m);
                let height_m = (edges.iter())
                    .find_map(|edge| edge.corrected_m((other_m, explained_m), height_m, level_m))
                    .unwrap_or(height_m);
                (separated.count(), away_m, height_m, other_m)
            })
        };
        let (separated, _, height_m, _) = beside().min_by(|a, b| {
            a.0.cmp(&b.0)
                .then(a.1.total_cmp(&b.1))
                .then(a.2.total_cmp(&b.2))
        })?;
        let mut unexplained = beside().filter(|&(count, away_m, other_height_m, other_m)| {
            let heights_m = [other_height_m, height_m];
            count == separated
                && away_m < self.config.unexplained_cells * cell_m
                && (other_height_m - height_m).abs() > level_m
                && !(edges.iter())
                    .any(|edge| edge.explains((other_m, explained_m), heights_m, level_m))
        });
        // One alone is off itself.
        let explained = unexplained.nth(1).is_none();
        explained.then_some(height_m)
    }

    /// The height of the stair that is as high as the map has it, m: cells that hold two levels have a height between them.
    fn as_stair_m(&self, height_m: f32, levels_m: &[f32]) -> f32 {
        let off_m = |level_m: &f32| (level_m - height_m).abs();
        let nearest = (levels_m.iter().copied()).min_by(|a, b| off_m(a).total_cmp(&off_m(b)));
        nearest
            .filter(|level_m| off_m(level_m) <= self.config.blended as f32)
            .unwrap_or(height_m)
    }

    /// Ground in and around a cell: how many columns and rows away, and how high, m.
    fn around(&self, cell: Cell, cells: i32) -> impl Iterator<Item = ([i32; 2], f32)> + '_ {
        let area = CellArea::of(cell).grown(cells).within(self.plain.area());
        area.cells().filter_map(move |other| {
            let height_m = self.plain.get(other)?.ground_m()?;
            Some(([other.col - cell.col, other.row - cell.row], height_m))
        })
    }

    /// Nobody stands on what is an obstacle: it counts as higher than any step from the ground beside it.
    fn out_of_reach_m(&self, top_m: f32, cell: Cell) -> f32 {
        let beside = self
            .around(cell, 2)
            .map(|(_, height_m)| height_m)
            .reduce(f32::min);
        beside.map_or(top_m, |ground_m| top_m.max(ground_m + 2.0 * self.rise_m))
    }
}

#[cfg(test)]
mod tests;
