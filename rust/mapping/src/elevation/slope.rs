//! How much the ground of a cell rises: where it does so evenly, and not by a step.

use geometry::{CellArea, runs};

/// When ground counts as a slope.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SlopeRule {
    /// Cells to each side that are looked at.
    pub reach: i32,
    /// Of the mean difference from cell to cell, the share by which each may differ from it.
    pub uneven: f32,
    /// What each may differ by in any case, m.
    pub noise_m: f32,
}

/// Most cells to each side.
pub(crate) const MOST_REACH: usize = 8;

/// Finds gradients. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(crate) struct SlopeFinder {
    heights_m: Vec<f32>,
    /// For each cell sum and number of the heights beside it: those of its column, and those of its row.
    beside: [Vec<(f32, u32)>; 2],
}

impl SlopeFinder {
    /// Tells `take` of each cell of an area, by where it is stored, how much the ground rises per metre along the map's axes; `height` is that
    /// of a cell, m. Along each axis the most even of the cells before, around and behind count, so that a slope has its gradient up
    /// to its end. Nothing where too few are known, or where the ground rises by steps.
    pub(crate) fn find(
        &mut self,
        (size, area): ([usize; 2], CellArea),
        height: impl Fn(usize) -> Option<f32>,
        (cell_m, rule): (f32, SlopeRule),
        mut take: impl FnMut(usize, [f32; 2]),
    ) {
        let reach = rule.reach.clamp(1, MOST_REACH as i32);
        self.heights_m.clear();
        self.heights_m.resize(size[0] * size[1], f32::NAN);
        for index in runs(area.grown(2 * reach), size).flatten() {
            self.heights_m[index] = height(index).unwrap_or(f32::NAN);
        }
        self.sum_up(size, area.grown(2 * reach), reach as usize);
        for index in runs(area, size).flatten() {
            let rises = if self.heights_m[index].is_nan() {
                [None; 2]
            } else {
                [0, 1].map(|axis| self.rise(size, (index, axis), reach as usize, rule))
            };
            let gradient = match rises {
                [Some(x), Some(y)] => [x / cell_m, y / cell_m],
                _ => [0.0; 2],
            };
            take(index, gradient);
        }
    }

    /// Sums up the heights beside each cell of an area.
    fn sum_up(&mut self, size: [usize; 2], area: CellArea, reach: usize) {
        let [cols, rows] = size;
        for (axis, beside) in self.beside.iter_mut().enumerate() {
            beside.clear();
            beside.resize(cols * rows, (0.0, 0));
            for index in runs(area, size).flatten() {
                let (at, count, step) = if axis == 0 {
                    (index / cols, rows, cols)
                } else {
                    (index % cols, cols, 1)
                };
                let (low, high) = (at.saturating_sub(reach), (at + reach).min(count - 1));
                let first = index - (at - low) * step;
                let (mut sum, mut known) = (0.0, 0);
                for other in 0..=high - low {
                    let height_m = self.heights_m[first + other * step];
                    if !height_m.is_nan() {
                        sum += height_m;
                        known += 1;
                    }
                }
                beside[index] = (sum, known);
            }
        }
    }

    /// The rise of a cell along an axis from one cell to the next, m.
    fn rise(
        &self,
        [cols, rows]: [usize; 2],
        (index, axis): (usize, usize),
        reach: usize,
        rule: SlopeRule,
    ) -> Option<f32> {
        let (at, count, step) = if axis == 0 {
            (index % cols, cols, 1)
        } else {
            (index / cols, rows, cols)
        };
        let mut lines = [(0.0_f32, 0_u32); 4 * MOST_REACH + 1];
        for (far, line) in lines[..=4 * reach].iter_mut().enumerate() {
            let there = (at + far)
                .checked_sub(2 * reach)
                .filter(|there| *there < count);
            if let Some(there) = there {
                *line = self.beside[axis][index + there * step - at * step];
            }
        }
        let windows = [reach, 0, 2 * reach];
        let even = windows
            .iter()
            .filter_map(|&begin| even_rise(&lines[begin..=begin + 2 * reach], rule));
        even.min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(rise, _)| rise)
    }
}

