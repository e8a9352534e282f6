//! Voxels that rays pass, found from the voxels: slab by slab towards the eye, a voxel is marked where a ray surely goes by, and
//! only those are looked at ray by ray of which that is not sure.

use std::ops::Range;

use super::columns::{Slabs, run};
use super::fan::{Fan, Grain};
use super::placement::Size;
use super::raster::Band;
use super::ray::RayPart;
use super::voxels::bits;

/// Part of a bin that is more than what 32 bits may lose: a rounding guard.
const MARGIN: f64 = 1e-3;
/// Part of a voxel that is far more than the rounding of a ray: a rounding guard, behind which every ray is followed exactly.
const NEAR: f64 = 1e-4;
/// Nearer to the eye, in voxels, bins are too small for their margin.
const NEAREST: f64 = 0.01;
/// What is nearer is taken to be so far: by then no ray that is not steep has left [`NEAR`].
const TOUCHED: f64 = 1e-5;
/// Layers at most: one bit each of a word.
const LAYERS: usize = 64;

/// Where rays go: an axis of the grid, and the one across.
#[derive(Debug, Clone, Copy)]
pub(super) struct SweepWay {
    pub(super) along_x: bool,
    pub(super) forward: bool,
}

/// What is marked.
pub(super) struct Marked<'a> {
    pub(super) hits: &'a [u64],
    pub(super) passed: &'a mut [u64],
    pub(super) settled: &'a [u64],
}

impl Marked<'_> {
    /// Layers of which nothing is to be found out.
    #[inline]
    fn known(&self, cell: usize) -> u64 {
        self.hits[cell] | self.passed[cell] | self.settled[cell]
    }
}

/// Rays from one eye through a grid.
pub(super) struct RaySweep<'a> {
    eye: [f64; 3],
    ends: &'a [[f64; 3]],
    size: Size,
    /// Axes ahead and across, and what a step along them adds to a cell's index.
    axes: [usize; 2],
    strides: [usize; 2],
    /// Voxel of the eye ahead, and the direction.
    first: i32,
    step: i32,
    /// From the eye to where the first slab is left, voxels.
    to_border: f64,
}

/// The part of a slab that is looked at: how far away it begins and ends, voxels.
#[derive(Clone, Copy)]
struct Depth {
    enter: f64,
    leave: f64,
}

impl<'a> RaySweep<'a> {
    pub(super) fn new(way: SweepWay, eye: [f64; 3], ends: &'a [[f64; 3]], size: Size) -> Self {
        let axes = if way.along_x { [0, 1] } else { [1, 0] };
        let behind = eye[axes[0]].floor();
        Self {
            eye,
            ends,
            size,
            axes,
            strides: axes.map(|axis| if axis == 0 { 1 } else { size.cols }),
            first: behind as i32,
            step: if way.forward { 1 } else { -1 },
            to_border: (behind + f64::from(u8::from(way.forward)) - eye[axes[0]]).abs(),
        }
    }

    /// Marks what the rays of a fan pass.
    pub(super) fn mark(&self, fan: &mut Fan, marked: &mut Marked<'_>) {
        let across = self.size.voxels()[self.axes[0]];
        let (nearest, farthest) = if self.step > 0 {
            (-self.first, across - 1 - self.first)
        } else {
            (self.first - across + 1, self.first)
        };
        if farthest < 0 {
            return;
        }
        fan.sort(farthest as u32, self.ends.len());
        // Further away a voxel need not hold a whole bin.
        let seen = (0.5 * fan.grain.per_slope - self.to_border) as i32;
        for slab in (0..=farthest).rev() {
            fan.let_in(slab as u32);
            if slab <= seen && slab >= nearest {
                self.cross(fan, slab, marked);
                self.look(fan, slab, marked);
            }
        }
        if seen < farthest {
            for ray in fan.reaching((seen + 1) as u32) {
                self.walk(ray, (seen + 1)..i32::MAX, marked);
            }
        }
    }

