//! Triangles that share corners.

use nalgebra::{Isometry3, Point3, Vector3};

/// Triangles that share corners; seen from outside, or from where they were seen, each goes around against the clock.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TriangleMesh {
    /// Corners, m.
    pub corners_m: Vec<[f32; 3]>,
    /// Three corners each, by number.
    pub triangles: Vec<[u32; 3]>,
}

/// A point of three numbers, m.
#[inline]
pub(crate) fn vector(at_m: [f32; 3]) -> Vector3<f64> {
    Vector3::from(at_m.map(f64::from))
}

impl TriangleMesh {
    /// Where the corners of a triangle are, m.
    #[inline]
    pub fn places_m(&self, triangle: [u32; 3]) -> [Vector3<f64>; 3] {
        triangle.map(|corner| vector(self.corners_m[corner as usize]))
    }

    /// Across a triangle, to its outer side; as long as the triangle is large, m².
    #[inline]
    pub fn area_vector_m2(&self, triangle: [u32; 3]) -> Vector3<f64> {
        let [a, b, c] = self.places_m(triangle);
        (b - a).cross(&(c - a)) * 0.5
    }

    /// For each corner the direction across the surface there, of length 1: the mean of its triangles by their areas. Of triangles around
    /// a corner the areas' sum depends on their border alone, so that each further round tells of a wider ring with less noise. Zero
    /// at a corner of no triangle.
    pub fn normals(&self, rounds: usize) -> Vec<[f32; 3]> {
        let mut triangles = self.triangles.clone();
        triangles.retain(|&triangle| self.area_vector_m2(triangle) != Vector3::zeros());
        let mut across: Vec<_> = triangles
            .iter()
            .map(|&triangle| self.area_vector_m2(triangle))
            .collect();
        let mut sums = vec![Vector3::zeros(); self.corners_m.len()];
        for round in 0..=rounds {
            sums.fill(Vector3::zeros());
            for (triangle, across) in triangles.iter().zip(&across) {
                for &corner in triangle {
                    sums[corner as usize] += across;
                }
            }
            if round < rounds {
                for (triangle, across) in triangles.iter().zip(&mut across) {
                    *across = triangle.iter().map(|&corner| sums[corner as usize]).sum();
                }
            }
        }
        let unit = |sum: &Vector3<f64>| sum.try_normalize(0.0).unwrap_or_default();
        sums.iter().map(|sum| unit(sum).cast().into()).collect()
    }

    /// The mesh in another frame.
    #[must_use]
    pub fn moved(&self, there_from_here: &Isometry3<f64>) -> Self {
        let corners = self.corners_m.iter();
        let moved = corners.map(|&at_m| {
            let there = there_from_here * Point3::from(vector(at_m));
            there.coords.cast().into()
        });
        Self {
            corners_m: moved.collect(),
            triangles: self.triangles.clone(),
        }
    }

    /// Drops corners of which there is no triangle; returns which numbers the others had.
    pub fn drop_unused_corners(&mut self) -> Vec<u32> {
        let mut used = vec![false; self.corners_m.len()];
        for &corner in self.triangles.as_flattened() {
            used[corner as usize] = true;
        }
        let numbers = 0..self.corners_m.len() as u32;
        let kept: Vec<u32> = numbers.filter(|&at| used[at as usize]).collect();
        let mut now = vec![0; self.corners_m.len()];
        for (at, &before) in kept.iter().enumerate() {
            now[before as usize] = at as u32;
        }
        self.corners_m = kept.iter().map(|&at| self.corners_m[at as usize]).collect();
        for corner in self.triangles.as_flattened_mut() {
            *corner = now[*corner as usize];
        }
        kept
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_without_a_triangle_go_and_the_others_keep_their_places() {
        let corners_m = vec![
            [9.0; 3],
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [8.0; 3],
            [0.0, 1.0, 0.0],
        ];
        let mut mesh = TriangleMesh {
            corners_m,
            triangles: vec![[1, 2, 4]],
        };
        let before = mesh.places_m([1, 2, 4]);
        assert_eq!(mesh.drop_unused_corners(), [1, 2, 4]);
        assert_eq!(mesh.places_m(mesh.triangles[0]), before);
        assert_eq!(mesh.normals(2), [[0.0, 0.0, 1.0]; 3]);
    }
}
