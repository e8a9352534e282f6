//! Fitting a frame to the floor that is known: 000, section IV.

use super::MatchingTuning;

/// A point of a frame and the known surface at its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// How far the surface lies above the point, m; NaN where there is nothing to compare.
    pub residual_m: f64,
    /// What it counts.
    pub weight: u64,
}

/// The shift in height, m, that brings the frame's points onto the known surface: the least sum of squared distances
/// among the pairs that agree. `None` with fewer than `min_pairs` of them.
///
/// Points and floors further apart than `gate_m` are different surfaces. Where several shifts fit, the one that pairs of the
/// most weight agree on wins. `found` is room for the pairs, reused from frame to frame.
pub fn height_shift(
    all: impl Iterator<Item = Pair>,
    (gate_m, min_pairs): (f64, usize),
    tuning: &MatchingTuning,
    found: &mut Vec<Pair>,
) -> Option<f64> {
    found.clear();
    found.extend(all.filter(|pair| pair.residual_m.abs() <= gate_m));
    let pairs = || found.iter().copied();
    if gate_m == 0.0 {
        return (pairs().count() >= min_pairs).then_some(0.0);
    }
    // Over twice the gate.
    let &MatchingTuning { bins, window, .. } = tuning;
    let mut histogram = [0_u64; MatchingTuning::MOST_BINS];
    for Pair { residual_m, weight } in pairs() {
        let bin = ((residual_m / gate_m + 1.0) * 0.5 * bins as f64) as usize;
        histogram[bin.min(bins - 1)] += weight;
    }
    let in_window = |first: usize| histogram[first..first + window].iter().sum::<u64>();
    // The middle one of equals, so that a perfect fit is not pulled to one side.
    let best = (0..=bins - window).map(in_window).max()?;
    let firsts = || (0..=bins - window).filter(|&first| in_window(first) == best);
    let first = firsts().nth(firsts().count() / 2)?;
    let center = gate_m * ((2 * first + window) as f64 / bins as f64 - 1.0);
    let (sum, count) = pairs()
        .filter(|pair| (pair.residual_m - center).abs() <= gate_m * tuning.agreement)
        .fold((0.0, 0_usize), |(sum, count), pair| {
            (sum + pair.residual_m, count + 1)
        });
    (count >= min_pairs.max(1)).then(|| sum / count as f64)
}
