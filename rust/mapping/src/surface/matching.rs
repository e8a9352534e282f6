//! Fitting a frame to the floor that is known: 000, section IV.

use super::{LabelledFrame, LabelledPoint};

/// Bins of the search, over twice the gate.
const BINS: usize = 40;

/// A point of a frame and the known surface at its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// How far the surface lies above the point, m; NaN where there is nothing to compare.
    pub residual_m: f64,
    /// What it counts.
    pub weight: u64,
}

/// The shift in height, m, that brings the frame's points onto the known surface: the least sum of squared distances
/// among the pairs that agree. `None` with fewer than `min_pairs` of them. `pair` finds the surface at a point; none where
/// nothing is known.
///
/// Points and floors further apart than `gate_m` are different surfaces. Where several shifts fit, the one that pairs of the
/// most weight agree on wins; pairs agree within a quarter of the gate.
pub fn height_shift(
    frame: &LabelledFrame,
    pair: impl Fn(&LabelledPoint) -> Option<Pair>,
    gate_m: f64,
    min_pairs: usize,
) -> Option<f64> {
    let all = frame.points.iter().filter_map(pair);
    let found: Vec<Pair> = all.filter(|pair| pair.residual_m.abs() <= gate_m).collect();
    let pairs = || found.iter().copied();
    if gate_m == 0.0 {
        return (pairs().count() >= min_pairs).then_some(0.0);
    }
    let mut histogram = [0_u64; BINS];
    for Pair { residual_m, weight } in pairs() {
        let bin = ((residual_m / gate_m + 1.0) * 0.5 * BINS as f64) as usize;
        histogram[bin.min(BINS - 1)] += weight;
    }
    let width = BINS / 8;
    let in_window = |first: usize| histogram[first..first + width].iter().sum::<u64>();
    // The middle one of equals, so that a perfect fit is not pulled to one side.
    let best = (0..=BINS - width).map(in_window).max()?;
    let firsts = || (0..=BINS - width).filter(|&first| in_window(first) == best);
    let first = firsts().nth(firsts().count() / 2)?;
    let center = gate_m * ((2 * first + width) as f64 / BINS as f64 - 1.0);
    let (sum, count) = pairs()
        .filter(|pair| (pair.residual_m - center).abs() <= gate_m / 4.0)
        .fold((0.0, 0_usize), |(sum, count), pair| {
            (sum + pair.residual_m, count + 1)
        });
    (count >= min_pairs.max(1)).then(|| sum / count as f64)
}
