//! What recognised stairs say about cells: their height, and that a riser beside them is no obstacle.

use geometry::{Cell, Lattice, Map};
use mapping::{FloorView, Surface};
use stairs::{Stair, Staircase};

/// An obstacle on a stair is higher than it by more than this, m: a riser that is taken for one is not.
const OBSTACLE_M: f32 = 0.05;

/// Stairs this near to each other may be steps of one staircase, m.
const NEXT_M: f64 = 0.15;

/// A cell lies well inside a level where no other one was seen this far around it, cells, and it in so many of them: more than at its
/// border, where the ground beyond is hidden.
const INSIDE_CELLS: usize = 2;
const SEEN_CELLS: usize = 16;

/// The cells of all stairs. Reused.
#[derive(Debug, Clone, Default)]
pub(crate) struct Treads {
    /// Height of the stair in whose outline a cell's centre lies, m; not a number where none is.
    height_m: Vec<f32>,
    /// Height of the highest stair within a cell of it, m.
    near_m: Vec<f32>,
    /// Whether a cell lies within a cell of a stair that nothing known is a step up to: the top of a box, as far as can be told.
    apart: Vec<bool>,
    /// Cells well inside the robot's own level that a lower stair reaches over.
    inside: Vec<usize>,
    any: bool,
}

impl Treads {
    /// Finds the cells of each stair; `step_m`: what can be climbed in one step.
    pub(crate) fn read(&mut self, view: &FloorView, stairs: &Staircase, step_m: f64) {
        let (cols, rows) = (view.cells.cols(), view.cells.rows());
        self.any = !stairs.stairs.is_empty();
        self.height_m.clear();
        self.near_m.clear();
        self.apart.clear();
        if !self.any {
            return;
        }
        self.height_m.resize(cols * rows, f32::NAN);
        self.near_m.resize(cols * rows, f32::NEG_INFINITY);
        self.apart.resize(cols * rows, false);
        for stair in &stairs.stairs {
            let apart = !stairs
                .stairs
                .iter()
                .any(|other| leads_to(other, stair, step_m));
            self.add((stair, apart), &view.lattice, cols, rows);
        }
    }

    fn add(
        &mut self,
        (stair, apart): (&Stair<Map>, bool),
        lattice: &Lattice,
        cols: usize,
        rows: usize,
    ) {
        let outline = Outline::of(stair);
        let (min, max) = outline.bounds_m();
        let low = lattice.cell_at(min[0] - lattice.cell_m, min[1] - lattice.cell_m);
        let high = lattice.cell_at(max[0] + lattice.cell_m, max[1] + lattice.cell_m);
        let height = stair.height_m() as f32;
        for row in low.row.max(0)..=high.row.min(rows as i32 - 1) {
            for col in low.col.max(0)..=high.col.min(cols as i32 - 1) {
                let outside_m = outline.outside_m(lattice.center_of(Cell::new(col, row)));
                let index = row as usize * cols + col as usize;
                if outside_m <= lattice.cell_m {
                    // Of two, the higher one says what the cell is.
                    if height > self.near_m[index] {
                        self.apart[index] = apart;
                    }
                    self.near_m[index] = self.near_m[index].max(height);
                }
                // Where two overlap, the higher one hides the other.
                if outside_m <= 0.0 {
                    self.height_m[index] = self.height_m[index].max(height);
                }
            }
        }
    }

    /// Whether an obstacle in a cell is one: near to stairs only if it is higher than they are.
    pub(crate) fn is_obstacle(&self, index: usize, top_m: f32) -> bool {
        !self.any || top_m > self.near_m[index] + OBSTACLE_M
    }

    /// Whether a cell lies in a stair's outline.
    pub(crate) fn covers(&self, index: usize) -> bool {
        self.any && !self.height_m[index].is_nan()
    }

    /// Whether a cell lies in a stair's outline or within a cell of it.
    pub(crate) fn is_near(&self, index: usize) -> bool {
        self.any && self.near_m[index] > f32::NEG_INFINITY
    }

    /// Whether a cell lies near to a stair that something known may lead to.
    pub(crate) fn is_near_climbable(&self, index: usize) -> bool {
        self.is_near(index) && !self.apart[index]
    }

    /// The cells of stairs.
    pub(crate) fn cells(&self) -> impl Iterator<Item = usize> {
        let cells = self.height_m.iter().enumerate();
        cells.filter(|(_, height)| !height.is_nan()).map(|(i, _)| i)
    }

