//! The grid as square local maps, and the gates through which a way leads from one to the next.

use std::ops::Range;

use geometry::Dijkstra;

use super::HierarchicalConfig;
use crate::search::neighbours::Cells;
use crate::search::steps::ANYWHERE;

/// Two cells beside each other, one on either side of a border.
type BorderPair = [u32; 2];

/// A cell from which a way leads into the next local map.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gate {
    pub(super) cell: u32,
    pub(super) map: u32,
    /// The gate on the other side of the border, by its number.
    pub(super) beyond: u32,
    /// What the step there costs, cells.
    pub(super) cost: f32,
}

/// A grid in pieces. What changes of it is found by comparison, and what was known of the pieces around is forgotten.
#[derive(Debug, Clone, Default)]
pub(super) struct LocalMaps {
    side: usize,
    longest: usize,
    pub(super) cols: usize,
    /// Local maps a row of them, and their rows.
    pub(super) size: [usize; 2],
    /// Row by row, what a length costs in a cell, as it was read last.
    pub(super) weights: Vec<f32>,
    /// Of each local map, where its right and its upper border are crossed.
    borders: Vec<[Vec<BorderPair>; 2]>,
    pub(super) gates: Vec<Gate>,
    /// First gate of each local map, and behind the last.
    first: Vec<u32>,
    /// Of each local map, what the ways between its gates cost in it, row by row; empty where not known.
    between: Vec<Vec<f32>>,
    local: LocalCosts,
}

/// What it costs to come from somewhere to each cell of one local map, within it.
#[derive(Debug, Clone, Default)]
struct LocalCosts {
    weights: Vec<f32>,
    costs: Vec<f32>,
    dijkstra: Dijkstra,
}

impl LocalMaps {
    /// Reads a grid; says whether it has the size of the one before.
    pub(super) fn read(
        &mut self,
        config: &HierarchicalConfig,
        weights: &[f32],
        cols: usize,
    ) -> bool {
        let rows = weights.len() / cols.max(1);
        let size = [cols, rows].map(|cells| cells.div_ceil(config.local_map));
        let same = (self.side, self.longest) == (config.local_map, config.gate)
            && (self.cols, self.weights.len()) == (cols, weights.len());
        let maps = size[0] * size[1];
        if !same {
            *self = Self {
                side: config.local_map,
                longest: config.gate,
                cols,
                size,
                weights: vec![f32::NAN; weights.len()],
                borders: vec![<[Vec<BorderPair>; 2]>::default(); maps],
                between: vec![Vec::new(); maps],
                local: std::mem::take(&mut self.local),
                ..Self::default()
            };
        }
        let changed: Vec<usize> = (0..maps)
            .filter(|&map| self.take_over(map, weights))
            .collect();
        let mut gates_changed = !same;
        for map in changed {
            self.between[map].clear();
            let (left, below) = (map % size[0] > 0, map >= size[0]);
            let borders = [
                Some((map, 0)),
                Some((map, 1)),
                left.then(|| (map - 1, 0)),
                below.then(|| (map - size[0], 1)),
            ];
            for (of, side) in borders.into_iter().flatten() {
                let crossings = self.crossings(of, side);
                if crossings != self.borders[of][side] {
                    gates_changed = true;
                    self.borders[of][side] = crossings;
                    for touched in [of, of + [1, size[0]][side]] {
                        self.between[touched].clear();
                    }
                }
            }
        }
        if gates_changed {
            self.number_gates();
        }
        same
    }

    /// Takes over the weights of a local map; says whether any is new.
    fn take_over(&mut self, map: usize, weights: &[f32]) -> bool {
        let mut changed = false;
        for cells in self.rows_of(map) {
            if self.weights[cells.clone()] != weights[cells.clone()] {
                changed = true;
                self.weights[cells.clone()].copy_from_slice(&weights[cells]);
            }
        }
        changed
    }

    /// The local map that holds a cell.
    pub(super) fn map_of(&self, cell: usize) -> usize {
        let (col, row) = (cell % self.cols, cell / self.cols);
        row / self.side * self.size[0] + col / self.side
    }

    /// The cells of a local map, a range each row.
    pub(super) fn rows_of(&self, map: usize) -> impl Iterator<Item = Range<usize>> + use<> {
        let (cols, side) = (self.cols, self.side);
        let [left, low] = [map % self.size[0] * side, map / self.size[0] * side];
        let right = (left + side).min(cols);
        let top = (low + side).min(self.weights.len() / cols);
        (low..top).map(move |row| row * cols + left..row * cols + right)
    }

