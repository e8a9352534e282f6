//! Costs of ways between the cells, interpolated along the line from a neighbour to the next one (Ferguson and Stentz 2005: Field D*).
//!
//! The nodes are the cells' middles, so that the eight steps of the grid are part of it; a way may cross the line between two neighbouring
//! middles anywhere, at evenly spaced places. What it costs is exact: the length in each cell times the cell's weight.

use super::fixed_cost::{Cost, NEVER, between, fixed};
use super::neighbours::Cells;

/// The straight neighbours in a circle, each with the diagonal ones beside it: columns, rows.
const EDGES: [[(isize, isize); 2]; 8] = [
    [(1, 0), (1, 1)],
    [(1, 0), (1, -1)],
    [(-1, 0), (-1, 1)],
    [(-1, 0), (-1, -1)],
    [(0, 1), (1, 1)],
    [(0, 1), (-1, 1)],
    [(0, -1), (1, -1)],
    [(0, -1), (-1, -1)],
];

/// Where a way may cross the line from a straight neighbour to a diagonal one.
#[derive(Debug, Clone)]
pub(crate) struct Interpolation {
    crossings: Vec<Crossing>,
}

/// A place on the line, and how long the way there is in each of the three cells.
#[derive(Debug, Clone, Copy)]
struct Crossing {
    /// Its share of the way to the diagonal neighbour.
    share: f64,
    own: f64,
    straight: f64,
    diagonal: f64,
}

impl Interpolation {
    /// Crossings that part the line into so many pieces.
    pub(crate) fn new(pieces: usize) -> Self {
        let crossing = |at: usize| {
            let share = at as f64 / pieces as f64;
            let length = geometry::hypot(1.0, share);
            // The way leaves the cell after half of its length, and the straight neighbour when it is half a cell aside.
            let aside = (0.5 / share).min(1.0);
            Crossing {
                share,
                own: 0.5 * length,
                straight: (aside - 0.5) * length,
                diagonal: (1.0 - aside) * length,
            }
        };
        Self {
            crossings: (1..pieces).map(crossing).collect(),
        }
    }

    /// The least that a way from a cell costs which leads between its neighbours; `found` are the costs from these.
    pub(crate) fn ahead(
        &self,
        cells: &Cells<'_>,
        cell: usize,
        found: impl Fn(usize) -> Cost,
    ) -> Cost {
        let own = f64::from(cells.weight_to_leave(cell));
        let mut best = NEVER;
        for [straight, diagonal] in EDGES {
            let beside = |(cols, rows)| {
                let (at, weight) = cells.free_at(cell, cols, rows)?;
                Some((found(at), f64::from(weight)))
            };
            let (Some((near, weight)), Some((far, far_weight))) =
                (beside(straight), beside(diagonal))
            else {
                continue;
            };
            // Where the diagonal neighbour is no nearer to the end, the way is best off straight.
            if far >= near || near >= NEVER {
                continue;
            }
            for crossing in &self.crossings {
                let there = crossing.own * own
                    + crossing.straight * weight
                    + crossing.diagonal * far_weight;
                best = best.min(fixed(there) + between(near, far, crossing.share));
            }
        }
        best
    }
}
