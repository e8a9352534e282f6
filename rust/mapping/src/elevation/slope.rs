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
    /// Ground that rises by less per metre is level.
    pub least: f32,
}

/// Most cells to each side.
pub(crate) const MOST_REACH: usize = 8;

/// Finds gradients. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(crate) struct SlopeFinder {
    /// Heights of an area and of what is around it, m, row by row; 0 where none is known.
    heights_m: Vec<f32>,
    /// 1 where a height is known, 0 elsewhere.
    known: Vec<f32>,
    /// Mean height of each cell and those beside it, m: of its column, for the way along a row, and of its row, for the way along a column. NaN
    /// where too few are known.
    beside_m: [Vec<f32>; 2],
    /// Of the cells of a row how many heights a mean is of.
    counts: Vec<f32>,
    /// Of the cells of a row, whether the ground may rise there.
    may_rise: Vec<bool>,
}

impl SlopeFinder {
    /// Tells `take` of each cell of an area, by where it is stored, how much the ground rises per metre along the map's axes; `height` is that
    /// of a cell, m. Along each axis the most even of the cells before, around and behind count, so that a slope has its gradient up
    /// to its end. Nothing where too few are known, where the ground rises by steps, and where it is level.
    pub(crate) fn find(
        &mut self,
        (size, area): ([usize; 2], CellArea),
        height: impl Fn(usize) -> Option<f32>,
        (cell_m, rule): (f32, SlopeRule),
        mut take: impl FnMut(usize, [f32; 2]),
    ) {
        let reach = rule.reach.clamp(1, MOST_REACH as i32) as usize;
        let mut runs_down = runs(area, size).peekable();
        let Some(first) = runs_down.peek().cloned().filter(|run| !run.is_empty()) else {
            return;
        };
        let rows = runs(area, size).count();
        let corner = [first.start % size[0], first.start / size[0]];
        let (cols, wide) = (first.len(), first.len() + 4 * reach);
        self.read((size, corner), [wide, rows + 4 * reach], height, 2 * reach);
        self.sum_up([cols, rows], reach);
        // Ground that is level along both axes by this much is level.
        let least_m = std::f32::consts::FRAC_1_SQRT_2 * rule.least * cell_m * (2 * reach) as f32;
        for (row, run) in runs_down.enumerate() {
            self.look_for_rises(row, cols, (reach, least_m));
            for (col, index) in run.enumerate() {
                let known = self.known[(row + 2 * reach) * wide + col + 2 * reach] > 0.0;
                let gradient = if known && self.may_rise[col] {
                    let along = self.beside_m[0][row * wide + col..].iter();
                    let across = self.beside_m[1][row * cols + col..].iter().step_by(cols);
                    [
                        steady_rise(along, reach, rule),
                        steady_rise(across, reach, rule),
                    ]
                } else {
                    [None; 2]
                };
                let gradient = match gradient {
                    [Some(x), Some(y)] => [x / cell_m, y / cell_m],
                    _ => [0.0; 2],
                };
                take(index, gradient);
            }
        }
    }

    /// Reads the heights of `wide` columns and rows of cells, the first of them so many before the corner of the area.
    fn read(
        &mut self,
        (size, corner): ([usize; 2], [usize; 2]),
        wide: [usize; 2],
        height: impl Fn(usize) -> Option<f32>,
        before: usize,
    ) {
        for buffer in [&mut self.heights_m, &mut self.known] {
            buffer.clear();
            buffer.resize(wide[0] * wide[1], 0.0);
        }
        let inside = [0, 1].map(|axis| {
            let skipped = before.saturating_sub(corner[axis]);
            skipped..wide[axis].min(size[axis] + before - corner[axis])
        });
        for row in inside[1].clone() {
            for col in inside[0].clone() {
                let [own_col, own_row] = [col + corner[0] - before, row + corner[1] - before];
                if let Some(height_m) = height(own_row * size[0] + own_col) {
                    let at = row * wide[0] + col;
                    (self.heights_m[at], self.known[at]) = (height_m, 1.0);
                }
            }
        }
    }