    /// Voxels on both sides of where a slab is entered: rays that reach it go from one into the other.
    fn cross(&self, fan: &Fan, slab: i32, marked: &mut Marked<'_>) {
        let Depth { enter, .. } = self.depth(slab);
        if slab == 0 || enter < NEAREST {
            return;
        }
        let bands = self.bands(|low| within(&fan.grain, 1, low, enter));
        let last = self.size.voxels()[self.axes[0]] - 1;
        let both = [slab - 1, slab].map(|slab| (self.ahead(slab)).clamp(0, last));
        for line in self.lines(&fan.grain, [enter; 2]) {
            let cells = [self.cell(both[0], line), self.cell(both[1], line)];
            let open = !(marked.known(cells[0]) & marked.known(cells[1]));
            let cols = within(&fan.grain, 0, self.beside(line), enter);
            if cols.is_empty() || open == 0 {
                continue;
            }
            let rows = fan.raster.rows(cols);
            let Some(ends) = rows.ends() else { continue };
            let mut found = 0;
            for layer in bits(open & self.layers(&fan.grain, ends, [enter; 2])) {
                found |= u64::from(rows.meet(&bands[layer])) << layer;
            }
            marked.passed[cells[0]] |= found;
            marked.passed[cells[1]] |= found;
        }
    }

    /// Asks the rays about the voxels of a slab that one may pass and that are not marked yet.
    fn look(&self, fan: &Fan, slab: i32, marked: &mut Marked<'_>) {
        let Depth { enter, leave } = self.depth(slab);
        let grain = &fan.grain;
        let bands = self.bands(|low| around(grain, 1, low, [enter, leave]));
        let ahead = self.ahead(slab);
        for line in self.lines(grain, [enter, leave]) {
            let cell = self.cell(ahead, line);
            let open = !marked.known(cell);
            if open == 0 {
                continue;
            }
            let cols = around(grain, 0, self.beside(line), [enter, leave]);
            let rows = fan.raster.rows(cols.clone());
            let Some(ends) = rows.ends() else { continue };
            for layer in bits(open & self.layers(grain, ends, [enter, leave])) {
                let band = &bands[layer];
                let left = |marked: &Marked<'_>| marked.passed[cell] >> layer & 1 == 0;
                if rows.meet(band) && left(marked) {
                    let _found = fan.any(&cols, &band.range(), |ray| {
                        if self.goes_by(ray, [line, layer], self.depth(slab)) {
                            self.walk(ray, slab..slab + 1, marked);
                        }
                        !left(marked)
                    });
                }
            }
        }
    }

