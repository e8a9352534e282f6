//! Which voxels some bins of slopes show, and which bins a voxel covers: surely, or perhaps.

use std::ops::Range;

use super::columns::run;
use super::fan::Grain;
use super::locator::NO_FRACTION;

/// Part of a bin that is more than what 32 bits may lose: a rounding guard.
const MARGIN: f64 = 1e-3;
/// Part of a voxel that is far more than the rounding of a ray: a rounding guard, behind which every ray is followed exactly.
pub(super) const NEAR: f64 = 1e-4;
/// What is nearer is taken to be so far: by then no ray that is not steep has left [`NEAR`].
const TOUCHED: f64 = 1e-5;
/// Part of a bin or voxel that is far less than the other guards: a rounding guard.
const SHORT: f64 = 1e-6;

/// The whole number below, from 0 to `most`; of what is not [`SHORT`] of the next one it may be that one. A cast to an integer takes
/// several times as long.
#[inline]
fn whole(at: f64, most: f64) -> usize {
    let at = if at > 0.0 { at } else { 0.0 };
    let at = if at < most { at } else { most };
    (at - (0.5 - SHORT) + NO_FRACTION).to_bits() as u32 as usize
}

/// The voxels that hold what lies between two distances from the eye, and what almost does.
#[inline]
pub(super) fn units(eye: f64, [low, high]: [f64; 2], count: i32) -> Range<usize> {
    let last = f64::from(count);
    whole(eye + low - NEAR, last)..whole(eye + high + NEAR + 1.0, last)
}

/// One bit for each of some layers.
#[inline]
pub(super) fn one_each(layers: Range<usize>) -> u64 {
    if layers.is_empty() {
        0
    } else {
        run(layers.start as i64, layers.end as i64 - 1)
    }
}

/// How far some bins are from the eye's axis between two depths.
#[inline]
pub(super) fn spread(grain: &Grain, way: usize, bins: [usize; 2], depths: [f64; 2]) -> [f64; 2] {
    let slope = |bin: usize| grain.lowest[way] + bin as f64 / grain.per_slope;
    let [low, high] = [slope(bins[0]), slope(bins[1])];
    let [near, far] = depths;
    [(low * near).min(low * far), (high * near).max(high * far)]
}

/// The bins that lie as a whole between `low` and `low + 1` voxels beside the eye's axis.
#[inline]
pub(super) fn within(grain: &Grain, way: usize, low: f64, depth: f64) -> Range<usize> {
    let per_voxel = grain.per_slope / depth;
    let start = low * per_voxel - grain.lowest[way] * grain.per_slope;
    let end = start + per_voxel;
    let last = grain.size[way] as f64;
    whole(start + MARGIN + 1.0, last)..whole(end - MARGIN, last)
}

/// The bins of which a part lies, or almost does, between `low` and `low + 1` voxels beside the eye's axis, between two depths.
#[inline]
pub(super) fn around(grain: &Grain, way: usize, low: f64, [near, far]: [f64; 2]) -> Range<usize> {
    let per_voxel = |depth: f64| grain.per_slope / depth.max(TOUCHED);
    let (near, far) = (per_voxel(near), per_voxel(far));
    let (low, high) = (low - NEAR, low + 1.0 + NEAR);
    let origin = grain.lowest[way] * grain.per_slope;
    let start = (low * near).min(low * far) - origin - MARGIN;
    let end = (high * near).max(high * far) - origin + MARGIN;
    let last = grain.size[way] as f64;
    let end = whole(end + 1.0, last);
    whole(start, last).min(end)..end
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_whole_number_is_that_below_or_one_that_is_hardly_missed(at in -9.0..99.0_f64, near in -1e-5..1e-5_f64) {
            for at in [at, at.round(), at.round() + near] {
                let (found, within) = (whole(at, 64.0) as f64, at.clamp(0.0, 64.0));
                prop_assert!(found <= within + SHORT && found > within - 1.0);
            }
        }
    }
}
