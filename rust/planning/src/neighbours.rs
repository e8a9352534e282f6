//! Steps from a cell to its eight neighbours.

use std::f64::consts::SQRT_2;

/// The direction of a step: west, east, south, north, then south west, south east, north west, north east.
pub(crate) type Heading = u8;
/// No step led here.
pub(crate) const ANYWHERE: Heading = 8;

const WEST: u8 = 1;
const EAST: u8 = 1 << 1;
const SOUTH: u8 = 1 << 2;
const NORTH: u8 = 1 << 3;
const SOUTH_WEST: u8 = 1 << 4;
const SOUTH_EAST: u8 = 1 << 5;
const NORTH_WEST: u8 = 1 << 6;
const NORTH_EAST: u8 = 1 << 7;

/// For each heading the cell from which the step led and those of its neighbours that are neighbours here, too, and which it came
/// upon by a straight step: that costs less than to go by this cell, whatever the weights.
const BEHIND: [u8; 9] = [
    EAST | SOUTH_EAST | NORTH_EAST,
    WEST | SOUTH_WEST | NORTH_WEST,
    NORTH | NORTH_WEST | NORTH_EAST,
    SOUTH | SOUTH_WEST | SOUTH_EAST,
    NORTH | EAST | NORTH_EAST,
    NORTH | WEST | NORTH_WEST,
    SOUTH | EAST | SOUTH_EAST,
    SOUTH | WEST | SOUTH_WEST,
    0,
];

/// Calls `visit` with every free neighbour of a cell, the length of the step and its heading; but for those behind, where a step
/// led to the cell.
#[inline]
pub(crate) fn for_each_neighbour(
    weights: &[f32],
    cols: usize,
    (cell, heading): (usize, Heading),
    mut visit: impl FnMut(usize, f64, Heading),
) {
    let col = cell % cols;
    // Row 0 has nothing below it: the index wraps around and is free nowhere.
    let (below, above) = (cell.wrapping_sub(cols), cell + cols);
    let [south_west, south, south_east] = free_about(weights, below);
    let [west, _, east] = free_about(weights, cell);
    let [north_west, north, north_east] = free_about(weights, above);
    let (west, east) = (west && col > 0, east && col + 1 < cols);
    let open = [
        west,
        east,
        south,
        north,
        south_west && west && south,
        south_east && east && south,
        north_west && west && north,
        north_east && east && north,
    ];
    let neighbours = [
        cell.wrapping_sub(1),
        cell + 1,
        below,
        above,
        below.wrapping_sub(1),
        below.wrapping_add(1),
        above.wrapping_sub(1),
        above + 1,
    ];
    let mut steps = 0;
    for (at, open) in open.into_iter().enumerate() {
        steps |= u8::from(open) << at;
    }
    steps &= !BEHIND[usize::from(heading)];
    while steps != 0 {
        let at = steps.trailing_zeros() as Heading;
        steps &= steps - 1;
        let length = if at < 4 { 1.0 } else { SQRT_2 };
        visit(neighbours[usize::from(at)], length, at);
    }
}

/// Whether the cells before, at and behind an index are free.
#[inline]
fn free_about(weights: &[f32], index: usize) -> [bool; 3] {
    let first = index.wrapping_sub(1);
    if let Some(&[before, here, behind]) = weights.get(first..first.wrapping_add(3)) {
        return [before, here, behind].map(f32::is_finite);
    }
    let free = |index: usize| weights.get(index).is_some_and(|weight| weight.is_finite());
    [free(first), free(index), free(index.wrapping_add(1))]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const COLS: usize = 5;

    proptest! {
        #[test]
        fn what_is_behind_was_nearer_from_the_cell_before(
            weights in prop::collection::vec(prop_oneof![4 => 1.0..9.0f32, 1 => Just(f32::INFINITY)], COLS * 4),
            before in 0..COLS * 4,
        ) {
            let cost = |from: usize, to: usize, length: f64| length * 0.5 * f64::from(weights[from] + weights[to]);
            prop_assume!(weights[before].is_finite());
            let mut from_before = vec![];
            for_each_neighbour(&weights, COLS, (before, ANYWHERE), |next, length, heading| from_before.push((next, length, heading)));
            for &(cell, length, heading) in &from_before {
                let (mut ahead, mut all) = (vec![], vec![]);
                for_each_neighbour(&weights, COLS, (cell, heading), |next, _, _| ahead.push(next));
                for_each_neighbour(&weights, COLS, (cell, ANYWHERE), |next, length, _| all.push((next, length)));
                for (next, on) in all.into_iter().filter(|(next, _)| !ahead.contains(next) && *next != before) {
                    let straight = from_before.iter().find(|step| step.0 == next).unwrap();
                    let by_cell = cost(before, cell, length) + cost(cell, next, on);
                    prop_assert!(cost(before, next, straight.1) < by_cell);
                }
            }
        }
    }
}
