//! Pictures on a mesh: each triangle shows the picture that saw it best (004, Fig. 36.15).

use nalgebra::{Isometry3, Point3, Vector3};
use sensing::PinholeCamera;

use crate::joining::JoiningRule;
use crate::mesh::{TriangleMesh, vector};

/// A picture in colour, of which the ranges are known.
#[derive(Debug, Clone)]
pub struct TextureView {
    /// The camera, of ranges and colours alike.
    pub camera: PinholeCamera,
    /// Where it stood.
    pub map_from_camera: Isometry3<f64>,
    /// Of each pixel, row by row, how far away it saw something, m; NaN where nothing.
    pub ranges_m: Vec<f32>,
}

/// A mesh whose corners lie in pictures.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TexturedMesh {
    /// The mesh. Where triangles beside each other show different pictures, each has corners of its own.
    pub mesh: TriangleMesh,
    /// For each corner the number of the picture that its triangles show; none where no picture saw them.
    pub views: Vec<Option<u32>>,
    /// For each corner column and row in that picture, pixels.
    pub at_px: Vec<[f32; 2]>,
}

/// The mesh, in the map frame, with for each triangle the picture in which it is largest: from near and from the front. A picture counts where
/// it sees all three corners, as far away as they are but for noise.
pub fn textured(mesh: &TriangleMesh, views: &[TextureView], rule: &JoiningRule) -> TexturedMesh {
    let seen: Vec<Vec<Option<[f64; 2]>>> = views
        .iter()
        .map(|view| view.corners_px(mesh, rule))
        .collect();
    let best = mesh.triangles.iter().map(|triangle| {
        let sizes = seen.iter().enumerate().filter_map(|(number, corners)| {
            let [a, b, c] = triangle.map(|corner| corners[corner as usize]);
            let (a, b, c) = (a?, b?, c?);
            // Rows go down: what faces the camera goes around the other way.
            let turn = (b[1] - a[1]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[1] - a[1]);
            (turn > 0.0).then_some((number as u32, turn))
        });
        let largest = sizes.max_by(|one, other| one.1.total_cmp(&other.1));
        largest.map(|(number, _)| number)
    });
    let best: Vec<Option<u32>> = best.collect();
    let mut slots: Vec<(u32, Option<u32>, usize)> = Vec::new();
    for (at, (triangle, view)) in mesh.triangles.iter().zip(&best).enumerate() {
        for (side, &corner) in triangle.iter().enumerate() {
            slots.push((corner, *view, 3 * at + side));
        }
    }
    slots.sort_unstable();
    let mut found = TexturedMesh {
        mesh: TriangleMesh {
            corners_m: Vec::new(),
            triangles: mesh.triangles.clone(),
        },
        ..TexturedMesh::default()
    };
    for same in slots.chunk_by(|one, other| (one.0, one.1) == (other.0, other.1)) {
        let (corner, view, _) = same[0];
        let number = found.views.len() as u32;
        let at_px = view.and_then(|view| seen[view as usize][corner as usize]);
        found.mesh.corners_m.push(mesh.corners_m[corner as usize]);
        found.views.push(view);
        found
            .at_px
            .push(at_px.unwrap_or_default().map(|px| px as f32));
        for &(_, _, slot) in same {
            found.mesh.triangles.as_flattened_mut()[slot] = number;
        }
    }
    found
}

impl TextureView {
    /// Where a place of the map frame is in the picture, column and row, and how far away it is, m; none behind the camera.
    pub fn project(&self, at_m: Vector3<f64>) -> Option<([f64; 2], f64)> {
        let at = self
            .map_from_camera
            .inverse_transform_point(&Point3::from(at_m));
        let ([fx, fy], [cx, cy]) = (self.camera.focal_px, self.camera.centre_px);
        let px = [fx * at.x / at.z + cx, fy * at.y / at.z + cy];
        (at.z > 0.0).then(|| (px, at.coords.norm()))
    }

    /// Where the corners that the picture sees are in it.
    fn corners_px(&self, mesh: &TriangleMesh, rule: &JoiningRule) -> Vec<Option<[f64; 2]>> {
        let [width, height] = self.camera.size_px;
        let corners = mesh.corners_m.iter();
        let seen = corners.map(|&at_m| {
            let (px, range_m) = self.project(vector(at_m))?;
            let [col, row] = px.map(|at| at + 0.5);
            if !(col >= 0.0 && row >= 0.0 && col < width as f64 && row < height as f64) {
                return None;
            }
            let seen_m = f64::from(*self.ranges_m.get(row as usize * width + col as usize)?);
            rule.as_far(range_m, seen_m).then_some(px)
        });
        seen.collect()
    }
}