    /// Takes the means of the heights beside each cell.
    fn sum_up(&mut self, [cols, rows]: [usize; 2], reach: usize) {
        let (wide, high) = (cols + 4 * reach, rows + 4 * reach);
        let [along, across] = &mut self.beside_m;
        let sizes = [(wide, rows, wide), (cols, high, 1)];
        for (means_m, (length, lines, step)) in [along, across].into_iter().zip(sizes) {
            means_m.clear();
            means_m.resize(length * lines, 0.0);
            for (line, means_m) in means_m.chunks_exact_mut(length).enumerate() {
                self.counts.clear();
                self.counts.resize(length, 0.0);
                for beside in reach..=3 * reach {
                    let begin = line * wide + beside * step;
                    let heights_m = &self.heights_m[begin..][..length];
                    for (sum, height_m) in means_m.iter_mut().zip(heights_m) {
                        *sum += height_m;
                    }
                    let known = &self.known[begin..][..length];
                    for (count, known) in self.counts.iter_mut().zip(known) {
                        *count += known;
                    }
                }
                // More than half of them tell where the line lies.
                let enough = reach as f32;
                for (mean_m, &count) in means_m.iter_mut().zip(&self.counts) {
                    *mean_m = if count > enough {
                        *mean_m / count
                    } else {
                        f32::NAN
                    };
                }
            }
        }
    }

    /// Tells of each cell of a row whether the ground rises by `least_m` along an axis before, around or behind it.
    fn look_for_rises(&mut self, row: usize, cols: usize, (reach, least_m): (usize, f32)) {
        let wide = cols + 4 * reach;
        let [along, across] = &self.beside_m;
        self.may_rise.clear();
        self.may_rise.resize(cols, false);
        for begin in [0, reach, 2 * reach] {
            let end = begin + 2 * reach;
            let ends = [
                (row * wide + begin, row * wide + end, along),
                ((row + begin) * cols, (row + end) * cols, across),
            ];
            for (first, last, means_m) in ends {
                let both = means_m[first..][..cols]
                    .iter()
                    .zip(&means_m[last..][..cols]);
                for (may_rise, (first_m, last_m)) in self.may_rise.iter_mut().zip(both) {
                    *may_rise |= (last_m - first_m).abs() >= least_m;
                }
            }
        }
    }
}

/// The rise from one line of cells to the next, m, of the most even ones of the lines before, around and behind a cell; `means_m` begins with
/// the first of them.
fn steady_rise<'a>(
    means_m: impl Iterator<Item = &'a f32>,
    reach: usize,
    rule: SlopeRule,
) -> Option<f32> {
    let mut lines = [0.0; 4 * MOST_REACH + 1];
    for (line, mean_m) in lines[..=4 * reach].iter_mut().zip(means_m) {
        *line = *mean_m;
    }
    let windows = [reach, 0, 2 * reach];
    let even = windows
        .iter()
        .filter_map(|&begin| even_rise(&lines[begin..=begin + 2 * reach], rule));
    even.min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(rise, _)| rise)
}

/// The mean difference from one line of cells to the next, m, where all are near to it, and how far the furthest is from it, m.
fn even_rise(means_m: &[f32], rule: SlopeRule) -> Option<(f32, f32)> {
    let rise = (means_m.last()? - means_m.first()?) / (means_m.len() - 1) as f32;
    let most = rule.uneven * rise.abs() + rule.noise_m;
    let mut uneven = 0.0_f32;
    for two in means_m.windows(2) {
        let off = (two[1] - two[0] - rise).abs();
        // What is no number is not near.
        let near = off <= most;
        if !near {
            return None;
        }
        uneven = uneven.max(off);
    }
    Some((rise, uneven))
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
        least: 0.0,
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
