//! How much the ground of a cell rises: where it does so evenly, and not by a step.

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

/// Rise per metre of the cells around one along the map's axes; `height` is that of the cell so many columns and rows away, m. Along each
/// axis the most even of the cells before, around and behind count, so that a slope has its gradient up to its end. Nothing where too
/// few are known, or where the ground rises by steps.
pub(crate) fn gradient(
    height: impl Fn([i32; 2]) -> Option<f32>,
    cell_m: f32,
    rule: SlopeRule,
) -> [f32; 2] {
    let reach = rule.reach.clamp(1, MOST_REACH as i32);
    let Some(base_m) = height([0, 0]) else {
        return [0.0; 2];
    };
    let along = |axis: usize| {
        // Heights above the cell's own by line across the axis, each the mean of the line.
        let mut lines = [(0.0_f32, 0_u32); 4 * MOST_REACH + 1];
        for far in -2 * reach..=2 * reach {
            let (sum, known) = &mut lines[(far + 2 * reach) as usize];
            for beside in -reach..=reach {
                let at = if axis == 0 {
                    [far, beside]
                } else {
                    [beside, far]
                };
                if let Some(found) = height(at) {
                    *sum += found - base_m;
                    *known += 1;
                }
            }
        }
        let count = (2 * reach + 1) as usize;
        let windows = [1, 0, 2].map(|shift| shift * reach as usize);
        let even = windows
            .iter()
            .filter_map(|&begin| even_rise(&lines[begin..begin + count], rule));
        even.min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(rise, _)| rise / cell_m)
    };
    match [along(0), along(1)] {
        [Some(x), Some(y)] => [x, y],
        _ => [0.0; 2],
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
    use proptest::prelude::*;

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
