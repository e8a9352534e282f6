//! Rays side by side: where all voxels that any of them may pass are marked already, none of them has to be walked.

use super::columns::{BITS, Slabs, run};
use super::occupancy::Size;

/// Rays of a strip. More share more, but are further apart.
pub(super) const RAYS: usize = 16;
/// More voxels across than this are not looked at.
const WIDEST: i64 = 8;
/// A ray that goes less far than this along u, in voxels, may rise without bound from border to border.
const SHORTEST: f64 = 1.0;
/// Far more than the rounding of a ray's fixed-point coordinates, far less than a voxel.
const MARGIN: i64 = 1 << (BITS - 30);

/// Smallest and largest fixed-point coordinate of a strip's rays.
#[derive(Debug, Clone, Copy)]
struct Span {
    low: i64,
    high: i64,
}

impl Span {
    /// Around it and another one, by [`MARGIN`] more, the units that both touch; between 0 and `highest`.
    #[inline]
    fn units_to(self, other: Self, highest: i64) -> (i64, i64) {
        let low = (self.low.min(other.low) - MARGIN) >> BITS;
        let high = (self.high.max(other.high) + MARGIN) >> BITS;
        (low.clamp(0, highest), high.clamp(0, highest))
    }

    fn include(&mut self, value: i64) {
        self.low = self.low.min(value);
        self.high = self.high.max(value);
    }

    fn step(&mut self, by: Self) {
        self.low += by.low;
        self.high += by.high;
    }
}

/// Where the rays of a strip are, from border to border: they start at one place and go the same way, seen from above.
struct Bundle {
    /// v and height, at the start, at the first border, and from border to border.
    start: [i64; 2],
    at_border: [Span; 2],
    step: [Span; 2],
    /// Slabs after the first of the longest.
    count: i32,
}

impl Bundle {
    #[inline]
    fn of(rays: &[Slabs]) -> Option<Self> {
        let (first, others) = rays.split_first()?;
        let span = |[v, z]: [i64; 2]| [v, z].map(|at| Span { low: at, high: at });
        let mut bundle = Self {
            start: first.start,
            at_border: span(first.at_border),
            step: span(first.step),
            count: first.count,
        };
        let mut alike = !others.is_empty() && first.length >= SHORTEST;
        for ray in others {
            alike &= ray.goes_like(first)
                && ray.start == first.start
                && ray.index(0, 0) == first.index(0, 0)
                && ray.length >= SHORTEST;
            for axis in 0..2 {
                bundle.at_border[axis].include(ray.at_border[axis]);
                bundle.step[axis].include(ray.step[axis]);
            }
            bundle.count = bundle.count.max(ray.count);
        }
        alike.then_some(bundle)
    }
}

/// The slabs that the rays of a strip have to be walked in. Reused from strip to strip.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Gaps {
    /// First slab, and the one behind the last.
    spans: Vec<[i32; 2]>,
}

impl Gaps {
    /// Finds the gaps of a strip: slabs in which one of the rays may pass a voxel that `known`, by cell, does not hold.
    pub(super) fn find(&mut self, rays: &[Slabs], known: impl Fn(usize) -> u64, size: Size) {
        self.spans.clear();
        let (Some(bundle), Some(first)) = (Bundle::of(rays), rays.first()) else {
            self.spans.push([0, i32::MAX]);
            return;
        };
        let across = if first.along_x { size.rows } else { size.cols };
        let (last_cell, last_layer) = (across as i64 - 1, size.layers as i64 - 1);
        let [mut v, mut z] = bundle.start.map(|at| Span { low: at, high: at });
        let [mut v_next, mut z_next] = bundle.at_border;
        let [v_step, z_step] = bundle.step;
        for slab in 0..=bundle.count {
            let (first_v, last_v) = v.units_to(v_next, last_cell);
            let (low, high) = z.units_to(z_next, last_layer);
            (v, z) = (v_next, z_next);
            v_next.step(v_step);
            z_next.step(z_step);
            let layers = run(low, high);
            let shared = last_v - first_v < WIDEST
                && (first_v..=last_v).all(|v| known(first.index(slab, v)) & layers == layers);
            if shared {
                continue;
            }
            match self.spans.last_mut() {
                Some([_, end]) if *end == slab => *end += 1,
                _ => self.spans.push([slab, slab + 1]),
            }
        }
    }

    /// The gaps that were found last.
    pub(super) fn spans(&self) -> &[[i32; 2]] {
        &self.spans
    }

    /// Forgets them.
    pub(super) fn clear(&mut self) {
        self.spans.clear();
    }
}
