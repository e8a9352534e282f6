//! Triangles, seen from both sides, in a tree of boxes.

use parry3d_f64::math::Vector;
use parry3d_f64::query::{Ray, RayCast};
use parry3d_f64::shape::TriMesh;

use crate::error::SceneError;
use crate::eye::Triple;
use crate::view::Around;

/// A mesh with its tree, made once; bodies share it.
#[derive(Debug, Clone)]
pub struct Mesh {
    triangles: TriMesh,
    around: Around,
}

impl Mesh {
    /// Refuses a mesh that cannot be used, which is the `index`th of the scene.
    pub fn new(
        index: usize,
        vertices: &[[f32; 3]],
        faces: &[[u32; 3]],
    ) -> Result<Self, SceneError> {
        if let Some(bad) = vertices
            .iter()
            .position(|v| !v.iter().all(|x| x.is_finite()))
        {
            let what = format!("vertex {bad} of mesh {index}");
            return Err(SceneError::NotFinite { what });
        }
        let there = |face: &[u32; 3]| face.iter().all(|v| (*v as usize) < vertices.len());
        if let Some(face) = faces.iter().position(|face| !there(face)) {
            return Err(SceneError::Face { mesh: index, face });
        }
        let points: Vec<Vector> = vertices
            .iter()
            .map(|v| Vector::new(f64::from(v[0]), f64::from(v[1]), f64::from(v[2])))
            .collect();
        let triangles =
            TriMesh::new(points, faces.to_vec()).map_err(|_| SceneError::Empty { mesh: index })?;
        let bounds = triangles.local_aabb();
        let (centre, half) = (bounds.center(), bounds.half_extents());
        Ok(Self {
            triangles,
            around: Around {
                centre: [centre.x, centre.y, centre.z],
                half: [half.x, half.y, half.z],
            },
        })
    }

    /// The box around it.
    pub(crate) const fn around(&self) -> &Around {
        &self.around
    }

    /// How near a ray from a place meets it, if nearer than what is known; else 0.
    #[inline]
    pub(crate) fn met(&self, place: Triple, ray: Triple, known: f64) -> f64 {
        let ray = Ray::new(Vector::from(place), Vector::from(ray));
        let farthest = if known > 0.0 { 1.0 / known } else { f64::MAX };
        let found = self.triangles.bvh().cast_ray(&ray, farthest, |face, best| {
            self.triangles
                .triangle(face)
                .cast_local_ray(&ray, best, false)
        });
        found.map_or(0.0, |(_, depth)| 1.0 / depth)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle() -> Mesh {
        let vertices = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        Mesh::new(0, &vertices, &[[0, 1, 2]]).unwrap()
    }

    #[test]
    fn a_triangle_is_met_from_both_sides_and_not_beside_it() {
        let mesh = triangle();
        assert_eq!(mesh.met([0.2, 0.2, 2.0], [0.0, 0.0, -1.0], 0.0), 0.5);
        assert_eq!(mesh.met([0.2, 0.2, -2.0], [0.0, 0.0, 1.0], 0.0), 0.5);
        assert_eq!(mesh.met([0.6, 0.6, 2.0], [0.0, 0.0, -1.0], 0.0), 0.0);
        assert_eq!(mesh.met([0.2, 0.2, 2.0], [0.0, 0.0, 1.0], 0.0), 0.0);
    }

    #[test]
    fn what_lies_behind_something_nearer_is_not_looked_for() {
        assert_eq!(triangle().met([0.2, 0.2, 2.0], [0.0, 0.0, -1.0], 1.0), 0.0);
    }

    #[test]
    fn a_mesh_with_what_is_no_number_is_refused_in_one_line() {
        let vertices = [[0.0; 3], [1.0, 0.0, f32::NAN], [0.0, 1.0, 0.0]];
        let refused = Mesh::new(3, &vertices, &[[0, 1, 2]]).unwrap_err();
        assert_eq!(
            refused.to_string(),
            "vertex 1 of mesh 3 is no finite number"
        );
        let refused = Mesh::new(0, &[[0.0; 3]; 3], &[[0, 1, 3]]).unwrap_err();
        assert_eq!(
            refused.to_string(),
            "face 0 of mesh 0 names a vertex that is not there"
        );
        assert!(Mesh::new(0, &[], &[]).is_err());
    }
}
