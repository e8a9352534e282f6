//! Fitting a frame to the floor that is known: 000, section IV.

use super::{FloorGrid, LabelledFrame};

/// Bins of the search, over twice the gate.
const BINS: usize = 40;

/// The shift in height, m, that brings the frame's floor points onto the known floor: the least sum of squared
/// distances among the pairs that agree. `None` with fewer than `min_pairs` of them.
///
/// Points and floors further apart than `gate_m` are different surfaces. Where several shifts fit, the one that most
/// pairs agree on wins; pairs agree within a quarter of the gate.
pub fn height_shift(
    frame: &LabelledFrame,
    floor: &FloorGrid,
    gate_m: f64,
    min_pairs: usize,
) -> Option<f64> {
    let residuals = || {
        frame.points.iter().filter_map(|point| {
            let [x, y, _] = point.position_m;
            let residual = floor.height_at(x, y)? - point.floor_height_m;
            (residual.abs() <= gate_m).then_some(residual)
        })
    };
    if gate_m == 0.0 {
        return (residuals().count() >= min_pairs).then_some(0.0);
    }
    let mut histogram = [0_usize; BINS];
    for residual in residuals() {
        let bin = ((residual / gate_m + 1.0) * 0.5 * BINS as f64) as usize;
        histogram[bin.min(BINS - 1)] += 1;
    }
    let width = BINS / 8;
    let in_window = |first: usize| histogram[first..first + width].iter().sum::<usize>();
    // The middle one of equals, so that a perfect fit is not pulled to one side.
    let best = (0..=BINS - width).map(in_window).max()?;
    let firsts = || (0..=BINS - width).filter(|&first| in_window(first) == best);
    let first = firsts().nth(firsts().count() / 2)?;
    let center = gate_m * ((2 * first + width) as f64 / BINS as f64 - 1.0);
    let (sum, pairs) = residuals()
        .filter(|residual| (residual - center).abs() <= gate_m / 4.0)
        .fold((0.0, 0_usize), |(sum, pairs), residual| {
            (sum + residual, pairs + 1)
        });
    (pairs >= min_pairs.max(1)).then(|| sum / pairs as f64)
}
