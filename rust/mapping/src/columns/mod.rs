//! Things one above the other in the columns of the window, and the view of those by which the robot comes.
//!
//! Models that have no direction that is up bring what they know into columns; planners see, of each column, the surface that is reached from
//! where the robot stands.

mod things;

use geometry::{Cell, CellArea, Lattice, runs};

use crate::elevation::edges::upper_surface;
use crate::elevation::level::LevelCells;
use crate::elevation::sensed::SensedFrame;
use crate::elevation::slope::SlopeFinder;
use crate::elevation::{ElevationConfig, cell_of};
use crate::multi_level::reached::Reached;
use crate::surface::{Underfoot, Window};
use crate::{FloorView, Surface, Voxel};
use things::Columns;
pub use things::Span;

/// Columns and the view made of them.
#[derive(Debug, Clone)]
pub(crate) struct ColumnView {
    elevation: ElevationConfig,
    /// Room between two things above each other with which both are kept, m.
    headroom_m: f32,
    /// Levels that lie this near above each other are one way for the robot, m.
    joined_m: f32,
    window: Window,
    columns: Columns,
    underfoot: Underfoot,
    reached: Reached,
    /// Of each cell height of the surface by which the robot comes, m; NaN where none is known.
    heights_m: Vec<f32>,
    /// Frames that saw that surface, and the room above it, m.
    ways: Vec<(u16, f32)>,
    level: LevelCells,
    slopes: SlopeFinder,
    pub(crate) view: FloorView,
}

impl ColumnView {
    /// Of which nothing is known, around the map's origin. Levels that lie within so many rises of each other are one way.
    pub(crate) fn new(elevation: &ElevationConfig, headroom_m: f32, joined: f64) -> Self {
        let n = elevation.window;
        let window = Window::new(elevation.cell, n, elevation.tuning.wander);
        Self {
            headroom_m,
            joined_m: (joined * elevation.rise) as f32,
            columns: Columns::default(),
            underfoot: Underfoot::new(n, elevation.footprint),
            reached: Reached::new(n),
            heights_m: vec![f32::NAN; n * n],
            ways: vec![(0, f32::INFINITY); n * n],
            level: LevelCells::default(),
            slopes: SlopeFinder::default(),
            view: FloorView {
                least_gradient: elevation.tuning.slopes.least,
                ..FloorView::unknown(window.lattice(), n)
            },
            window,
            elevation: elevation.clone(),
        }
    }

    /// The things in a cell of the view, the lowest first; none where nothing was seen, and outside.
    pub(crate) fn things(&self, cell: Cell) -> &[Span] {
        let index = self.view.cells.index(cell);
        index.map_or(&[], |at| self.columns.things(at))
    }

    /// The lattice of the window, its columns and rows.
    pub(crate) fn place(&self) -> (Lattice, [usize; 2]) {
        (self.window.lattice(), self.view.size())
    }

    /// Moves the window to the robot, which stands there; whether it moved: then the columns must be filled anew.
    pub(crate) fn follow(&mut self, robot_m: [f64; 3]) -> bool {
        let [cols, rows] = self.window.follow(robot_m);
        let moved = [cols, rows] != [0; 2];
        if moved {
            self.underfoot.shift(cols, rows);
            self.view.shift(cols, rows, self.window.lattice());
        }
        let _stood = self.underfoot.stand(robot_m, &self.window.lattice());
        moved
    }

    /// Fills the columns anew: `spans` tells what is in them, by whole cells from the map's origin.
    pub(crate) fn fill(&mut self, spans: impl FnOnce(&mut dyn FnMut([i32; 2], Span))) {
        let lattice = self.window.lattice();
        let corner = lattice
            .origin_m
            .map(|at_m| (at_m / lattice.cell_m).round() as i32);
        let (columns, cells) = (&mut self.columns, &self.view.cells);
        columns.begin();
        spans(&mut |column, span| {
            let cell = Cell::new(column[0] - corner[0], column[1] - corner[1]);
            if let Some(index) = cells.index(cell) {
                columns.add(index, span);
            }
        });
        columns.finish(cells.values().len(), self.headroom_m);
    }

    /// The shift that brings the frame onto the heights that are known.
    pub(crate) fn shift_m(&self, frame: &mut SensedFrame) -> Option<f64> {
        let known_m = |cell: usize, from_m: f32| {
            let heights_m = self.columns.things(cell).iter().map(|one| one.high_m);
            heights_m.min_by(|a, b| (a - from_m).abs().total_cmp(&(b - from_m).abs()))
        };
        let gate = (self.elevation.match_gate, self.elevation.min_pairs);
        frame.shift_m(known_m, gate, &self.elevation.tuning.matching)
    }

