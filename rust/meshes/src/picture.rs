//! A mesh of one depth image: neighbours in the picture are neighbours in the mesh, where they are on one surface.

use nalgebra::{Isometry3, Vector3};

use crate::joining::JoiningRule;
use crate::mesh::{TriangleMesh, vector};
use crate::topology::unpinch;

/// A mesh of what was seen at once.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SeenMesh {
    /// In the frame of the points; all its triangles face the eye.
    pub mesh: TriangleMesh,
    /// For each corner the number of the point that it is.
    pub points: Vec<u32>,
}

/// Directions from a pixel to its neighbours: columns and rows.
const WAYS: [[isize; 2]; 4] = [[1, 0], [0, 1], [1, 1], [-1, 1]];
const RIGHT: u8 = 1;
const DOWN: u8 = 2;
const FALLING: u8 = 4;
const RISING: u8 = 8;

/// A mesh of the points of a picture, row by row, m, NaN where nothing was seen, seen from a camera that stands like this in their frame
/// (x right, y down, z forward). No triangle joins points between which range jumps. Row by row, that is always a manifold but for
/// corners at which two parts touch, and these get a corner for each part.
pub fn mesh_of_picture(
    points_m: &[[f32; 3]],
    width: usize,
    here_from_camera: &Isometry3<f64>,
    rule: &JoiningRule,
) -> SeenMesh {
    let picture = PictureGrid::new(points_m, width, here_from_camera);
    let joined = picture.joined(rule);
    let mut mesh = TriangleMesh {
        corners_m: points_m.to_vec(),
        triangles: Vec::new(),
    };
    let height = points_m.len().checked_div(width).unwrap_or(0);
    let number = |col: usize, row: usize| (row * width + col) as u32;
    for row in 1..height {
        for col in 1..width {
            let [a, b] = [number(col - 1, row - 1), number(col, row - 1)];
            let [d, c] = [number(col - 1, row), number(col, row)];
            let is = |from: u32, way: u8| joined[from as usize] & way != 0;
            let (top, bottom) = (is(a, RIGHT), is(d, RIGHT));
            let (left, right) = (is(a, DOWN), is(b, DOWN));
            // Against the clock as the camera sees it: its y points down.
            let falling = [
                (left && bottom).then_some([a, d, c]),
                (top && right).then_some([a, c, b]),
            ];
            let rising = [
                (left && top).then_some([a, d, b]),
                (bottom && right).then_some([b, d, c]),
            ];
            let whole =
                |pair: [Option<[u32; 3]>; 2], way: bool| pair.map(|half| half.filter(|_| way));
            let halves = [whole(falling, is(a, FALLING)), whole(rising, is(b, RISING))];
            let count = halves.map(|pair| pair.iter().flatten().count());
            // Along the shorter diagonal where both would do.
            let shorter = picture.apart_m(b, d) < picture.apart_m(a, c);
            let chosen = if count[0] == count[1] {
                usize::from(shorter)
            } else {
                usize::from(count[1] > count[0])
            };
            mesh.triangles.extend(halves[chosen].iter().flatten());
        }
    }
    SeenMesh::tidied(mesh)
}

impl SeenMesh {
    /// Of a mesh whose corners are the points: those at which parts touch are doubled, those of no triangle left out.
    pub(crate) fn tidied(mut mesh: TriangleMesh) -> Self {
        let was = unpinch(&mut mesh);
        let kept = mesh.drop_unused_corners();
        Self {
            mesh,
            points: kept.iter().map(|&at| was[at as usize]).collect(),
        }
    }
}

/// The points of a picture as the camera sees them.
struct PictureGrid {
    /// From the eye, m; NaN where nothing was seen.
    from_eye_m: Vec<Vector3<f64>>,
    /// Along the optical axis, m.
    depths_m: Vec<f64>,
    width: usize,
}

impl PictureGrid {
    fn new(points_m: &[[f32; 3]], width: usize, here_from_camera: &Isometry3<f64>) -> Self {
        let (eye, forward) = (
            here_from_camera.translation.vector,
            here_from_camera.rotation * Vector3::z(),
        );
        let from_eye_m: Vec<_> = points_m.iter().map(|&at| vector(at) - eye).collect();
        let depths_m = from_eye_m.iter().map(|at| at.dot(&forward)).collect();
        Self {
            from_eye_m,
            depths_m,
            width,
        }
    }

    fn apart_m(&self, one: u32, other: u32) -> f64 {
        (self.from_eye_m[one as usize] - self.from_eye_m[other as usize]).norm()
    }

    /// For each pixel to which of its neighbours it is joined, a bit a way.
    fn joined(&self, rule: &JoiningRule) -> Vec<u8> {
        let mut joined = vec![0; self.depths_m.len()];
        for (at, bits) in joined.iter_mut().enumerate() {
            if self.depths_m[at].is_nan() {
                continue;
            }
            for (bit, way) in WAYS.into_iter().enumerate() {
                if self.joins(at, way, rule) {
                    *bits |= 1 << bit;
                }
            }
        }
        joined
    }

    fn joins(&self, at: usize, way: [isize; 2], rule: &JoiningRule) -> bool {
        let Some(next) = self.beside(at, way) else {
            return false;
        };
        let (one, other) = (&self.from_eye_m[at], &self.from_eye_m[next]);
        if rule.joins(one, other) {
            return true;
        }
        let back = way.map(|step| -step);
        let (Some(before), Some(behind)) = (self.beside(at, back), self.beside(next, way)) else {
            return false;
        };
        let depths = |three: [usize; 3]| three.map(|pixel| self.depths_m[pixel]);
        rule.goes_on(depths([before, at, next])) && rule.goes_on(depths([behind, next, at]))
    }

    /// The pixel beside another, where something was seen.
    fn beside(&self, at: usize, [cols, rows]: [isize; 2]) -> Option<usize> {
        let col = (at % self.width).checked_add_signed(cols)?;
        let row = (at / self.width).checked_add_signed(rows)?;
        let there = row * self.width + col;
        let seen = col < self.width && self.depths_m.get(there).is_some_and(|d| !d.is_nan());
        seen.then_some(there)
    }
}