    /// Whether a ray passes a voxel, or almost: by its place across and its layer, within a slab.
    #[inline]
    fn goes_by(&self, ray: usize, voxel: [usize; 2], Depth { enter, leave }: Depth) -> bool {
        let (eye, end) = (self.eye, self.ends[ray]);
        let ahead = (end[self.axes[0]] - eye[self.axes[0]]).abs();
        let (mut from, mut to) = (enter - NEAR, leave.min(ahead) + NEAR);
        for way in 0..2 {
            let axis = [self.axes[1], 2][way];
            let low = voxel[way] as f64 - eye[axis];
            let beside = end[axis] - eye[axis];
            let (low, high) = ((low - NEAR) * ahead, (low + 1.0 + NEAR) * ahead);
            let (a, b) = (beside * from, beside * to);
            if a < low && b < low || a > high && b > high {
                return false;
            }
            if beside != 0.0 {
                let (a, b) = (low / beside, high / beside);
                (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
            }
        }
        from <= to
    }

    /// Marks what a ray passes in some slabs, counted from the eye's.
    pub(super) fn walk(&self, ray: usize, slabs: Range<i32>, marked: &mut Marked<'_>) {
        if let Some(part) = RayPart::inside(self.eye, self.ends[ray], self.size.voxels()) {
            let before = (part.first[self.axes[0]] - self.first).abs();
            let from_first = |slab: i32| (slab - before).max(0);
            let (from, end) = (from_first(slabs.start), from_first(slabs.end));
            Slabs::new(&part, self.size.cols).visit(from, end, |cell, layers| {
                marked.passed[cell] |= layers;
            });
        }
    }

    fn depth(&self, slab: i32) -> Depth {
        let leave = self.to_border + f64::from(slab);
        Depth {
            enter: (leave - 1.0).max(0.0),
            leave,
        }
    }

    fn ahead(&self, slab: i32) -> i32 {
        self.first + self.step * slab
    }

    #[inline]
    fn cell(&self, ahead: i32, line: usize) -> usize {
        ahead as usize * self.strides[0] + line * self.strides[1]
    }

    /// How far across the eye a line of voxels begins.
    #[inline]
    fn beside(&self, line: usize) -> f64 {
        line as f64 - self.eye[self.axes[1]]
    }

    /// For each layer its rows.
    #[inline]
    fn bands(&self, rows: impl Fn(f64) -> Range<usize>) -> [Band; LAYERS] {
        let mut bands = [Band::default(); LAYERS];
        for (layer, band) in bands[..self.size.layers].iter_mut().enumerate() {
            *band = Band::new(rows(layer as f64 - self.eye[2]));
        }
        bands
    }

    /// Lines of voxels that lie across between two distances, from the leftmost ray to the rightmost.
    fn lines(&self, grain: &Grain, depths: [f64; 2]) -> Range<usize> {
        let across = self.axes[1];
        let [low, high] = spread(grain, 0, [0, grain.size[0]], depths);
        let count = self.size.voxels()[across];
        units(self.eye[across], [low, high], count)
    }

    /// Layers that may show in some rows between two distances.
    #[inline]
    fn layers(&self, grain: &Grain, [low, high]: [usize; 2], depths: [f64; 2]) -> u64 {
        let ends = spread(grain, 1, [low, high + 1], depths);
        let layers = units(self.eye[2], ends, self.size.layers as i32);
        if layers.is_empty() {
            0
        } else {
            run(layers.start as i64, layers.end as i64 - 1)
        }
    }
}

/// The voxels that hold what lies between two distances from the eye, and what almost does.
#[inline]
fn units(eye: f64, [low, high]: [f64; 2], count: i32) -> Range<usize> {
    let last = f64::from(count);
    let (low, high) = (eye + low - NEAR, eye + high + NEAR);
    low.clamp(0.0, last) as usize..(high + 1.0).clamp(0.0, last) as usize
}

/// How far some bins are from the eye's axis between two depths.
#[inline]
fn spread(grain: &Grain, way: usize, bins: [usize; 2], depths: [f64; 2]) -> [f64; 2] {
    let slope = |bin: usize| grain.lowest[way] + bin as f64 / grain.per_slope;
    let [low, high] = [slope(bins[0]), slope(bins[1])];
    let [near, far] = depths;
    [(low * near).min(low * far), (high * near).max(high * far)]
}

/// The bins that lie as a whole between `low` and `low + 1` voxels beside the eye's axis.
#[inline]
fn within(grain: &Grain, way: usize, low: f64, depth: f64) -> Range<usize> {
    let per_voxel = grain.per_slope / depth;
    let start = low * per_voxel - grain.lowest[way] * grain.per_slope;
    let end = start + per_voxel;
    let first = start + MARGIN;
    let first = if first > 0.0 { first as usize + 1 } else { 0 };
    let count = grain.size[way];
    first.min(count)..(((end - MARGIN).max(0.0)) as usize).min(count)
}

/// The bins of which a part lies, or almost does, between `low` and `low + 1` voxels beside the eye's axis, between two depths.
#[inline]
fn around(grain: &Grain, way: usize, low: f64, [near, far]: [f64; 2]) -> Range<usize> {
    let per_voxel = |depth: f64| grain.per_slope / depth.max(TOUCHED);
    let (near, far) = (per_voxel(near), per_voxel(far));
    let (low, high) = (low - NEAR, low + 1.0 + NEAR);
    let origin = grain.lowest[way] * grain.per_slope;
    let start = (low * near).min(low * far) - origin - MARGIN;
    let end = (high * near).max(high * far) - origin + MARGIN;
    let count = grain.size[way];
    let end = ((end + 1.0).max(0.0) as usize).min(count);
    (start.max(0.0) as usize).min(end)..end
}
