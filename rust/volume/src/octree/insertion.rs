//! Beams of a frame into the tree: the voxels that they end in become likelier occupied, those that they pass less likely.

use std::collections::BTreeMap;

use super::super::marks::Marks;
use super::super::placement::{Ray, Size};
use super::super::{VoxelWalk, voxels::bits};
use super::brick::{EDGE, index};
use super::key::{Key, SPAN, in_voxels, key_at};
use super::window::OctreeWindow;
use super::{Octree, OctreeError};
use crate::{Clearing, Update};

/// Largest part of space whose marks are kept at a time, in voxels; a column of marks is one word high.
const TILE: [i32; 3] = [1024, 1024, 64];
/// Ends that are further away than this, in voxels, have lost their direction to rounding.
const FARTHEST: f64 = 1e12;

/// Room for one frame, kept for the next one.
#[derive(Debug, Clone)]
pub(super) struct Workspace {
    marks: Marks,
    window: OctreeWindow,
}

impl Default for Workspace {
    fn default() -> Self {
        let nothing = Size {
            cols: 0,
            rows: 0,
            layers: 0,
        };
        Self {
            marks: Marks::new(nothing),
            window: OctreeWindow::default(),
        }
    }
}

/// A box of voxels.
#[derive(Debug, Clone, Copy)]
struct VoxelBounds {
    low: [i32; 3],
    high: [i32; 3],
}

impl VoxelBounds {
    /// Around what lies between two points, made of whole bricks; none where all of it is beyond what a tree can hold.
    fn around([low, high]: [[f64; 3]; 2]) -> Option<Self> {
        let span = f64::from(SPAN);
        let outside = |axis: usize| high[axis] < 0.0 || low[axis] >= span;
        if (0..3).any(outside) {
            return None;
        }
        let edge = EDGE as i32;
        let voxel = |at: f64| at.clamp(0.0, span - 1.0) as i32;
        Some(Self {
            low: low.map(|at| voxel(at) / edge * edge),
            high: high.map(|at| (voxel(at) / edge + 1) * edge),
        })
    }

    fn size(&self) -> [i32; 3] {
        std::array::from_fn(|axis| self.high[axis] - self.low[axis])
    }

    /// The tile of a number along each axis.
    fn tile(&self, number: [i32; 3]) -> Self {
        let low = std::array::from_fn(|axis| self.low[axis] + number[axis] * TILE[axis]);
        let high = std::array::from_fn(|axis| (low[axis] + TILE[axis]).min(self.high[axis]));
        Self { low, high }
    }
}

/// A point as seen from the corner of a box.
#[inline]
fn seen_from(low: [i32; 3], at: [f64; 3]) -> [f64; 3] {
    [
        at[0] - f64::from(low[0]),
        at[1] - f64::from(low[1]),
        at[2] - f64::from(low[2]),
    ]
}

/// Where beams end, in voxels, and whether something was seen there.
#[derive(Debug, Clone, Copy)]
struct RayEnds<'a> {
    rays: &'a [Ray],
    per_m: f64,
}

impl<'a> RayEnds<'a> {
    #[inline]
    fn of(self, ray: &Ray) -> ([f64; 3], bool) {
        (in_voxels(ray.end_m, self.per_m), ray.hit)
    }

    fn iter(self) -> impl Iterator<Item = ([f64; 3], bool)> + 'a {
        self.rays.iter().map(move |ray| self.of(ray))
    }

    /// The lowest and the highest corner of the box around the eye and all ends.
    fn corners(self, eye: [f64; 3]) -> Result<[[f64; 3]; 2], OctreeError> {
        let (mut low, mut high, mut all_usable) = (eye, eye, true);
        self.iter().for_each(|(end, _)| {
            for axis in 0..3 {
                let at = end[axis];
                all_usable &= at.abs() < FARTHEST;
                low[axis] = if at < low[axis] { at } else { low[axis] };
                high[axis] = if at > high[axis] { at } else { high[axis] };
            }
        });
        if all_usable {
            return Ok([low, high]);
        }
        let index = self.iter().position(|(end, _)| !usable(&end));
        Err(OctreeError::Point {
            index: index.unwrap_or_default(),
        })
    }
}

