//! What was seen of the ground outside of the window while it was in it: how far it is from the window's border to the goal.
//!
//! Without this the robot would hope for a way that it found closed as soon as that has left the window, and go to and fro for ever. So
//! would one whose way leads out of the window and back into it, around a wall that is longer, as soon as the goal comes in sight.

mod ground;

use geometry::Dijkstra;
use geometry::distance::CellDistances;
use terrain::Terrain;

use crate::{Goal, tuning::OutsideWindowTuning};
use ground::{GroundOutside, SIDE, cell_at};

/// The way is looked for over nodes of so many of them each way. Of four all lie beside each other, so that a node says exactly which
/// of its cells lead to which of the next one's: a gap between two round things may be too narrow at a single row of cells.
const APART: usize = 2;
const NODES: usize = SIDE / APART;
/// Steps to the eight neighbours: columns, rows, and their length in nodes.
const STEPS: [(isize, isize, f32); 8] = [
    (1, 0, 1.0),
    (-1, 0, 1.0),
    (0, 1, 1.0),
    (0, -1, 1.0),
    (1, 1, std::f32::consts::SQRT_2),
    (1, -1, std::f32::consts::SQRT_2),
    (-1, 1, std::f32::consts::SQRT_2),
    (-1, -1, std::f32::consts::SQRT_2),
];

/// The ground around as it was when it was seen last.
#[derive(Debug, Clone, Default)]
pub(crate) struct OutsideWindow {
    tuning: OutsideWindowTuning,
    ground: GroundOutside,
    distance: CellDistances,
    /// Which of a node's cells the robot may be in, a bit each: 1 for the first, 2 for the one a column on, 4 and 8 for the row after.
    open: Vec<u8>,
    /// What a length costs there.
    weights: Vec<f32>,
    /// Length of the way from each node to the goal, in nodes; infinite where none leads.
    to_goal: Vec<f32>,
    dijkstra: Dijkstra,
    goal: Option<Goal>,
    plans: u32,
    field: Field,
}

/// What the field over the ground says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Field {
    /// No more than the straight line does.
    #[default]
    Straight,
    /// How far it is to a goal outside of the window.
    Outside,
    /// How far it is to a goal in the window from its border.
    Around,
}

impl OutsideWindow {
    /// Nothing is known yet.
    pub(crate) fn new(tuning: OutsideWindowTuning) -> Self {
        Self {
            tuning,
            ..Self::default()
        }
    }

    /// Forgets what was seen.
    pub(crate) fn forget(&mut self) {
        *self = Self::new(self.tuning.clone());
    }

    /// Takes in what the window shows to a robot that stands at a place, m. Afterwards the field leads to the goal.
    pub(crate) fn look(&mut self, terrain: &Terrain, robot_m: [f64; 2], goal: &Goal) {
        if self.ground.take_in(terrain, robot_m, self.tuning.near) {
            (self.field, self.goal) = (Field::Straight, None);
        }
        self.plans = self.plans.saturating_add(1);
        let inside = terrain.index_at([goal.x_m, goal.y_m]).is_some();
        let is_old = self.goal != Some(*goal) || self.plans >= self.tuning.plans;
        if inside && (is_old || self.field == Field::Outside) {
            self.field = Field::Straight;
        } else if !inside && (is_old || self.field == Field::Around) {
            (self.goal, self.plans) = (Some(*goal), 0);
            self.field = Field::Straight;
            if self.ground.is_blocked_outside(terrain) {
                self.field = Field::Outside;
                self.open_cells(terrain, |_| None);
                self.aim(goal);
            }
        }
    }

    /// Takes the ways into account that lead out of the window and back into it, to a goal that lies in it.
    pub(crate) fn look_around(&mut self, terrain: &Terrain, goal: &Goal) {
        if self.field == Field::Around {
            return;
        }
        (self.goal, self.plans) = (Some(*goal), 0);
        self.field = Field::Around;
        self.open_cells(terrain, |at_m| {
            terrain.index_at(at_m).map(|cell| terrain.weights[cell])
        });
        self.aim(goal);
    }