    /// Overwrites the heights of the cells of stairs, row by row, but well inside the level at `robot_m` that the robot stands on: the
    /// outline of the floor beyond that level's side is a guess where it was seen in part, and may reach across it.
    pub(crate) fn lay(&mut self, height_m: &mut [f32], cols: usize, robot_m: f64, max_step_m: f64) {
        if !self.any {
            return;
        }
        let is_lower = |tread_m: f32| f64::from(tread_m) - robot_m < -max_step_m;
        let lower = (0..height_m.len()).filter(|&index| is_lower(self.height_m[index]));
        let inside = lower.filter(|&index| {
            let around = around(index, INSIDE_CELLS, (cols, height_m.len() / cols));
            is_level(
                around.map(|cell| f64::from(height_m[cell]) - robot_m),
                max_step_m,
            )
        });
        self.inside.clear();
        self.inside.extend(inside);
        for &index in &self.inside {
            let seen_m = height_m[index];
            self.height_m[index] = if seen_m.is_nan() {
                robot_m as f32
            } else {
                seen_m
            };
        }
        for (height, &tread) in height_m.iter_mut().zip(&self.height_m) {
            if !tread.is_nan() {
                *height = tread;
            }
        }
    }

    /// The obstacles of a view, and what is unknown, as stairs leave them.
    pub(crate) fn read_surfaces(
        &self,
        view: &FloorView,
        blocked: &mut Vec<bool>,
        unknown: &mut Vec<bool>,
    ) {
        blocked.clear();
        unknown.clear();
        for (index, surface) in view.cells.values().iter().enumerate() {
            let (stands, riser) = match *surface {
                Surface::Obstacle(top) => {
                    let stands = self.is_obstacle(index, top);
                    (stands, !stands)
                }
                Surface::Unknown => (false, true),
                Surface::Floor(_) => (false, false),
            };
            blocked.push(stands);
            unknown.push(riser && !self.covers(index));
        }
    }
}

/// The cells of a square around one, up to so many cells away.
fn around(index: usize, cells: usize, (cols, rows): (usize, usize)) -> impl Iterator<Item = usize> {
    let (col, row) = (index % cols, index / cols);
    let across = col.saturating_sub(cells)..(col + cells + 1).min(cols);
    let rows = row.saturating_sub(cells)..(row + cells + 1).min(rows);
    rows.flat_map(move |row| across.clone().map(move |col| row * cols + col))
}

/// Whether none of these heights over a level, m, is another level's, and enough are known.
fn is_level(mut above_m: impl Iterator<Item = f64>, max_step_m: f64) -> bool {
    let mut seen = 0;
    let same = above_m.all(|above_m| {
        seen += usize::from(!above_m.is_nan());
        above_m.is_nan() || above_m.abs() <= max_step_m
    });
    same && seen >= SEEN_CELLS
}

/// Whether a stair is a step up to another one: near to it, and lower by no more than can be climbed.
fn leads_to(from: &Stair<Map>, to: &Stair<Map>, step_m: f64) -> bool {
    let rise_m = to.height_m() - from.height_m();
    let [a, b] = [from, to].map(Outline::of);
    let corner_near = |a: &Outline, b: &Outline| {
        b.corners_m
            .iter()
            .any(|&corner| a.outside_m(corner) <= NEXT_M)
    };
    rise_m > 0.0 && rise_m <= step_m && (corner_near(&a, &b) || corner_near(&b, &a))
}

/// A stair seen from above.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Outline {
    /// Counter-clockwise.
    corners_m: [[f64; 2]; 4],
    /// From each corner to the next, and how far that is, m.
    sides: [([f64; 2], f64); 4],
}

impl Outline {
    pub(crate) fn of(stair: &Stair<Map>) -> Self {
        let corners = [
            stair.front.right,
            stair.back.right,
            stair.back.left,
            stair.front.left,
        ];
        let corners_m = corners.map(|corner| [corner.inner.x, corner.inner.y]);
        let sides = std::array::from_fn(|i| {
            let [from, to] = [corners_m[i], corners_m[(i + 1) % 4]];
            let side: [f64; 2] = [to[0] - from[0], to[1] - from[1]];
            (side, side[0].hypot(side[1]))
        });
        Self { corners_m, sides }
    }

    fn bounds_m(&self) -> ([f64; 2], [f64; 2]) {
        let fold = |axis: usize, pick: fn(f64, f64) -> f64| {
            let values = self.corners_m.iter().map(|corner| corner[axis]);
            values.reduce(pick).unwrap_or(0.0)
        };
        (
            [fold(0, f64::min), fold(1, f64::min)],
            [fold(0, f64::max), fold(1, f64::max)],
        )
    }

    /// How far a place lies beyond the side that it is furthest beyond, m; negative inside.
    pub(crate) fn outside_m(&self, [x, y]: [f64; 2]) -> f64 {
        let mut furthest = f64::NEG_INFINITY;
        for (from, (side, length)) in self.corners_m.iter().zip(self.sides) {
            if length > 1e-6 {
                let beyond = ((x - from[0]) * side[1] - (y - from[1]) * side[0]) / length;
                furthest = furthest.max(beyond);
            }
        }
        furthest
    }
}
