//! Voxels that rays pass, found from the voxels: slab by slab towards the eye, a voxel is marked where a ray surely goes by, and
//! only those are looked at ray by ray of which that is not sure.

use std::ops::Range;

use super::bins::{NEAR, around, one_each, spread, units, within};
use super::columns::Slabs;
use super::fan::{Fan, Grain};
use super::placement::Size;
use super::raster::Band;
use super::ray::RayPart;
use super::voxels::bits;

/// Nearer to the eye, in voxels, bins are too small for their margin.
const NEAREST: f64 = 0.01;
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
    /// Passed or hit.
    pub(super) passed: &'a mut [u64],
    pub(super) settled: &'a [u64],
}

impl Marked<'_> {
    /// Layers of which nothing is to be found out.
    #[inline]
    fn known(&self, cell: usize) -> u64 {
        self.passed[cell] | self.settled[cell]
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
            fan.show(slab as u32);
            let within = slab <= seen && slab >= nearest;
            // Those of the farthest slab may go on beyond the grid.
            let ends = within && slab < farthest;
            if !ends {
                fan.list(slab as u32);
            }
            if within {
                self.cross(fan, slab, marked);
                self.look(fan, slab, marked);
            }
            if ends {
                for ray in fan.ending(slab as u32) {
                    self.end(ray, slab, marked);
                }
                fan.list(slab as u32);
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
        let last = self.size.voxels()[self.axes[0]] - 1;
        let both = [slab - 1, slab].map(|slab| (self.ahead(slab)).clamp(0, last));
        let lines = self.lines(&fan.grain, [enter; 2]);
        let cells = |line: usize| both.map(|ahead| self.cell(ahead, line));
        let open = |marked: &Marked<'_>, cells: [usize; 2]| {
            !(marked.known(cells[0]) & marked.known(cells[1]))
        };
        let any = lines
            .clone()
            .fold(0, |any, line| any | open(marked, cells(line)));
        let any = any & self.all_layers(&fan.grain, [enter; 2]);
        if any == 0 {
            return;
        }
        let bands = self.bands(any, |low| within(&fan.grain, 1, low, enter));
        for line in lines {
            let cells = cells(line);
            let open = any & open(marked, cells);
            if open == 0 {
                continue;
            }
            let cols = within(&fan.grain, 0, self.beside(line), enter);
            if cols.is_empty() {
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
        let ahead = self.ahead(slab);
        let lines = self.lines(grain, [enter, leave]);
        let any = (lines.clone()).fold(0, |any, line| any | !marked.known(self.cell(ahead, line)));
        let any = any & self.all_layers(grain, [enter, leave]);
        if any == 0 {
            return;
        }
        let bands = self.bands(any, |low| around(grain, 1, low, [enter, leave]));
        for line in lines {
            let cell = self.cell(ahead, line);
            let open = any & !marked.known(cell);
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

    /// Marks what a ray passes in the slab in which it ends, unless all that may be is known: what it ends before, under a floor
    /// above all, is in nobody's way, so that these rays need not be asked about it.
    #[inline]
    fn end(&self, ray: usize, slab: i32, marked: &mut Marked<'_>) {
        let (eye, end) = (self.eye, self.ends[ray]);
        let Depth { enter, .. } = self.depth(slab);
        let ahead = (end[self.axes[0]] - eye[self.axes[0]]).abs();
        let part = if ahead > enter { enter / ahead } else { 0.0 };
        let [lines, layers] = [self.axes[1], 2].map(|axis| {
            let (from, to) = ((end[axis] - eye[axis]) * part, end[axis] - eye[axis]);
            let ends = if from < to { [from, to] } else { [to, from] };
            units(eye[axis], ends, self.size.voxels()[axis])
        });
        let (layers, ahead) = (one_each(layers), self.ahead(slab));
        let open = lines.fold(0, |open, line| open | !marked.known(self.cell(ahead, line)));
        if open & layers != 0 {
            self.walk(ray, slab..slab + 1, marked);
        }
    }

    /// Whether a ray passes a voxel, or almost: by its place across and its layer, within a slab.
    #[inline]
    fn goes_by(&self, ray: usize, voxel: [usize; 2], Depth { enter, leave }: Depth) -> bool {
        let (eye, end) = (self.eye, self.ends[ray]);
        let ahead = (end[self.axes[0]] - eye[self.axes[0]]).abs();
        let (from, to) = (enter - NEAR, leave.min(ahead) + NEAR);
        // Where it enters and leaves, from the voxel's middle, and half of the voxel; all as long as the ray goes ahead.
        let half = (0.5 + NEAR) * ahead;
        let [across, up] = [self.axes[1], 2].map(|axis| end[axis] - eye[axis]);
        let middle = |way: usize, axis: usize| (voxel[way] as f64 + 0.5 - eye[axis]) * ahead;
        let [line, layer] = [middle(0, self.axes[1]), middle(1, 2)];
        let [v0, v1] = [across * from - line, across * to - line];
        let [z0, z1] = [up * from - layer, up * to - layer];
        let beside = |a: f64, b: f64| a.min(b) > half || a.max(b) < -half;
        // Apart along across or up, or else by a line along the ray (separating axes).
        !(beside(v0, v1) || beside(z0, z1))
            && (up * v0 - across * z0).abs() <= (up.abs() + across.abs()) * half
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

    /// For each of some layers its rows.
    #[inline]
    fn bands(&self, layers: u64, rows: impl Fn(f64) -> Range<usize>) -> [Band; LAYERS] {
        let mut bands = [Band::default(); LAYERS];
        for layer in bits(layers) {
            bands[layer] = Band::new(rows(layer as f64 - self.eye[2]));
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

    /// Layers that may show between two distances.
    fn all_layers(&self, grain: &Grain, depths: [f64; 2]) -> u64 {
        self.layers(grain, [0, grain.size[1] - 1], depths)
    }

    /// Layers that may show in some rows between two distances.
    #[inline]
    fn layers(&self, grain: &Grain, [low, high]: [usize; 2], depths: [f64; 2]) -> u64 {
        let ends = spread(grain, 1, [low, high + 1], depths);
        one_each(units(self.eye[2], ends, self.size.layers as i32))
    }
}