    /// Length of the way from a place to the goal, m, as far as is known: the straight line where nothing is; infinite where no way leads
    /// around. A way to a goal outside of the window is a long one from where the robot has no room, as at a wall at the border.
    pub(crate) fn left_m(&self, at_m: [f64; 2], goal: &Goal) -> f64 {
        let straight_m = (goal.x_m - at_m[0]).hypot(goal.y_m - at_m[1]);
        let has_field = self.field != Field::Straight;
        let known_m = self
            .ground
            .lattice
            .filter(|_| has_field)
            .and_then(|lattice| {
                let [col, row] = cell_at(&lattice, at_m)?.map(|at| at / APART);
                let length = |(cols, rows)| {
                    let node = node(col, row, cols, rows)?;
                    (self.open[node] != 0).then(|| self.to_goal[node])
                };
                // Beside what the robot may not come near to, what is around counts.
                let around = STEPS.iter().filter_map(|&(c, r, _)| length((c, r)));
                let nodes = length((0, 0)).or_else(|| around.reduce(f32::min));
                let node_m = APART as f64 * lattice.cell_m;
                let shut_m = match self.field {
                    Field::Around => f64::INFINITY,
                    Field::Straight | Field::Outside => straight_m + self.tuning.shut,
                };
                Some(nodes.map_or(shut_m, |nodes| f64::from(nodes) * node_m))
            });
        known_m
            .filter(|m| m.is_finite() || self.field == Field::Around)
            .map_or(straight_m, |known_m| known_m.max(straight_m))
    }

    /// Finds where the robot has room. `known`: what a length costs at a place where that is known better, infinite where it may not be.
    fn open_cells(&mut self, terrain: &Terrain, known: impl Fn([f64; 2]) -> Option<f32>) {
        let Some(lattice) = self.ground.lattice else {
            return;
        };
        self.distance.compute(&self.ground.blocked, SIDE);
        self.open.clear();
        self.open.resize(NODES * NODES, 0);
        self.weights.clear();
        self.weights.resize(NODES * NODES, f32::INFINITY);
        let room = terrain.needs.body_m / terrain.lattice.cell_m;
        let [x, y] = lattice.origin_m;
        for (cell, &squared) in self.distance.squared.iter().enumerate() {
            let [col, row] = [cell % SIDE, cell / SIDE];
            let at_m = |at: usize| (at as f64 + 0.5) * lattice.cell_m;
            let weight = known([x + at_m(col), y + at_m(row)]).unwrap_or_else(|| {
                if f64::from(squared) >= room * room {
                    1.0
                } else {
                    f32::INFINITY
                }
            });
            if weight.is_finite() {
                let node = row / APART * NODES + col / APART;
                self.open[node] |= 1 << (row % APART * APART + col % APART);
                self.weights[node] = self.weights[node].min(weight);
            }
        }
    }

    /// Finds the way from everywhere to the goal over what is open.
    fn aim(&mut self, goal: &Goal) {
        self.to_goal.clear();
        self.to_goal.resize(NODES * NODES, f32::INFINITY);
        let at = (self.ground.lattice).and_then(|lattice| cell_at(&lattice, [goal.x_m, goal.y_m]));
        let Some(goal) = at
            .map(|at| at.map(|at| at / APART))
            .and_then(|[col, row]| node(col, row, 0, 0))
        else {
            return;
        };
        self.open[goal] = ALL;
        let (open, weights) = (&self.open, &self.weights);
        let steps = |from: u32| {
            let from = from as usize;
            STEPS.iter().filter_map(move |&(cols, rows, step)| {
                if open[from] & facing(cols, rows) == 0 {
                    return None;
                }
                let to = node(from % NODES, from / NODES, cols, rows)?;
                (open[to] & facing(-cols, -rows) != 0).then(|| (to as u32, step * weights[to]))
            })
        };
        (self.dijkstra).begin_at(&mut self.to_goal, goal as u32, 0.0);
        self.dijkstra.run(&mut self.to_goal, steps, |_, _| {});
    }
}

/// All cells of a node.
const ALL: u8 = 0b1111;

/// The cells of a node that lie beside the one so many columns and rows further.
const fn facing(cols: isize, rows: isize) -> u8 {
    let across = match cols {
        1 => 0b1010,
        -1 => 0b0101,
        _ => ALL,
    };
    let along = match rows {
        1 => 0b1100,
        -1 => 0b0011,
        _ => ALL,
    };
    across & along
}

/// A node so many columns and rows from another.
fn node(col: usize, row: usize, cols: isize, rows: isize) -> Option<usize> {
    let (col, row) = (col.checked_add_signed(cols)?, row.checked_add_signed(rows)?);
    (col < NODES && row < NODES).then_some(row * NODES + col)
}

#[cfg(test)]
mod tests;
