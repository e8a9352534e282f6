//! The pixels of a matching window, worked on several at once.

/// Pixels of a side of a matching window: what the cameras of both robots match with. The arrays below are made for it.
pub(super) const SIDE: usize = 5;
/// Pixels from a window's middle to its border.
pub(super) const REACH: f64 = 2.0;
/// Pixels in a window.
pub(super) const PIXELS: usize = SIDE * SIDE;

/// Pixels that are worked on at once: as many as a vector of the processor holds. It tells in which order they are summed.
const LANES: usize = 8;
/// A window's pixels in whole lanes: the last one is repeated, and counts once.
pub(super) const PADDED: usize = 32;
/// A value for each pixel of a window.
pub(super) type Lot = [f32; PADDED];

/// Largest disparity, and how far below it the smallest is, px.
pub(super) fn most_and_spread(values: &Lot) -> (f32, f32) {
    let most = extreme(values, |a, b| if a > b { a } else { b });
    let least = extreme(values, |a, b| if a < b { a } else { b });
    (most, most - least)
}

/// The value that is picked of all: halves against each other.
#[inline]
fn extreme(values: &Lot, pick: impl Fn(f32, f32) -> f32) -> f32 {
    let mut left = *values;
    let mut half = PADDED / 2;
    while half > 0 {
        for i in 0..half {
            left[i] = pick(left[i], left[i + half]);
        }
        half /= 2;
    }
    left[0]
}

/// Sum over the chosen pixels of a window (1, others 0).
#[inline]
pub(super) fn sum_of(chosen: &Lot, value: impl Fn(usize) -> f32) -> f32 {
    let mut lanes = [0.0_f32; LANES];
    for first in (0..PADDED).step_by(LANES) {
        for lane in 0..LANES {
            lanes[lane] += chosen[first + lane] * value(first + lane);
        }
    }
    lanes.iter().sum()
}

/// 1 for the pixels of a window whose disparity is wanted, else 0.
#[inline]
pub(super) fn counted(wanted: impl Fn(f32) -> bool, values: &Lot) -> Lot {
    let mut chosen = [0.0; PADDED];
    for (chosen, &value) in chosen.iter_mut().zip(values) {
        *chosen = if wanted(value) { 1.0 } else { 0.0 };
    }
    chosen[PIXELS..].fill(0.0);
    chosen
}
