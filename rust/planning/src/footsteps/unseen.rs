//! Ground that was not seen: closed, or priced and looked at once the robot is near.

use std::collections::VecDeque;

use geometry::{Cell, CellArea};

/// What is made of ground that was not seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Unseen {
    /// Nobody goes there.
    Closed,
    /// The way may lead over it. A plan ends where what it knows ends, or so far before that, m.
    Priced {
        /// How far before, m.
        stop_before_m: f64,
        /// At its end the robot faces what was not seen at least so well, rad.
        faces_rad: f64,
    },
}

/// Gives cells of which nothing is known, NaN, the level of the nearest that has one, the lowest of several: behind what stands there, more
/// of that is expected, and behind floor, floor.
pub(super) fn guess_levels(levels_m: &mut [f32], cols: i32) {
    let rows = (levels_m.len() as i32).checked_div(cols).unwrap_or(0);
    let mut ring: VecDeque<u32> = (0..levels_m.len() as u32)
        .filter(|&node| levels_m[node as usize].is_finite())
        .collect();
    ring.make_contiguous().sort_by(|a, b| {
        levels_m[*a as usize]
            .total_cmp(&levels_m[*b as usize])
            .then(a.cmp(b))
    });
    while let Some(from) = ring.pop_front() {
        let at = Cell::new(from as i32 % cols, from as i32 / cols);
        for cell in CellArea::of(at).grown(1).cells() {
            if !(0..cols).contains(&cell.col) || !(0..rows).contains(&cell.row) {
                continue;
            }
            let to = (cell.row * cols + cell.col) as usize;
            if levels_m[to].is_nan() {
                levels_m[to] = levels_m[from as usize];
                ring.push_back(to as u32);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_not_seen_is_as_high_as_what_is_nearest_and_low_where_that_is_as_near() {
        let unseen = f32::NAN;
        let mut levels_m = [0.0, unseen, unseen, unseen, 0.5, f32::INFINITY, unseen];
        guess_levels(&mut levels_m, 7);
        assert_eq!(levels_m[..5], [0.0, 0.0, 0.0, 0.5, 0.5]);
        // Where the body has no room nothing is guessed from.
        assert!(levels_m[6].is_nan());
        let mut nothing = [unseen; 4];
        guess_levels(&mut nothing, 2);
        assert!(nothing.iter().all(|level_m| level_m.is_nan()));
        guess_levels(&mut [], 0);
    }
}
