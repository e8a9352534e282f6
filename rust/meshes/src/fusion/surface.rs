//! The surface at which the distances are zero, by marching cubes.

use std::collections::HashMap;

use volume::GridKey;

use super::FusedVolume;
use super::block::{Distance, DistanceBlock, EDGE};
use super::cases::{CASES, CORNERS, EDGES};
use crate::mesh::TriangleMesh;
use crate::topology::unpinch;

/// Voxels along each side of a block and those beyond that its cubes reach.
const PADDED: usize = EDGE as usize + 1;
/// Corners keep off the voxels by this share: at a voxel those of several edges would fall together.
const LEAST_SHARE: f32 = 1e-3;

/// A triangle of the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePiece {
    /// Its corners, m; from outside they go around against the clock.
    pub corners_m: [[f32; 3]; 3],
    /// Frames that saw the voxel beside it that was seen least.
    pub frames: u16,
    /// Standard deviation of the distance to that of these voxels which is known least well, m.
    pub sigma_m: f32,
}

/// A corner of the surface: the edge between two voxels on which it lies.
type EdgeKey = (GridKey, u8);

impl FusedVolume {
    /// The whole surface, as a manifold: with borders where it was not seen further, or where range jumps.
    pub fn mesh(&self) -> TriangleMesh {
        let mut mesh = TriangleMesh::default();
        let mut numbers: HashMap<EdgeKey, u32> = HashMap::new();
        for position in 0..self.blocks.len() {
            self.each_triangle(position, |keys, piece| {
                let corners = [0, 1, 2].map(|at| {
                    *numbers.entry(keys[at]).or_insert_with(|| {
                        mesh.corners_m.push(piece.corners_m[at]);
                        mesh.corners_m.len() as u32 - 1
                    })
                });
                mesh.triangles.push(corners);
            });
        }
        let _ = unpinch(&mut mesh);
        mesh
    }

    /// Tells of all triangles of the surface, block by block.
    pub fn pieces(&self, mut take: impl FnMut(&SurfacePiece)) {
        for position in 0..self.blocks.len() {
            self.each_triangle(position, |_, piece| take(&piece));
        }
    }

    /// The triangles of the cubes whose lowest voxel is in a block.
    fn each_triangle(&self, position: usize, mut take: impl FnMut([EdgeKey; 3], SurfacePiece)) {
        let (key, _) = self.blocks.at(position);
        let known = self.padded(key);
        if !known.iter().flatten().any(|one| one.mean_m < 0.0) {
            return;
        }
        let voxel_m = self.config.voxel;
        let most_m = (self.config.steepest * voxel_m) as f32;
        let cases = &*CASES;
        for low in 0..DistanceBlock::index([0, 0, EDGE]) {
            let place = DistanceBlock::place(low);
            let Some(corners) = corners_of(&known, place) else {
                continue;
            };
            let inside = (0..CORNERS).fold(0, |bits, corner| {
                bits | usize::from(corners[corner].mean_m < 0.0) << corner
            });
            if cases[inside].is_empty() {
                continue;
            }
            let jumps = EDGES.iter().any(|&(corner, axis)| {
                let [a, b] = [corner, corner | 1 << axis].map(|at| corners[at].mean_m);
                (a < 0.0) != (b < 0.0) && (a - b).abs() > most_m
            });
            if jumps {
                continue;
            }
            let frames = corners.iter().map(|one| one.frames).min().unwrap_or(0);
            let weights = corners.iter().map(|one| one.weight);
            let sigma_m = weights.fold(f32::INFINITY, f32::min).recip().sqrt();
            let lowest: GridKey = std::array::from_fn(|axis| key[axis] * EDGE + place[axis]);
            let crossing = |edge: u8| {
                let (corner, axis) = EDGES[edge as usize];
                let [a, b] = [corner, corner | 1 << axis].map(|at| corners[at].mean_m);
                let share = (a / (a - b)).clamp(LEAST_SHARE, 1.0 - LEAST_SHARE);
                let voxel: GridKey =
                    std::array::from_fn(|one| lowest[one] + (corner >> one & 1) as i32);
                let at_m = std::array::from_fn(|one| {
                    let off = if one == axis { f64::from(share) } else { 0.0 };
                    ((f64::from(voxel[one]) + off) * voxel_m) as f32
                });
                ((voxel, axis as u8), at_m)
            };
            for triangle in &cases[inside] {
                let found = triangle.map(crossing);
                let corners_m = found.map(|(_, at_m)| at_m);
                let piece = SurfacePiece {
                    corners_m,
                    frames,
                    sigma_m,
                };
                take(found.map(|one| one.0), piece);
            }
        }
    }

    /// The voxels of a block and those beyond its upper sides; none where nothing is known.
    fn padded(&self, key: GridKey) -> Vec<Option<Distance>> {
        let mut padded = vec![None; PADDED * PADDED * PADDED];
        for beyond in 0..CORNERS {
            let off = [0, 1, 2].map(|axis| (beyond >> axis & 1) as i32);
            let Some(block) = self
                .blocks
                .get(std::array::from_fn(|axis| key[axis] + off[axis]))
            else {
                continue;
            };
            let until = off.map(|past| if past == 1 { 1 } else { EDGE });
            for z in 0..until[2] {
                for y in 0..until[1] {
                    for x in 0..until[0] {
                        let voxel = block.voxels[DistanceBlock::index([x, y, z])];
                        let place = [x, y, z];
                        let to = std::array::from_fn(|axis| place[axis] + EDGE * off[axis]);
                        if voxel.weight > 0.0 {
                            padded[padded_index(to)] = Some(voxel);
                        }
                    }
                }
            }
        }
        padded
    }
}

const fn padded_index([x, y, z]: [i32; 3]) -> usize {
    (z as usize * PADDED + y as usize) * PADDED + x as usize
}

/// The eight voxels of a cube, where all are known.
fn corners_of(known: &[Option<Distance>], place: [i32; 3]) -> Option<[Distance; CORNERS]> {
    let first = known[padded_index(place)]?;
    let mut corners = [first; CORNERS];
    for (corner, slot) in corners.iter_mut().enumerate().skip(1) {
        let at = std::array::from_fn(|axis| place[axis] + (corner >> axis & 1) as i32);
        *slot = known[padded_index(at)]?;
    }
    Some(corners)
}