/// Whether a point is where beams may begin and end.
fn usable(at: &[f64; 3]) -> bool {
    at.iter().all(|at| at.abs() < FARTHEST)
}

impl Octree {
    /// Takes in the beams of one frame, all from `eye_m`, as the beam model of 002 says: the last voxel of a beam is occupied, all
    /// others up to it are free. Per frame each voxel is updated once, and occupied wins; per point by every beam.
    /// Where a beam says that nothing was seen, its last voxel is free, too. Of a beam that ends beyond what a tree can hold, the
    /// part inside counts; how many such ends were left out is returned, and it is an error where eye and all ends lie beyond.
    pub fn insert(
        &mut self,
        eye_m: [f64; 3],
        rays: &[Ray],
        update: Update,
    ) -> Result<usize, OctreeError> {
        let per_m = self.per_m();
        let eye = in_voxels(eye_m, per_m);
        if !usable(&eye) {
            return Err(OctreeError::Eye);
        }
        let ends = RayEnds { rays, per_m };
        let corners = ends.corners(eye)?;
        let beyond = self.ends_beyond(eye, ends, corners)?;
        match update {
            Update::PerFrame => self.insert_frame(eye, ends, corners),
            Update::PerPoint => self.insert_each(eye, ends),
        }
        Ok(beyond)
    }

    /// How many ends lie where no voxel is; refused where nothing of the frame lies elsewhere.
    fn ends_beyond(
        &self,
        eye: [f64; 3],
        ends: RayEnds<'_>,
        corners: [[f64; 3]; 2],
    ) -> Result<usize, OctreeError> {
        if corners.iter().all(|&corner| key_at(corner).is_some()) {
            return Ok(0);
        }
        let outside = |end: [f64; 3]| key_at(end).is_none();
        let all = ends.iter().all(|(end, _)| outside(end));
        match ends.rays.first() {
            Some(ray) if all && outside(eye) => Err(self.beyond(0, ray.end_m)),
            _ => Ok(ends
                .iter()
                .filter(|&(end, hit)| hit && outside(end))
                .count()),
        }
    }

    /// Per point: every beam at once.
    fn insert_each(&mut self, eye: [f64; 3], ends: RayEnds<'_>) {
        for (end, hit) in ends.iter() {
            let Some(walk) = VoxelWalk::new(eye, end, [SPAN; 3]) else {
                continue;
            };
            let seen = hit && walk.ends_inside;
            let last = walk.last;
            for voxel in walk {
                let key = voxel.map(|at| at as u16);
                self.update_voxel(key, seen && voxel == last);
            }
        }
    }

    /// Per frame: part of space by part of space.
    fn insert_frame(&mut self, eye: [f64; 3], ends: RayEnds<'_>, corners: [[f64; 3]; 2]) {
        let Some(bounds) = VoxelBounds::around(corners) else {
            return;
        };
        let size = bounds.size();
        if (0..3).all(|axis| size[axis] <= TILE[axis]) {
            self.insert_tile(bounds, eye, ends.iter());
            return;
        }
        for (number, rays) in through_tiles(bounds, eye, ends) {
            let rays = rays
                .into_iter()
                .map(|ray| ends.of(&ends.rays[ray as usize]));
            self.insert_tile(bounds.tile(number), eye, rays);
        }
    }

    fn insert_tile(
        &mut self,
        tile: VoxelBounds,
        eye: [f64; 3],
        ends: impl Iterator<Item = ([f64; 3], bool)>,
    ) {
        let [cols, rows, layers] = tile.size().map(|voxels| voxels as usize);
        let size = Size { cols, rows, layers };
        let Workspace { marks, window, .. } = &mut self.workspace;
        window.look(&self.nodes, &self.beam, tile.low, size);
        marks.resize(size);
        let ends = ends.map(|(end, hit)| (seen_from(tile.low, end), hit));
        let touched = marks.mark(
            seen_from(tile.low, eye),
            ends,
            Clearing::Shared,
            &window.settled,
        );
        let cells = |low: i32, high: i32, count: usize| {
            let end = (i64::from(high) + 1).clamp(0, count as i64) as usize;
            (low.max(0) as usize).min(end) / EDGE..end.div_ceil(EDGE)
        };
        for row in cells(touched.min.row, touched.max.row, rows) {
            for col in cells(touched.min.col, touched.max.col, cols) {
                self.update_bricks(tile, [col, row]);
            }
        }
    }

