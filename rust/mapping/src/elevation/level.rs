//! Cells whose surroundings are as high as they are: of most cells this tells at once that they are floor.

use std::ops::Range;

use super::edges::{EdgeRule, WAYS};

/// Cells on either side that are looked at.
const REACH: usize = 2;

/// Tells the cells beside which nothing lies higher or lower than what can be climbed, and through which no edge can run. Reused from row to
/// row.
#[derive(Debug, Clone, Default)]
pub(crate) struct LevelCells {
    level: Vec<bool>,
}

impl LevelCells {
    /// Whether each cell of a run within a row is level; `heights_m`: those of all cells, row by row, NaN where none is known. What is near
    /// the border of the grid, and unknown itself, counts as not level. By an `edge` [`super::edges::upper_surface`] finds none in a level cell, and no
    /// cell beside it lies more than `rise_m` lower.
    pub(crate) fn of_run(
        &mut self,
        heights_m: &[f32],
        [cols, rows]: [usize; 2],
        run: Range<usize>,
        (edge, rise_m): (Option<EdgeRule>, f32),
    ) -> &[bool] {
        self.level.clear();
        self.level.resize(run.len(), false);
        let row = run.start / cols;
        let first = (run.start % cols).max(REACH) + row * cols;
        let last = run.end.min((row + 1) * cols - REACH);
        if row < REACH || row + REACH >= rows || first >= last {
            return &self.level;
        }
        let level = &mut self.level[first - run.start..last - run.start];
        let line = |down: isize, across: isize| {
            let begin = first as isize + down * cols as isize + across;
            &heights_m[begin as usize..][..last - first]
        };
        let own = line(0, 0);
        for (level, own_m) in level.iter_mut().zip(own) {
            *level = !own_m.is_nan();
        }
        for (down, across) in (-1..=1).flat_map(|down| (-1..=1).map(move |across| (down, across))) {
            for ((level, own_m), other_m) in level.iter_mut().zip(own).zip(line(down, across)) {
                let lower = own_m - other_m > rise_m;
                *level &= !lower;
            }
        }
        let Some(edge) = edge else {
            return &self.level;
        };
        let (least_m, steps) = (edge.least_seen_m(), REACH as isize);
        for [across, down] in WAYS.map(|way| way.map(|steps| steps as isize)) {
            let before_m = line(-steps * down, -steps * across);
            let behind_m = line(steps * down, steps * across);
            for (level, (before_m, behind_m)) in level.iter_mut().zip(before_m.iter().zip(behind_m))
            {
                let apart = (before_m - behind_m).abs() >= least_m;
                *level &= !apart;
            }
        }
        &self.level
    }
}

#[cfg(test)]
mod tests {
    use super::super::edges::upper_surface;
    use super::*;
    use proptest::prelude::*;

    const SIZE: [usize; 2] = [9, 8];
    const EDGE: EdgeRule = EdgeRule {
        least_m: 0.01,
        uneven: 0.15,
        reach: 3,
    };
    const RISE_M: f32 = 0.05;

    proptest! {
        #[test]
        fn a_level_cell_has_no_edge_and_nothing_beside_it_is_lower(
            heights in prop::collection::vec(
                prop_oneof![8 => -0.004..0.004f32, 2 => -0.1..0.1f32, 1 => Just(f32::NAN)], 72),
            begin in 0..9usize, length in 0..9usize, row in 0..8usize,
        ) {
            let run = row * SIZE[0] + begin..row * SIZE[0] + (begin + length).min(SIZE[0]);
            let mut cells = LevelCells::default();
            let level = cells.of_run(&heights, SIZE, run.clone(), (Some(EDGE), RISE_M));
            prop_assert_eq!(level.len(), run.len());
            for (index, &level) in run.zip(level) {
                let (col, row) = ((index % SIZE[0]) as i32, (index / SIZE[0]) as i32);
                let at = |[cols, rows]: [i32; 2]| {
                    let inside = (0..9).contains(&(col + cols)) && (0..8).contains(&(row + rows));
                    let height_m = inside.then(|| heights[((row + rows) * 9 + col + cols) as usize]);
                    height_m.filter(|height_m| !height_m.is_nan())
                };
                let own_m = at([0, 0]);
                if level {
                    let own_m = own_m.unwrap();
                    prop_assert_eq!(upper_surface(own_m, at, EDGE), None);
                    for beside in [[1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [-1, -1]] {
                        prop_assert!(at(beside).is_none_or(|other_m| own_m - other_m <= RISE_M));
                    }
                } else if let Some(own_m) = own_m && (2..7).contains(&col) && (2..6).contains(&row) {
                    // What is not told to be level has something beside it that is not.
                    let uneven = (-2..=2).any(|rows| (-2..=2).any(|cols| {
                        at([cols, rows]).is_some_and(|other_m| (own_m - other_m).abs() > 0.003)
                    }));
                    prop_assert!(uneven);
                }
            }
        }
    }
}
