//! The ground as triangles between the middles of cells.

use geometry::{Grid, Lattice};
use settings::{ConfigError, POSITIVE, Table, settings};

use crate::cloud::Point3;

settings! {
    /// How the ground becomes triangles.
    pub struct GroundMeshConfig("classification.ground_mesh") {
        /// Heights farther apart than this, cell to cell, are an edge that no triangle bridges.
        step: f64 = 0.05, "m", POSITIVE;
    }
}

/// Triangles that meet at the middles of cells, seen from above against the clock.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct GroundMesh {
    /// Corners, m.
    pub corners: Vec<Point3>,
    /// Three corners each.
    pub triangles: Vec<[usize; 3]>,
}

impl GroundMesh {
    /// Of a grid of heights (m): two triangles between four cells, fewer where a height is unknown or an edge runs.
    pub fn of_heights(
        config: &GroundMeshConfig,
        heights_m: &Grid<Option<f64>>,
        lattice: &Lattice,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        let cols = heights_m.cols();
        let mut mesh = Self::default();
        let mut number = vec![None; heights_m.values().len()];
        for (index, height_m) in heights_m.values().iter().enumerate() {
            if let Some(height_m) = height_m {
                let cell = geometry::Cell::new((index % cols) as i32, (index / cols) as i32);
                let [x, y] = lattice.center_of(cell);
                number[index] = Some(mesh.corners.len());
                mesh.corners.push([x, y, *height_m]);
            }
        }
        for row in 1..heights_m.rows() {
            for col in 1..cols {
                let at = row * cols + col;
                let [a, b, c, d] =
                    [at - cols - 1, at - cols, at, at - 1].map(|index| number[index]);
                // Along the diagonal whose ends are nearer in height: an edge that runs across is met at one corner only.
                let apart = |one: Option<usize>, other: Option<usize>| match (one, other) {
                    (Some(one), Some(other)) => {
                        (mesh.corners[one][2] - mesh.corners[other][2]).abs()
                    }
                    _ => f64::INFINITY,
                };
                let halves = if apart(a, c) <= apart(b, d) {
                    [[a, b, c], [a, c, d]]
                } else {
                    [[a, b, d], [b, c, d]]
                };
                for half in halves {
                    let whole = (0..3).all(|at| apart(half[at], half[(at + 1) % 3]) <= config.step);
                    if let ([Some(a), Some(b), Some(c)], true) = (half, whole) {
                        mesh.triangles.push([a, b, c]);
                    }
                }
            }
        }
        Ok(mesh)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::Noise;

    #[test]
    fn no_triangle_bridges_an_edge_and_all_others_are_there() {
        let lattice = Lattice {
            origin_m: [0.0, 0.0],
            cell_m: 0.1,
        };
        let mut noise = Noise::new(2);
        let mut heights_m = Grid::filled(10, 8, None);
        for (index, height_m) in heights_m.values_mut().iter_mut().enumerate() {
            let step_m = if index % 10 < 5 { 0.0 } else { 0.2 };
            *height_m = Some(step_m + noise.within(-0.01, 0.01));
        }
        let config = GroundMeshConfig::default();
        let mesh = GroundMesh::of_heights(&config, &heights_m, &lattice).unwrap();
        assert_eq!(mesh.triangles.len(), 2 * 7 * 8); // nine gaps between columns less the edge
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|corner| mesh.corners[corner]);
            assert!((a[2] - b[2]).abs() < 0.05 && (b[2] - c[2]).abs() < 0.05);
            let turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            assert!(turn > 0.0, "{triangle:?}");
        }
        *heights_m.get_mut(geometry::Cell::new(2, 2)).unwrap() = None;
        let holed = GroundMesh::of_heights(&config, &heights_m, &lattice).unwrap();
        // Four squares around the hole keep one triangle at most.
        assert!((2 * 7 * 8 - 8..=2 * 7 * 8 - 4).contains(&holed.triangles.len()));
    }
}