    /// Where a local map's right (0) or upper (1) border is crossed: of every stretch of free pairs of cells no longer than a gate the
    /// cheapest one, the middle of several.
    fn crossings(&self, map: usize, side: usize) -> Vec<BorderPair> {
        let beyond = [
            map % self.size[0] + 1 < self.size[0],
            map / self.size[0] + 1 < self.size[1],
        ];
        if !beyond[side] {
            return Vec::new();
        }
        let step = [1, self.cols][side];
        let inside: Vec<usize> = if side == 0 {
            self.rows_of(map).map(|cells| cells.end - 1).collect()
        } else {
            self.rows_of(map).last().into_iter().flatten().collect()
        };
        let cost = |cell: usize| self.weights[cell] + self.weights[cell + step];
        let mut found = Vec::new();
        for stretch in
            inside.chunk_by(|&one, &next| cost(one).is_finite() == cost(next).is_finite())
        {
            if !cost(stretch[0]).is_finite() {
                continue;
            }
            let pieces = stretch.len().div_ceil(self.longest);
            for piece in 0..pieces {
                let [from, to] = [piece, piece + 1].map(|end| end * stretch.len() / pieces);
                let off = |at: usize| (2 * at + 1).abs_diff(from + to);
                let best = (from..to).min_by(|&one, &other| {
                    let by_cost = cost(stretch[one]).total_cmp(&cost(stretch[other]));
                    by_cost.then_with(|| off(one).cmp(&off(other)))
                });
                found.extend(best.map(|at| [stretch[at] as u32, (stretch[at] + step) as u32]));
            }
        }
        found
    }

    /// Numbers the gates: of each local map those at its left border, its right, its lower and its upper one.
    fn number_gates(&mut self) {
        let across = self.size[0];
        let maps = self.borders.len();
        let left = |map: usize| (!map.is_multiple_of(across)).then(|| map - 1);
        let below = |map: usize| map.checked_sub(across);
        let count =
            |of: Option<usize>, side: usize| of.map_or(0, |of| self.borders[of][side].len());
        let counts = |map| {
            [
                count(left(map), 0),
                count(Some(map), 0),
                count(below(map), 1),
                count(Some(map), 1),
            ]
        };
        self.first = vec![0; maps + 1];
        for map in 0..maps {
            self.first[map + 1] = self.first[map] + counts(map).iter().sum::<usize>() as u32;
        }
        let numbered = |map: usize, border: usize, at: usize| {
            let before: usize = counts(map)[..border].iter().sum();
            self.first[map] + (before + at) as u32
        };
        let mut gates = Vec::with_capacity(self.first[maps] as usize);
        for map in 0..maps {
            let sides = [
                (left(map), 0, 1, left(map).unwrap_or(0), 1),
                (Some(map), 0, 0, map + 1, 0),
                (below(map), 1, 1, below(map).unwrap_or(0), 3),
                (Some(map), 1, 0, map + across, 2),
            ];
            for (of, side, inner, beyond, border) in sides {
                let crossings = of.map_or(&[][..], |of| &self.borders[of][side]);
                for (at, crossing) in crossings.iter().enumerate() {
                    let weights = crossing.map(|cell| self.weights[cell as usize]);
                    gates.push(Gate {
                        cell: crossing[inner],
                        map: map as u32,
                        beyond: numbered(beyond, border, at),
                        cost: 0.5 * (weights[0] + weights[1]),
                    });
                }
            }
        }
        self.gates = gates;
    }

    /// The numbers of a local map's gates.
    pub(super) fn gates_of(&self, map: usize) -> Range<usize> {
        self.first[map] as usize..self.first[map + 1] as usize
    }

    /// What the ways within its local map from a gate to each of the map's gates cost, cells; infinite where there is none.
    pub(super) fn between_gates(&mut self, gate: usize) -> &[f32] {
        let map = self.gates[gate].map as usize;
        let gates = self.gates_of(map);
        let count = gates.len();
        if self.between[map].is_empty() {
            let mut costs = Vec::with_capacity(count * count);
            for from in gates.clone() {
                let cell = self.gates[from].cell;
                self.spread(map, &[(cell, 0.0)]);
                costs.extend(
                    gates
                        .clone()
                        .map(|to| self.cost_at(self.gates[to].cell as usize)),
                );
            }
            self.between[map] = costs;
        }
        &self.between[map][(gate - gates.start) * count..][..count]
    }

    /// Finds what it costs to come from these cells of a local map, each with what beginning there costs, to all others within it.
    pub(super) fn spread(&mut self, map: usize, from: &[(u32, f32)]) {
        let side = self.side;
        let rows = self.rows_of(map);
        let LocalCosts {
            weights,
            costs,
            dijkstra,
        } = &mut self.local;
        for filled in [&mut *weights, costs] {
            filled.clear();
            filled.resize(side * side, f32::INFINITY);
        }
        for (row, cells) in rows.enumerate() {
            weights[row * side..][..cells.len()].copy_from_slice(&self.weights[cells]);
        }
        for &(cell, cost) in from {
            let at = local(cell as usize, self.cols, side);
            if cost < costs[at] {
                dijkstra.begin_at(costs, at as u32, cost);
            }
        }
        let cells = Cells::new(weights, side);
        let steps = |here: u32| {
            let weight = cells.weight_to_leave(here as usize);
            let mut found = [(0, 0.0); 8];
            let mut count = 0;
            cells.for_each_neighbour((here as usize, ANYWHERE), |next, half_length, _| {
                let step = half_length * f64::from(weight + weights[next]);
                found[count] = (next as u32, step as f32);
                count += 1;
            });
            found.into_iter().take(count)
        };
        dijkstra.run(costs, steps, |_, _| {});
    }

    /// What was found last for a cell of that local map.
    pub(super) fn cost_at(&self, cell: usize) -> f32 {
        self.local.costs[local(cell, self.cols, self.side)]
    }
}

/// Index of a cell in its local map.
const fn local(cell: usize, cols: usize, side: usize) -> usize {
    cell / cols % side * side + cell % cols % side
}
