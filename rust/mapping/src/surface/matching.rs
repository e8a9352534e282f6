//! Fitting a frame to the floor that is known: 000, section IV.

use super::{LabelledFrame, LabelledPoint};

/// Bins of the search, over twice the gate.
const BINS: usize = 40;

/// The shift in height, m, that brings the frame's points onto the known surface: the least sum of squared distances
/// among the pairs that agree. `None` with fewer than `min_pairs` of them. `residual_m` is how far that surface lies above a
/// point; none or NaN where there is nothing to compare.
///
/// Points and floors further apart than `gate_m` are different surfaces. Where several shifts fit, the one that most
/// pairs agree on wins; pairs agree within a quarter of the gate.
pub fn height_shift(
    frame: &LabelledFrame,
    residual_m: impl Fn(&LabelledPoint) -> Option<f64>,
    gate_m: f64,
    min_pairs: usize,
) -> Option<f64> {
    let residuals = || {
        let all = frame.points.iter().filter_map(&residual_m);
        all.filter(|residual| residual.abs() <= gate_m)
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
