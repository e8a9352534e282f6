//! The view of things one above the other in the cells of a window: of each cell the surface that is reached from where the robot stands.

use geometry::{Cell, CellArea, Lattice, runs};

use super::Span;
use super::reached::Reached;
use crate::elevation::edges::{EdgeRule, upper_surface};
use crate::elevation::level::LevelCells;
use crate::elevation::sensed::SensedFrame;
use crate::elevation::slope::SlopeFinder;
use crate::elevation::{ElevationConfig, HeightEstimate, cell_of};
use crate::surface::{Underfoot, Window};
use crate::{FloorView, Surface};

/// What counts as a way, and as a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WayRule {
    /// Room above a surface with less of which it is no way, m.
    pub headroom_m: f32,
    /// Levels that lie this near above each other are one way for the robot, m.
    pub joined_m: f32,
    /// How a cell between two surfaces is told; none: it keeps its own height.
    pub edge: Option<EdgeRule>,
}

/// A window that follows the robot, and the view of what is in it.
#[derive(Debug, Clone)]
pub(crate) struct ReachedView {
    elevation: ElevationConfig,
    rule: WayRule,
    window: Window,
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

impl ReachedView {
    /// Of which nothing is known, around the map's origin.
    pub(crate) fn new(elevation: &ElevationConfig, rule: WayRule) -> Self {
        let n = elevation.window;
        let window = Window::new(elevation.cell, n, elevation.tuning.wander);
        Self {
            rule,
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

    /// The lattice of the window, its columns and rows.
    pub(crate) fn place(&self) -> (Lattice, [usize; 2]) {
        (self.window.lattice(), self.view.size())
    }

    /// Moves the window to the robot, which stands there; by how many columns and rows.
    pub(crate) fn follow(&mut self, robot_m: [f64; 3]) -> [i32; 2] {
        let [cols, rows] = self.window.follow(robot_m);
        if [cols, rows] != [0; 2] {
            self.underfoot.shift(cols, rows);
            self.view.shift(cols, rows, self.window.lattice());
        }
        let _stood = self.underfoot.stand(robot_m, &self.window.lattice());
        [cols, rows]
    }

    /// The shift that brings a frame onto the heights that are known. `things` are those of a cell, the lowest first.
    pub(crate) fn shift_m<'a, T: Copy + Into<Span> + 'a>(
        &self,
        frame: &mut SensedFrame,
        things: impl Fn(usize) -> &'a [T],
    ) -> Option<f64> {
        let known_m = |cell: usize, from_m: f32| nearest_m(things(cell), from_m);
        let gate = (self.elevation.match_gate, self.elevation.min_pairs);
        frame.shift_m(known_m, gate, &self.elevation.tuning.matching)
    }

    /// Makes the view of what is reached from where the robot stands. `things` are those of a cell, the lowest first.
    pub(crate) fn refresh<'a, T: Copy + Into<Span> + 'a>(
        &mut self,
        robot_m: [f64; 3],
        things: impl Fn(usize) -> &'a [T],
    ) {
        let start = self.window.lattice().cell_at(robot_m[0], robot_m[1]);
        let nearest = |index: usize, from_m: f32| nearest_m(things(index), from_m);
        self.reached
            .spread((start, robot_m[2] as f32), self.rule.joined_m, nearest);
        for index in 0..self.heights_m.len() {
            let way = way(things(index), self.reached.height_m(index));
            let (known, room_m) = way.unwrap_or((Span::UNKNOWN, f32::INFINITY));
            (self.heights_m[index], self.ways[index]) = (known.high_m, (known.frames, room_m));
            self.view.sigmas_m.values_mut()[index] = known.sigma_m;
        }
        self.show();
    }

    fn surface(&self, index: usize, is_level: bool) -> (Surface, u16) {
        let (own_m, (frames, room_m)) = (self.heights_m[index], self.ways[index]);
        if own_m.is_nan() {
            let stood = self.underfoot.height_at(index);
            return (stood.map_or(Surface::Unknown, Surface::Floor), 0);
        }
        let (height_m, is_high) = if is_level {
            (own_m, false)
        } else {
            self.height_at_edge(index)
        };
        // What no frame saw from above has no surface that is known.
        if is_high || room_m < self.rule.headroom_m || frames == 0 {
            (Surface::Obstacle(height_m), 0)
        } else {
            (Surface::Floor(height_m), frames)
        }
    }

    /// Height of a cell, of the upper surface where an edge runs through it, m, and whether it is an obstacle beside another one.
    fn height_at_edge(&self, index: usize) -> (f32, bool) {
        let (own_m, size) = (self.heights_m[index], self.view.size());
        let cell = cell_of(index, size);
        let away = |[cols, rows]: [i32; 2]| {
            let beside = Cell::new(cell.col + cols, cell.row + rows);
            let height_m = self.heights_m[self.view.cells.index(beside)?];
            (!height_m.is_nan()).then_some(height_m)
        };
        let upper_m = (self.rule.edge).and_then(|edge| upper_surface(own_m, away, edge));
        let height_m = upper_m.unwrap_or(own_m);
        let estimate = |index: usize, height_m: f32| {
            HeightEstimate::with_sigma(height_m, self.view.sigmas_m.values()[index])
        };
        let (own, rule) = (estimate(index, height_m), self.elevation.rise_rule());
        let mut beside = runs(CellArea::of(cell).grown(1), size).flatten();
        let is_high =
            beside.any(|other| rule.is_above(own, estimate(other, self.heights_m[other])));
        (height_m, is_high)
    }

    /// Shows surfaces and gradients of the heights.
    fn show(&mut self) {
        let (size, area) = (self.view.size(), self.view.cells.area());
        let rule = (self.rule.edge, self.elevation.rise as f32);
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
        let sure_m = self.elevation.tuning.slopes.sure as f32;
        let (heights_m, view) = (&self.heights_m, &mut self.view);
        let (sigmas_m, gradients) = (view.sigmas_m.values(), view.gradients.values_mut());
        let known = |index: usize| !heights_m[index].is_nan() && sigmas_m[index] <= sure_m;
        let height = |index: usize| known(index).then(|| heights_m[index]);
        self.slopes
            .find((size, area), height, rule, |index, gradient| {
                gradients[index] = gradient;
            });
    }
}

/// Height of the thing whose surface is nearest to a height, m.
fn nearest_m<T: Copy + Into<Span>>(things: &[T], from_m: f32) -> Option<f32> {
    let heights_m = things.iter().map(|&one| one.into().high_m);
    heights_m.min_by(|a, b| (a - from_m).abs().total_cmp(&(b - from_m).abs()))
}

/// The thing whose surface is nearest to a height by which the robot comes, and the room above it, m.
fn way<T: Copy + Into<Span>>(things: &[T], by_m: f32) -> Option<(Span, f32)> {
    let off = |at: usize| (things[at].into().high_m - by_m).abs();
    let nearest = (0..things.len()).min_by(|&a, &b| off(a).total_cmp(&off(b)))?;
    let known: Span = things[nearest].into();
    let above = things
        .get(nearest + 1)
        .map(|&one| one.into().low_m - known.high_m);
    Some((known, above.unwrap_or(f32::INFINITY)))
}