    /// Brings the marks of the bricks above each other at a place of a tile into the tree.
    fn update_bricks(&mut self, tile: VoxelBounds, [col, row]: [usize; 2]) {
        let Workspace { marks, window, .. } = &mut self.workspace;
        let cols = tile.size()[0] as usize;
        let mut columns = [[0_u64; 2]; EDGE * EDGE];
        let mut touched = 0;
        for (at, column) in columns.iter_mut().enumerate() {
            let cell = (row * EDGE + at / EDGE) * cols + col * EDGE + at % EDGE;
            let [hits, passed] = marks.take(cell);
            *column = [hits, passed & !window.settled[cell]];
            touched |= column[0] | column[1];
        }
        let per_brick = EDGE as u32;
        // One bit for each brick that is touched.
        let any = (touched | touched >> 1 | touched >> 2 | touched >> 3) & 0x1111_1111_1111_1111;
        for lowest in bits(any) {
            let (mut hits, mut misses) = (0, 0);
            for (at, [hit, passed]) in columns.iter().enumerate() {
                hits |= (hit >> lowest & 0xf) << (at as u32 * per_brick);
                misses |= (passed >> lowest & 0xf) << (at as u32 * per_brick);
            }
            let place = [col * EDGE, row * EDGE, lowest];
            let key: Key = std::array::from_fn(|axis| (tile.low[axis] + place[axis] as i32) as u16);
            let at = window.brick([col, row, lowest / EDGE]);
            let at = at.unwrap_or_else(|| self.nodes.expand(key, &self.beam));
            let brick = self.nodes.brick_mut(at);
            brick.update(hits, misses, &self.beam);
            if brick.known == u64::MAX && brick.common(u64::MAX).is_some() {
                self.nodes.prune(key);
            }
        }
    }

    /// Equation (1) for one voxel.
    pub fn update_voxel(&mut self, key: Key, hit: bool) {
        let known = self.nodes.value(key);
        let value = known.unwrap_or(0.0);
        let after = if hit {
            self.beam.after_hit(value)
        } else {
            self.beam.after_miss(value)
        };
        if known == Some(after) {
            return;
        }
        let at = self.nodes.expand(key, &self.beam);
        let [x, y, z] = key.map(|at| usize::from(at) % EDGE);
        let voxel = 1 << index(x, y, z);
        let (hits, misses) = if hit { (voxel, 0) } else { (0, voxel) };
        self.nodes.brick_mut(at).update(hits, misses, &self.beam);
        self.nodes.prune(key);
    }
}

/// Which rays pass which tiles, in a fixed order.
fn through_tiles(
    bounds: VoxelBounds,
    eye: [f64; 3],
    ends: RayEnds<'_>,
) -> BTreeMap<[i32; 3], Vec<u32>> {
    let size = bounds.size();
    let count = std::array::from_fn(|axis| (size[axis] + TILE[axis] - 1) / TILE[axis]);
    let in_tiles = |at: [f64; 3]| {
        let at = seen_from(bounds.low, at);
        std::array::from_fn(|axis| at[axis] / f64::from(TILE[axis]))
    };
    let mut tiles = BTreeMap::<_, Vec<u32>>::new();
    for (ray, (end, _)) in ends.iter().enumerate() {
        for tile in VoxelWalk::new(in_tiles(eye), in_tiles(end), count)
            .into_iter()
            .flatten()
        {
            tiles.entry(tile).or_default().push(ray as u32);
        }
    }
    tiles
}
