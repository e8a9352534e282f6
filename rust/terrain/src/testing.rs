//! Floors for tests of the rules, and the rules up to one of them.

use geometry::{Grid, Lattice, Map, Point};
use mapping::{FloorView, Surface};
use stairs::{Edge, Sides, Stair, Staircase};

use crate::{CellSettings, HeightLimits, Needs, Rectangle, Rules, Sight, StandingAt, Terrain};

/// Side of a cell, m.
const CELL_M: f64 = 0.05;

/// A robot in the middle of the floor, on it.
pub(crate) fn stand() -> StandingAt {
    StandingAt {
        at_m: [0.0; 2],
        height_m: 0.0,
        heading_rad: 0.0,
        gradient: [0.0; 2],
    }
}

/// A stair across the x axis.
pub(crate) fn stair(x_m: f64, depth_m: f64, height_m: f64, width_m: f64) -> Stair<Map> {
    let edge = |x_m: f64| Edge {
        left: Point::new(x_m, 0.5 * width_m, height_m),
        right: Point::new(x_m, -0.5 * width_m, height_m),
    };
    Stair {
        front: edge(x_m),
        back: edge(x_m + depth_m),
        reference: Point::new(x_m + 0.5 * depth_m, 0.0, height_m),
        left_margin_m: 0.0,
        right_margin_m: 0.0,
        support: 500,
        seen_ends: Sides::default(),
        front_fit: None,
        back_fit: None,
        seen_from_m: 0.3,
        steps_ago: 0,
    }
}

/// What users set by default.
pub(crate) fn settings() -> CellSettings {
    CellSettings {
        judge_range: 0.8,
        lone_cells: 2,
        step_sightings: 3,
        max_step: 0.01,
        step_sigmas: 2.0,
        slope_step: 0.02,
        max_slope: 0.2,
        blind: 0.2,
        soft_range: 0.16,
        soft_cost: 1.5,
        unknown_cost: 1.0,
        escape_cost: 20.0,
        escape_range: 0.3,
        sideways_cost: 1.5,
    }
}

/// A robot of 0.17 m that is narrower sideways.
pub(crate) fn terrain() -> Terrain {
    let needs = Needs {
        body_m: 0.17,
        feet_m: 0.1,
        limits: HeightLimits {
            floor_m: 0.01,
            step_m: 0.0525,
        },
        turned: Some(Rectangle {
            half_depth_m: 0.1,
            half_width_m: 0.2,
        }),
    };
    Terrain::new(needs, settings())
}

/// A window of floor, 4 m a side, around the robot, and the stairs in it.
pub(crate) struct Floor {
    pub(crate) view: FloorView,
    pub(crate) stairs: Staircase,
    pub(crate) stand: StandingAt,
    pub(crate) goal_m: Option<f64>,
}

impl Floor {
    pub(crate) fn new() -> Self {
        Self {
            view: FloorView::new(
                Lattice {
                    origin_m: [-2.0, -2.0],
                    cell_m: CELL_M,
                },
                Grid::filled(80, 80, Surface::Floor(0.0)),
                9,
            ),
            stairs: Staircase::default(),
            stand: stand(),
            goal_m: None,
        }
    }

    /// Whether a cell's centre lies in the rectangle.
    fn cells_in(&self, min: [f64; 2], max: [f64; 2]) -> Vec<geometry::Cell> {
        let inside = |cell: &geometry::Cell| {
            let [x, y] = self.view.lattice.center_of(*cell);
            x > min[0] && x < max[0] && y > min[1] && y < max[1]
        };
        self.view.cells.area().cells().filter(inside).collect()
    }

    /// Sets all cells whose centre lies in the rectangle.
    pub(crate) fn paint(&mut self, min: [f64; 2], max: [f64; 2], surface: Surface) {
        for cell in self.cells_in(min, max) {
            *self.view.cells.get_mut(cell).unwrap() = surface;
        }
    }

    /// Tilts all cells whose centre lies in the rectangle along x.
    pub(crate) fn tilt(&mut self, min: [f64; 2], max: [f64; 2], rise_per_m: f32) {
        for cell in self.cells_in(min, max) {
            *self.view.gradients.get_mut(cell).unwrap() = [rise_per_m, 0.0];
        }
    }

    /// Says how sure the heights are of all cells whose centre lies in the rectangle.
    pub(crate) fn doubt(&mut self, min: [f64; 2], max: [f64; 2], sigma_m: f32) {
        for cell in self.cells_in(min, max) {
            *self.view.sigmas_m.get_mut(cell).unwrap() = sigma_m;
        }
    }

    /// Makes a slope of all cells whose centre lies in the rectangle: along x from one height to another.
    pub(crate) fn ramp(&mut self, min: [f64; 2], max: [f64; 2], [from_m, to_m]: [f64; 2]) {
        let rise_per_m = (to_m - from_m) / (max[0] - min[0]);
        for cell in self.cells_in(min, max) {
            let [x, _] = self.view.lattice.center_of(cell);
            let height_m = from_m + rise_per_m * (x - min[0]);
            *self.view.cells.get_mut(cell).unwrap() = Surface::Floor(height_m as f32);
        }
        self.tilt(min, max, rise_per_m as f32);
    }

    /// What the rules make of it up to and with the one of this name.
    pub(crate) fn after(&self, rule: &str) -> Terrain {
        let (mut rules, mut terrain) = (Rules::default(), terrain());
        self.read(&mut rules, &mut terrain, rule);
        terrain
    }

    /// Reads it up to a rule with rules that remember, over a terrain that was read before.
    pub(crate) fn read(&self, rules: &mut Rules, terrain: &mut Terrain, rule: &str) {
        let sight = Sight {
            view: &self.view,
            stairs: &self.stairs,
            stand: self.stand,
            goal_m: self.goal_m,
        };
        rules.read_until(rule, terrain, &sight);
    }

    /// What the rules make of it up to, but without, the one of this name.
    pub(crate) fn before(&self, rule: &str) -> Terrain {
        let at = crate::RULES.iter().position(|one| one.name.word() == rule);
        self.after(&crate::RULES[at.unwrap() - 1].name.word())
    }
}

/// The cell of a place, m.
pub(crate) fn cell(terrain: &Terrain, x_m: f64, y_m: f64) -> usize {
    terrain.index_at([x_m, y_m]).unwrap()
}
