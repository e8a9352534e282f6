//! The way over the ground outside of the window, from everywhere to the goal: found no further than it is asked about.

use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use geometry::distance::CellDistances;
use geometry::{Dijkstra, Lattice};
use terrain::Terrain;

use super::ground::{GroundOutside, SIDE, cell_at};
use crate::Goal;

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

/// Where the robot has room, and how long the way to the goal is from there. Reused.
#[derive(Debug, Default)]
pub(super) struct WayToGoal {
    distance: CellDistances,
    /// Behind a lock as those who ask only read: a search asks about the border's cells that it comes upon, which are few.
    nodes: Mutex<Nodes>,
}

#[derive(Debug, Clone, Default)]
struct Nodes {
    /// Which of a node's cells the robot may be in, a bit each: 1 for the first, 2 for the one a column on, 4 and 8 for the row after.
    open: Vec<u8>,
    /// What a length costs there.
    weights: Vec<f32>,
    /// Length of the way from each node to the goal, in nodes, as far as it is found; infinite where none leads.
    to_goal: Vec<f32>,
    dijkstra: Dijkstra,
}

impl Clone for WayToGoal {
    fn clone(&self) -> Self {
        let nodes = self.nodes.lock().unwrap_or_else(PoisonError::into_inner);
        Self {
            distance: self.distance.clone(),
            nodes: Mutex::new(nodes.clone()),
        }
    }
}

impl WayToGoal {
    /// Another way to a goal. `knows_window`: whether what a length costs in the window is taken from there.
    pub(super) fn begin(
        &mut self,
        ground: &GroundOutside,
        terrain: &Terrain,
        knows_window: bool,
        goal: &Goal,
    ) {
        let nodes = self.nodes.get_mut().unwrap_or_else(PoisonError::into_inner);
        if let Some(lattice) = &ground.lattice {
            let room = terrain.needs.body_m / terrain.lattice.cell_m;
            self.distance
                .compute_within(&ground.blocked, SIDE, room.ceil() as usize);
            let squared = &self.distance.squared;
            nodes.open_cells(squared, (room * room).ceil() as u32);
            if knows_window {
                nodes.open_window(lattice, terrain, squared, room * room);
            }
        }
        nodes.aim(ground.lattice.as_ref(), goal);
    }

    /// Length of the way to the goal from a cell, m; `None` where the robot has no room around. Beside what it may not come near to, what
    /// is around counts.
    pub(super) fn length_m(&self, cell: [usize; 2], cell_m: f64) -> Option<f64> {
        let mut nodes = self.nodes.lock().unwrap_or_else(PoisonError::into_inner);
        let [col, row] = cell.map(|at| at / APART);
        let mut length = |(cols, rows)| nodes.length(node(col, row, cols, rows)?);
        let mut nodes = length((0, 0));
        if nodes.is_none() {
            let around = STEPS.iter().filter_map(|&(c, r, _)| length((c, r)));
            nodes = around.reduce(f32::min);
        }
        nodes.map(|nodes| f64::from(nodes) * (APART as f64 * cell_m))
    }
}

impl Nodes {
    /// Opens the cells that are no nearer to what is blocked than that, squared and in cells.
    fn open_cells(&mut self, squared: &[u32], least: u32) {
        self.open.clear();
        self.open.resize(NODES * NODES, 0);
        for (row, squared) in squared.chunks_exact(SIDE).enumerate() {
            let open = &mut self.open[row / APART * NODES..][..NODES];
            let first = row % APART * APART;
            for (open, squared) in open.iter_mut().zip(squared.as_chunks::<APART>().0) {
                let [here, beside] = squared.map(|squared| u8::from(squared >= least));
                *open |= (here | beside << 1) << first;
            }
        }
        self.weights.clear();
        let weight = |&open: &u8| if open == 0 { f32::INFINITY } else { 1.0 };
        self.weights.extend(self.open.iter().map(weight));
    }

    /// Opens the cells of the window as its terrain says, and where nodes reach out of it as [`Self::open_cells`] does.
    fn open_window(&mut self, lattice: &Lattice, terrain: &Terrain, squared: &[u32], least: f64) {
        let at_m = |at: usize| (at as f64 + 0.5) * lattice.cell_m;
        let [x, y] = lattice.origin_m;
        let place_m = |col: usize, row: usize| [x + at_m(col), y + at_m(row)];
        let (cols, rows) = (
            nodes_within(|at| {
                let col = terrain.lattice.cell_at(place_m(at, at)[0], 0.0).col;
                usize::try_from(col).is_ok_and(|col| col < terrain.cols)
            }),
            nodes_within(|at| {
                let row = terrain.lattice.cell_at(0.0, place_m(at, at)[1]).row;
                usize::try_from(row).is_ok_and(|row| row < terrain.rows)
            }),
        );
        for (node_col, node_row) in rows.flat_map(|row| cols.clone().map(move |col| (col, row))) {
            let (mut open, mut least_weight) = (0, f32::INFINITY);
            for at in 0..APART * APART {
                let [col, row] = [node_col * APART + at % APART, node_row * APART + at / APART];
                let known = terrain.index_at(place_m(col, row));
                let weight = known.map_or_else(
                    || {
                        let roomy = f64::from(squared[row * SIDE + col]) >= least;
                        if roomy { 1.0 } else { f32::INFINITY }
                    },
                    |cell| terrain.weights[cell],
                );
                if weight.is_finite() {
                    open |= 1 << at;
                    least_weight = least_weight.min(weight);
                }
            }
            let node = node_row * NODES + node_col;
            (self.open[node], self.weights[node]) = (open, least_weight);
        }
    }

    /// Begins at the goal.
    fn aim(&mut self, lattice: Option<&Lattice>, goal: &Goal) {
        self.dijkstra.clear();
        self.to_goal.clear();
        self.to_goal.resize(NODES * NODES, f32::INFINITY);
        let at = lattice.and_then(|lattice| cell_at(lattice, [goal.x_m, goal.y_m]));
        let Some(goal) = at
            .map(|at| at.map(|at| at / APART))
            .and_then(|[col, row]| node(col, row, 0, 0))
        else {
            return;
        };
        self.open[goal] = ALL;
        (self.dijkstra).begin_at(&mut self.to_goal, goal as u32, 0.0);
    }

    /// Length of the way from a node, in nodes; `None` where the robot has no room.
    fn length(&mut self, node: usize) -> Option<f32> {
        if self.open[node] == 0 {
            return None;
        }
        let (open, weights) = (&self.open, &self.weights);
        let steps = |from: u32| {
            let from = from as usize;
            STEPS.iter().filter_map(move |&(cols, rows, step)| {
                if open[from] & facing(cols, rows) == 0 {
                    return None;
                }
                let to = self::node(from % NODES, from / NODES, cols, rows)?;
                (open[to] & facing(-cols, -rows) != 0).then(|| (to as u32, step * weights[to]))
            })
        };
        (self.dijkstra).run_to(&mut self.to_goal, node as u32, steps);
        Some(self.to_goal[node])
    }
}

/// The nodes of which a column or row, by its number, is within.
fn nodes_within(within: impl Fn(usize) -> bool) -> Range<usize> {
    let first = (0..SIDE).position(&within).unwrap_or(0);
    let end = (first..SIDE).take_while(|&at| within(at)).count() + first;
    first / APART..end.div_ceil(APART)
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