    /// The surface of a cell by which the robot comes: height and frames, and the room above it, m.
    fn way(&self, index: usize) -> Option<(f32, u16, f32)> {
        let by_m = self.reached.height_m(index);
        let things = self.columns.things(index);
        let off = |one: &Span| (one.high_m - by_m).abs();
        let nearest =
            (0..things.len()).min_by(|&a, &b| off(&things[a]).total_cmp(&off(&things[b])))?;
        let height_m = things[nearest].high_m;
        let above = things.get(nearest + 1);
        let room_m = above.map_or(f32::INFINITY, |one| one.low_m - height_m);
        Some((height_m, things[nearest].frames, room_m))
    }

    fn surface(&self, index: usize, is_level: bool) -> (Surface, u16) {
        let (own_m, (frames, room_m)) = (self.heights_m[index], self.ways[index]);
        if own_m.is_nan() {
            let stood = self.underfoot.height_at(index);
            return (stood.map_or(Surface::Unknown, Surface::Floor), 0);
        }
        let (height_m, lowest_m) = if is_level {
            (own_m, own_m)
        } else {
            self.heights_around(index)
        };
        if height_m - lowest_m > self.elevation.rise as f32 || room_m < self.headroom_m {
            (Surface::Obstacle(height_m), 0)
        } else {
            (Surface::Floor(height_m), frames)
        }
    }

    /// Height of a cell, of the upper surface where an edge runs through it, and of the lowest one beside it, m.
    fn heights_around(&self, index: usize) -> (f32, f32) {
        let (own_m, size) = (self.heights_m[index], self.view.size());
        let cell = cell_of(index, size);
        let away = |[cols, rows]: [i32; 2]| {
            let beside = Cell::new(cell.col + cols, cell.row + rows);
            let height_m = self.heights_m[self.view.cells.index(beside)?];
            (!height_m.is_nan()).then_some(height_m)
        };
        let height_m = upper_surface(own_m, away, self.elevation.edge_rule()).unwrap_or(own_m);
        let beside = runs(CellArea::of(cell).grown(1), size).flatten();
        // What is no number is not lower.
        let lowest_m = beside.fold(height_m, |low_m, other| low_m.min(self.heights_m[other]));
        (height_m, lowest_m)
    }

    /// Makes the view of what is reached from where the robot stands.
    pub(crate) fn refresh(&mut self, robot_m: [f64; 3]) {
        let start = self.window.lattice().cell_at(robot_m[0], robot_m[1]);
        let columns = &self.columns;
        let nearest = |index: usize, from_m: f32| {
            let heights = columns.things(index).iter().map(|one| one.high_m);
            heights.min_by(|a, b| (a - from_m).abs().total_cmp(&(b - from_m).abs()))
        };
        self.reached
            .spread((start, robot_m[2] as f32), self.joined_m, nearest);
        for index in 0..self.view.cells.values().len() {
            let unknown = (f32::NAN, 0, f32::INFINITY);
            let (height_m, frames, room_m) = self.way(index).unwrap_or(unknown);
            (self.heights_m[index], self.ways[index]) = (height_m, (frames, room_m));
        }
        let (size, area) = (self.view.size(), self.view.cells.area());
        let rule = (Some(self.elevation.edge_rule()), self.elevation.rise as f32);
        let mut level_cells = std::mem::take(&mut self.level);
        for run in runs(area, size) {
            let level = level_cells.of_run(&self.heights_m, size, run.clone(), rule);
            for (index, &is_level) in run.zip(level) {
                let (surface, frames) = self.surface(index, is_level);
                self.view.cells.values_mut()[index] = surface;
                self.view.sightings.values_mut()[index] = frames;
            }
        }
        self.level = level_cells;
        let rule = (self.elevation.cell as f32, self.elevation.slope_rule());
        let (heights_m, view) = (&self.heights_m, &mut self.view);
        let height = |index: usize| Some(heights_m[index]).filter(|height_m| !height_m.is_nan());
        self.slopes
            .find((size, area), height, rule, |index, gradient| {
                view.gradients.values_mut()[index] = gradient;
            });
    }

    /// Cubes of a cell's side over the vertical extent of each thing in the window.
    pub(crate) fn occupied(&self) -> Vec<Voxel> {
        let (lattice, side_m) = (self.window.lattice(), self.elevation.cell);
        let mut voxels = Vec::new();
        for cell in self.view.cells.area().cells() {
            let [x_m, y_m] = lattice.center_of(cell);
            for thing in self.things(cell) {
                let count = (f64::from(thing.high_m - thing.low_m) / side_m) as usize + 1;
                let top_m = f64::from(thing.high_m);
                voxels.extend((0..count).map(|down| Voxel {
                    centre_m: [x_m, y_m, top_m - (down as f64 + 0.5) * side_m],
                    side_m,
                }));
            }
        }
        voxels
    }
}
