//! Why there is no way: the most specific word that holds, and a sentence with figures.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::route::Ends;
use crate::search::for_each_neighbour;
use crate::terrain::Terrain;
use crate::{Goal, NoWay, Refusal};

/// Gaps narrower than this are cracks between obstacles as the map has them, no ways, m.
const CRACK_M: f64 = 0.1;

/// Explains why the robot, which needs `needed_m` around its middle, finds no way from `start`.
pub(crate) fn explain(
    terrain: &Terrain,
    ends: &Ends<'_>,
    start: usize,
    needed_m: f64,
    goal: &Goal,
) -> NoWay {
    let widest = widest_way(terrain, ends, start);
    let gap_m = 2.0 * widest.clearance_m;
    if gap_m >= CRACK_M {
        let needed = 2.0 * needed_m;
        return NoWay {
            refusal: Refusal::TooNarrow,
            sentence: format!("the widest gap is {gap_m:.2} m, {needed:.2} m are needed"),
        };
    }
    let nearest = widest.nearest_cells * terrain.lattice.cell_m;
    let free_end = |index: usize| !terrain.blocked[index] && ends.cost(index).is_some();
    let sentence = if (0..terrain.blocked.len()).any(free_end) {
        format!("no way around what stands there leads nearer to the goal than {nearest:.2} m")
    } else {
        let radius = goal.radius_m;
        format!("no place within {radius:.2} m of the goal is free to stand on")
    };
    NoWay {
        refusal: Refusal::Blocked,
        sentence,
    }
}

struct Widest {
    /// Clearance at the narrowest place of the widest way, m; 0 where there is no way for a point either.
    clearance_m: f64,
    /// Octile distance in cells from the goal that a point could reach by gaps wider than a crack.
    nearest_cells: f64,
}

/// The way whose narrowest place is the widest, for a point that only obstacles stop.
fn widest_way(terrain: &Terrain, ends: &Ends<'_>, start: usize) -> Widest {
    let open: Vec<f32> = terrain
        .blocked
        .iter()
        .map(|&blocked| if blocked { f32::INFINITY } else { 1.0 })
        .collect();
    let mut seen = vec![false; open.len()];
    let mut queue = BinaryHeap::from([(u32::MAX, Reverse(start))]);
    let mut nearest_cells = f64::INFINITY;
    while let Some((narrowest, Reverse(cell))) = queue.pop() {
        if std::mem::replace(&mut seen[cell], true) {
            continue;
        }
        let clearance_m = f64::from(narrowest).sqrt() * terrain.lattice.cell_m;
        if 2.0 * clearance_m >= CRACK_M {
            nearest_cells = nearest_cells.min(ends.remaining(cell));
        }
        if ends.cost(cell).is_some() {
            return Widest {
                clearance_m,
                nearest_cells,
            };
        }
        for_each_neighbour(&open, terrain.cols, cell, |next, _| {
            if !seen[next] {
                // Where the robot already stands too near it may leave: that does not narrow the way.
                let leaving = terrain.weights[next].is_finite();
                let here = if leaving {
                    u32::MAX
                } else {
                    terrain.distance.squared(next)
                };
                queue.push((narrowest.min(here), Reverse(next)));
            }
        });
    }
    Widest {
        clearance_m: 0.0,
        nearest_cells: nearest_cells.min(ends.remaining(start)),
    }
}