/// The mean difference from one line of cells to the next, m, where all are near to it, and how far the furthest is from it, m; `lines`:
/// sums and counts.
fn even_rise(lines: &[(f32, u32)], rule: SlopeRule) -> Option<(f32, f32)> {
    // Half of the cells of a line tell where it lies.
    let enough = lines.len() as u32 / 2;
    if lines.iter().any(|&(_, known)| known <= enough) {
        return None;
    }
    let mean = |(sum, known): (f32, u32)| sum / known as f32;
    let (first, last) = (mean(*lines.first()?), mean(*lines.last()?));
    let rise = (last - first) / (lines.len() - 1) as f32;
    let steps = lines
        .windows(2)
        .map(|two| (mean(two[1]) - mean(two[0]) - rise).abs());
    let uneven = steps.fold(0.0, f32::max);
    (uneven <= rule.uneven * rise.abs() + rule.noise_m).then_some((rise, uneven))
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::Cell;
    use proptest::prelude::*;

    /// The gradient of the middle of 13 x 13 cells.
    fn gradient(
        height: impl Fn([i32; 2]) -> Option<f32>,
        cell_m: f32,
        rule: SlopeRule,
    ) -> [f32; 2] {
        let middle = CellArea::of(Cell::new(6, 6));
        let height = |index: usize| height([index as i32 % 13 - 6, index as i32 / 13 - 6]);
        let mut found = [f32::NAN; 2];
        SlopeFinder::default().find(([13; 2], middle), height, (cell_m, rule), |_, gradient| {
            found = gradient;
        });
        found
    }

    const RULE: SlopeRule = SlopeRule {
        reach: 3,
        uneven: 0.6,
        noise_m: 0.001,
    };

    proptest! {
        #[test]
        fn a_slope_has_its_gradient_however_it_lies(
            rise in prop::array::uniform2(-0.2..0.2f32), holes in prop::collection::vec(prop::bool::weighted(0.1), 169),
        ) {
            let height = |[col, row]: [i32; 2]| {
                let hole = holes[((row + 6) * 13 + col + 6) as usize] && [col, row] != [0, 0];
                (!hole).then(|| 0.04 * (rise[0] * col as f32 + rise[1] * row as f32))
            };
            let whole = |at: [i32; 2]| Some(0.04 * (rise[0] * at[0] as f32 + rise[1] * at[1] as f32));
            let found = gradient(whole, 0.04, RULE);
            for axis in 0..2 {
                prop_assert!((found[axis] - rise[axis]).abs() < 1e-4);
            }
            // With holes it has that, or none.
            let found = gradient(height, 0.04, RULE);
            prop_assert!(found == [0.0; 2] || (0..2).all(|axis| (found[axis] - rise[axis]).abs() < 0.12));
        }

        #[test]
        fn stairs_are_no_slope(rise in 0.012..0.06f32, tread in 2..5i32, begin in 0..5i32) {
            let stairs = |[col, _]: [i32; 2]| Some(rise * (col + begin).div_euclid(tread) as f32);
            prop_assert_eq!(gradient(stairs, 0.04, RULE), [0.0; 2]);
        }

        #[test]
        fn a_step_between_level_surfaces_is_no_slope(rise in 0.012..0.06f32, begin in -3..4i32) {
            let step = |[col, _]: [i32; 2]| Some(if col > begin { rise } else { 0.0 });
            let found = gradient(step, 0.04, RULE);
            prop_assert!(found[0].abs() < 1e-6 && found[1].abs() < 1e-6, "{:?}", found);
        }

        #[test]
        fn a_slope_has_its_gradient_up_to_its_end(rise in 0.04..0.2f32, end in 1..7i32) {
            let ramp = |[col, _]: [i32; 2]| Some(0.04 * rise * col.min(end) as f32);
            let found = gradient(ramp, 0.04, RULE);
            prop_assert!((found[0] - rise).abs() < 1e-4, "{:?}", found);
            let level = |[col, _]: [i32; 2]| Some(0.04 * rise * (col + end).min(0) as f32);
            let found = gradient(level, 0.04, RULE);
            prop_assert!(found[0].abs() < 1e-4, "{:?}", found);
        }
    }
}
