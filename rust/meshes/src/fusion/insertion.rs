//! How a mesh of one frame changes the distances around it.

use nalgebra::{Matrix3, Vector3};

use crate::mesh::TriangleMesh;

/// A triangle with what lies along the lines of sight through it.
pub(super) struct SightPrism {
    /// Of a place from the eye its shares of the corners.
    shares_of: Matrix3<f64>,
    /// Lowest and highest place, m.
    low_m: Vector3<f64>,
    high_m: Vector3<f64>,
    /// The axis that the lines of sight go along most.
    along: usize,
    eye_m: Vector3<f64>,
    /// Of a length along the line of sight that across the surface.
    pub(super) lean: f64,
    /// How far away it is, m.
    pub(super) range_m: f64,
    places_m: [Vector3<f64>; 3],
    /// Across the surface, of length 1.
    normal: Vector3<f64>,
}

impl SightPrism {
    /// Before and behind a triangle, up to a distance across the surface, m, that is found from the range. `normals`: across the surface at
    /// each corner; `flattest`: the sine of the smallest angle at which a surface is taken to be seen. None where the eye is in its plane.
    pub(super) fn new(
        (mesh, normals): (&TriangleMesh, &[[f32; 3]]),
        triangle: [u32; 3],
        eye_m: Vector3<f64>,
        flattest: f64,
        reach_m: impl Fn(f64) -> f64,
    ) -> Option<Self> {
        let places_m = mesh.places_m(triangle);
        let corners = places_m.map(|at| at - eye_m);
        let shares_of = Matrix3::from_columns(&corners).try_inverse()?;
        let sight = corners.iter().sum::<Vector3<f64>>();
        let range_m = sight.norm() / corners.len() as f64;
        let normal: Vector3<f64> = triangle
            .iter()
            .map(|&corner| Vector3::from(normals[corner as usize].map(f64::from)))
            .sum();
        let normal = normal.try_normalize(0.0)?;
        let lean = -normal.dot(&sight.try_normalize(0.0)?);
        let lean = lean.max(flattest);
        let further = reach_m(range_m) / lean;
        let (mut low_m, mut high_m) = (places_m[0], places_m[0]);
        for (at, corner) in places_m.iter().zip(&corners) {
            let off = corner * (further / corner.norm());
            for end in [at - off, at + off] {
                low_m = low_m.inf(&end);
                high_m = high_m.sup(&end);
            }
        }
        Some(Self {
            shares_of,
            low_m,
            high_m,
            along: sight.iamax(),
            eye_m,
            lean,
            range_m,
            places_m,
            normal,
        })
    }

    /// Tells of each point of a lattice of voxels that is straight before the triangle, up to a distance, m: its key, and how far it is, m. Lines
    /// of sight that pass close over an edge miss these.
    pub(super) fn each_before(
        &self,
        voxel_m: f64,
        most_m: f64,
        mut take: impl FnMut([i32; 3], f64),
    ) {
        let [a, b, c] = self.places_m;
        let Some(shares_of) = Matrix3::from_columns(&[b - a, c - a, self.normal]).try_inverse()
        else {
            return;
        };
        let ends = self.places_m.map(|at| at + self.normal * most_m);
        let all = || self.places_m.iter().chain(&ends);
        let low = all().fold(a, |low, at| low.inf(at)) / voxel_m;
        let high = all().fold(a, |high, at| high.sup(at)) / voxel_m;
        let range = |axis: usize| libm::ceil(low[axis]) as i32..=libm::floor(high[axis]) as i32;
        for x in range(0) {
            for y in range(1) {
                for z in range(2) {
                    let at = Vector3::from([x, y, z].map(f64::from)) * voxel_m;
                    let [u, v, before_m] = (shares_of * (at - a)).into();
                    let over = u >= 0.0 && v >= 0.0 && u + v <= 1.0;
                    if over && before_m > 0.0 && before_m <= most_m {
                        take([x, y, z], before_m);
                    }
                }
            }
        }
    }

    /// Tells of each point of a lattice of voxels whose line of sight goes through the triangle: its key, and how far it is before the triangle
    /// along that line, m.
    pub(super) fn each(&self, voxel_m: f64, mut take: impl FnMut([i32; 3], f64)) {
        let [low, high] = [self.low_m, self.high_m].map(|end| end / voxel_m);
        let first = low.map(|at| libm::ceil(at) as i32);
        let last = high.map(|at| libm::floor(at) as i32);
        let axis = self.along;
        let [across, aside] = [(axis + 1) % 3, (axis + 2) % 3];
        let step = self.shares_of.column(axis) * voxel_m;
        for u in first[across]..=last[across] {
            for v in first[aside]..=last[aside] {
                let mut at = Vector3::zeros();
                at[across] = f64::from(u) * voxel_m;
                at[aside] = f64::from(v) * voxel_m;
                let base = self.shares_of * (at - self.eye_m);
                // No share is negative in the triangle.
                let (mut from, mut to) = (f64::from(first[axis]), f64::from(last[axis]));
                for corner in 0..3 {
                    let bound = -base[corner] / step[corner];
                    if step[corner] > 0.0 {
                        from = from.max(bound);
                    } else if step[corner] < 0.0 {
                        to = to.min(bound);
                    } else if base[corner] < 0.0 {
                        to = f64::NEG_INFINITY;
                    }
                }
                if from > to {
                    continue;
                }
                for w in libm::ceil(from) as i32..=libm::floor(to) as i32 {
                    at[axis] = f64::from(w) * voxel_m;
                    let share = (base + step * f64::from(w)).sum();
                    let mut key = [0; 3];
                    (key[across], key[aside], key[axis]) = (u, v, w);
                    take(key, (at - self.eye_m).norm() * (1.0 / share - 1.0));
                }
            }
        }
    }
}
